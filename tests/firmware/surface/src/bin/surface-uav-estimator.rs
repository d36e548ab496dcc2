//! Everything of `kestirim-uav-estimator`, linked.

#![no_std]
#![no_main]

#[path = "../uav_estimator.rs"]
mod uav_estimator;

use surface::values;

surface::image!(uav_estimator::run);
