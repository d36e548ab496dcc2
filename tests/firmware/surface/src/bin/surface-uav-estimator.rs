//! Links everything of `kestirim-uav-estimator`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../uav_estimator.rs"]
mod uav_estimator;

use surface::values;

surface::image!(uav_estimator::run);
