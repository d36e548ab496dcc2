//! Feeds a fuzzer's bytes to readers and trackers, one module a target. The tests across crates feed the seeds.

pub mod drone;
pub mod flight_log;
pub mod gnss_observations;
pub mod gnss_products;
pub mod inertial_log;
pub mod level_log;
pub mod pedestrian;
pub mod range_log;
pub mod robot;
pub mod telemetry;
pub mod uav;

use arbitrary::{Result, Unstructured};

/// A number: mostly a plausible sensor value, sometimes arbitrary.
///
/// # Errors
/// If no bytes are left.
pub fn number(bytes: &mut Unstructured<'_>, scale: f64) -> Result<f64> {
    if bytes.ratio(1, 32)? {
        return bytes.arbitrary();
    }
    Ok(f64::from(bytes.arbitrary::<i16>()?) / f64::from(i16::MAX) * scale)
}

/// The time from the last sample to this one, µs: mostly one step, sometimes arbitrary, also negative.
///
/// # Errors
/// If no bytes are left.
pub fn later(bytes: &mut Unstructured<'_>, step_us: i64) -> Result<i64> {
    match bytes.arbitrary::<u8>()? {
        0 => bytes.arbitrary(),
        1 => bytes.int_in_range(-20_000_000..=20_000_000),
        2..8 => bytes.int_in_range(0..=3 * step_us),
        _ => Ok(step_us),
    }
}
