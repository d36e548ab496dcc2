use kestirim_scalar::Components;
use nalgebra::Vector3;

use crate::constants::{EARTH_GRAVITY, EARTH_ROTATION, SPEED_OF_LIGHT};

/// The advance of a satellite's clock due to the eccentricity of its orbit, s: −2·r·v/c².
///
/// Add it to the clock of an orbit product or a broadcast message. `position` (m) and `velocity` (m/s)
/// belong to the time of transmission; the velocity may be inertial or relative to the Earth, as
/// r·(ω × r) vanishes. (GPS interface specification, 20.3.3.3.3.1.)
pub fn eccentricity_clock(position: &Vector3<f64>, velocity: &Vector3<f64>) -> f64 {
    -2.0 * position.dot(velocity) / (SPEED_OF_LIGHT * SPEED_OF_LIGHT)
}

/// The Shapiro delay of the signal in the Earth's gravity, m: some 13 to 19 mm for GPS. Add it to the modelled range.
/// (IERS Conventions 2010, 11.17.)
///
/// Zero where it is not defined: for a point at the Earth's centre or a ray through it.
pub fn shapiro_delay(satellite: &Vector3<f64>, receiver: &Vector3<f64>) -> f64 {
    let radii = satellite.norm() + receiver.norm();
    let range = (satellite - receiver).norm();
    let delay = 2.0 * EARTH_GRAVITY / (SPEED_OF_LIGHT * SPEED_OF_LIGHT)
        * libm::log((radii + range) / (radii - range));
    if delay.is_finite() { delay } else { 0.0 }
}

/// The Sagnac correction: the lengthening of the range by the Earth's rotation during the signal's flight, m, to first
/// order.
///
/// Both positions are ECEF (m), the satellite's in the axes of the time of transmission, the receiver's in those of the
/// time of reception. Add it to their distance; up to 40 m, wrong by at most 0.1 mm.
pub fn sagnac(satellite: &Vector3<f64>, receiver: &Vector3<f64>) -> f64 {
    EARTH_ROTATION / SPEED_OF_LIGHT * (satellite.x * receiver.y - satellite.y * receiver.x)
}

/// Converts an ECEF vector that is fixed in inertial space to the ECEF axes of `seconds` later.
///
/// With the time of flight it gives a satellite's position at transmission in the axes of the reception.
pub fn carried_along(vector: &Vector3<f64>, seconds: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(EARTH_ROTATION * seconds);
    let [x, y, z] = *vector.as_array();
    Vector3::new(cosine * x + sine * y, cosine * y - sine * x, z)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{carried_along, eccentricity_clock, sagnac, shapiro_delay};
    use crate::constants::{EARTH_GRAVITY, EARTH_ROTATION, SPEED_OF_LIGHT};

    /// The interface specification states this as F·e·√A·sin E with F = −4.442807633e-10 s/√m, the same up to its GM,
    /// 7e-8 smaller in the square root.
    #[test]
    fn eccentric_orbit_as_in_the_interface_specification() {
        let (root, eccentricity, anomaly) = (5_153.7_f64, 0.02_f64, 1.1_f64);
        let semi_major = root * root;
        let minor = (1.0 - eccentricity * eccentricity).sqrt();
        let rate =
            (EARTH_GRAVITY / semi_major.powi(3)).sqrt() / (1.0 - eccentricity * anomaly.cos());
        let position =
            Vector3::new(anomaly.cos() - eccentricity, minor * anomaly.sin(), 0.0) * semi_major;
        let velocity = Vector3::new(-anomaly.sin(), minor * anomaly.cos(), 0.0) * semi_major * rate;
        let clock = eccentricity_clock(&position, &velocity);
        let expected = -4.442_807_633e-10 * eccentricity * root * anomaly.sin();
        assert!((clock - expected).abs() < 5e-15, "{clock} {expected}");
        let rotating = velocity - Vector3::z().cross(&position) * EARTH_ROTATION;
        assert!((eccentricity_clock(&position, &rotating) - clock).abs() < 1e-20);
    }

    /// Computed with mpmath.
    #[test]
    fn gravity_delays_by_centimetres() {
        let receiver = Vector3::x() * 6_378e3;
        let zenith = shapiro_delay(&(Vector3::x() * 26_560e3), &receiver);
        let horizon = shapiro_delay(&Vector3::new(6_378e3, 25_783e3, 0.0), &receiver);
        assert!((zenith - 0.012_653_594_074_4).abs() < 1e-12, "{zenith}");
        assert!((horizon - 0.018_671_172_279_5).abs() < 1e-12, "{horizon}");
        assert_eq!(shapiro_delay(&Vector3::zeros(), &Vector3::zeros()), 0.0);
        assert_eq!(shapiro_delay(&receiver, &-receiver), 0.0);
    }

    /// The rotation of the satellite and the first-order term are the same thing.
    #[test]
    fn the_earth_turns_during_the_flight() {
        let satellite = Vector3::new(12e6, -21e6, 9e6);
        let receiver = Vector3::new(4_594_489.7, -678_367.7, 4_357_066.2);
        let plain = (satellite - receiver).norm();
        let mut range = plain;
        for _ in 0..4 {
            range = (carried_along(&satellite, range / SPEED_OF_LIGHT) - receiver).norm();
        }
        let difference = range - plain - sagnac(&satellite, &receiver);
        assert!((range - plain).abs() > 10.0 && difference.abs() < 1e-4, "{difference}");
    }
}
