//! Thirty satellites in six planes, on Keplerian orbits.

use std::f64::consts::TAU;

use kestirim_gnss_ppp::constants::{EARTH_GRAVITY, SPEED_OF_LIGHT};
use nalgebra::Vector3;
use rand_core::Rng;

use crate::random::{normal, uniform};

/// The number of orbital planes.
const PLANES: u8 = 6;
/// The number of satellites in a plane.
const SLOTS: u8 = 5;
/// The semi-major axis, m: two revolutions a sidereal day.
const SEMI_MAJOR_M: f64 = 26_559.7e3;
/// The inclination of all planes, rad.
const INCLINATION: f64 = 0.96;
/// The largest eccentricity.
const ECCENTRICITY: f64 = 0.02;
/// The standard deviation of the satellites from even spacing, rad.
const SPACING: f64 = 0.15;

/// An orbit in the inertial frame that coincides with the Earth-fixed one at midnight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kepler {
    eccentricity: f64,
    /// The direction of the perigee.
    along: Vector3<f64>,
    /// The direction a quarter of a revolution after the perigee.
    across: Vector3<f64>,
    /// The mean anomaly at midnight, rad.
    anomaly: f64,
}

/// The motion of a satellite at an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Motion {
    /// The centre of mass, m.
    pub(super) position: Vector3<f64>,
    /// The velocity, m/s.
    pub(super) velocity: Vector3<f64>,
    /// The relativistic clock offset caused by the eccentricity of the orbit, s; positive if the clock is ahead.
    pub(super) relativity: f64,
}

impl Kepler {
    /// Draws all satellites, in the order of their numbers from 1.
    pub(super) fn constellation(rng: &mut impl Rng) -> Vec<Self> {
        let turn = TAU * uniform(rng);
        let satellites = (0..PLANES).flat_map(|plane| (0..SLOTS).map(move |slot| (plane, slot)));
        satellites.map(|(plane, slot)| Self::draw(turn, plane, slot, rng)).collect()
    }

    fn draw(turn: f64, plane: u8, slot: u8, rng: &mut impl Rng) -> Self {
        let planes = f64::from(PLANES);
        let node = turn + TAU * f64::from(plane) / planes + normal(rng, 0.02);
        let inclination = INCLINATION + normal(rng, 0.01);
        let perigee = TAU * uniform(rng);
        let (sine, cosine) = node.sin_cos();
        let to_node = Vector3::new(cosine, sine, 0.0);
        let (sine, cosine) = inclination.sin_cos();
        let ahead = Vector3::new(-to_node.y * cosine, to_node.x * cosine, sine);
        let (sine, cosine) = perigee.sin_cos();
        // Neighbouring planes are staggered.
        let slot = f64::from(slot) + f64::from(plane) / planes;
        let argument = TAU * slot / f64::from(SLOTS) + normal(rng, SPACING);
        Self {
            eccentricity: ECCENTRICITY * uniform(rng),
            along: to_node * cosine + ahead * sine,
            across: ahead * cosine - to_node * sine,
            anomaly: argument - perigee,
        }
    }

    /// The mean motion, rad/s.
    pub(super) fn rate() -> f64 {
        (EARTH_GRAVITY / SEMI_MAJOR_M.powi(3)).sqrt()
    }

    /// The motion `second` seconds after midnight.
    pub(super) fn at(&self, second: f64) -> Motion {
        let Self { eccentricity, along, across, anomaly } = *self;
        let rate = Self::rate();
        let mean = anomaly + rate * second;
        // Each iteration multiplies the error by the eccentricity, until nothing changes any more.
        let mut eccentric = mean;
        for _ in 0..10 {
            let before = eccentric;
            eccentric = mean + eccentricity * before.sin();
            if eccentric == before {
                break;
            }
        }
        let (sine, cosine) = eccentric.sin_cos();
        let minor = (1.0 - eccentricity * eccentricity).sqrt();
        let speed = SEMI_MAJOR_M * rate / (1.0 - eccentricity * cosine);
        let in_plane = along * (cosine - eccentricity) + across * (minor * sine);
        // The constant F of the interface specification, computed from its definition.
        let factor = -2.0 * EARTH_GRAVITY.sqrt() / (SPEED_OF_LIGHT * SPEED_OF_LIGHT);
        Motion {
            position: in_plane * SEMI_MAJOR_M,
            velocity: (across * (minor * cosine) - along * sine) * speed,
            relativity: factor * eccentricity * SEMI_MAJOR_M.sqrt() * sine,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::stream;
    use kestirim_gnss_ppp::eccentricity_clock;

    #[test]
    fn orbits_fall_around_the_earth() {
        for kepler in Kepler::constellation(&mut stream(0, 0)) {
            let [before, now, after] = [-1.0, 0.0, 1.0].map(|second| kepler.at(5e4 + second));
            let speed = (after.position - before.position) / 2.0;
            assert!((speed - now.velocity).norm() < 1e-3);
            let pull = after.position - now.position * 2.0 + before.position;
            let gravity = now.position * (-EARTH_GRAVITY / now.position.norm().powi(3));
            assert!((pull - gravity).norm() < 1e-5, "{pull} {gravity}");
            let relativity = eccentricity_clock(&now.position, &now.velocity);
            assert!((relativity - now.relativity).abs() < 1e-15);
        }
    }
}
