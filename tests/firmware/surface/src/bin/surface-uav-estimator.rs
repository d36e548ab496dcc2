//! Everything of `kestirim-uav-estimator`, linked.

#![no_std]
#![no_main]

surface::image!(surface::uav_estimator::run);
