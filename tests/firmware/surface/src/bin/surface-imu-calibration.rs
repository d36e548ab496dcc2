//! Links everything of `kestirim-imu-calibration`.

#![no_std]
#![no_main]

#[allow(unreachable_pub)] // All modules together are a library for the host.
#[path = "../imu_calibration.rs"]
mod imu_calibration;

use surface::values;

surface::image!(imu_calibration::run);
