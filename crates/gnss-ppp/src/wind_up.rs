use nalgebra::{Matrix3, Vector3};

use crate::BodyAxes;

/// How many cycles the turning of the satellite's antenna, seen by the receiver's, adds to a carrier
/// phase (Wu et al. 1993). Subtract that many wavelengths from the measured phase.
///
/// `receiver_enu_from_ecef` gives the receiver's antenna, whose dipoles point north and west, and `sight`
/// the ECEF unit vector from receiver to satellite. With the result of the epoch before as `previous` the
/// phase is continuous over whole turns; without, it lies within half a cycle of zero. Where it is not
/// defined (a satellite at the antenna's nadir, numbers that are not finite) it stays at `previous`, or
/// zero.
pub fn wind_up(
    axes: &BodyAxes,
    receiver_enu_from_ecef: &Matrix3<f64>,
    sight: &Vector3<f64>,
    previous: Option<f64>,
) -> f64 {
    let ray = -sight;
    let east = receiver_enu_from_ecef.row(0).transpose();
    let north = receiver_enu_from_ecef.row(1).transpose();
    let satellite = dipole(&axes.x, &ray) - ray.cross(&axes.y);
    let receiver = dipole(&north, &ray) - ray.cross(&east);
    // atan2 of sine and cosine does not lose digits where the two dipoles are nearly aligned.
    let sine = ray.dot(&satellite.cross(&receiver));
    let cosine = satellite.dot(&receiver);
    let fraction = libm::atan2(sine, cosine) / core::f64::consts::TAU;
    if !fraction.is_finite() || libm::hypot(sine, cosine) < 1e-12 {
        return previous.unwrap_or(0.0);
    }
    let turns = previous.map_or(0.0, |previous| libm::round(previous - fraction));
    fraction + turns
}

/// The part of a dipole across the ray.
fn dipole(axis: &Vector3<f64>, ray: &Vector3<f64>) -> Vector3<f64> {
    axis - ray * ray.dot(axis)
}
