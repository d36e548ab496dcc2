//! The true satellites, and the products that a service publishes of them.

use std::f64::consts::TAU;

use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{ClockSample, OrbitSample};
use kestirim_replay::gnss::{Products, Satellite};
use nalgebra::{Matrix3, Vector3};
use rand_core::Rng;

use super::clocks::SatelliteClock;
use super::constellation::Kepler;
use super::noise::Wander;
use super::times::{INTERVAL_S, LAST, MIDNIGHT, SAMPLES};
use crate::random::{normal, uniform};

/// The number of clock samples per orbit sample: 15 minutes.
const TO_ORBIT: usize = 30;
/// The errors of a final orbit, m: radial, along-track and cross-track.
const ORBIT_M: [f64; 3] = [0.010, 0.020, 0.020];
/// The part of a clock's error that is constant all day, m; ambiguities absorb it.
const CLOCK_BIAS_M: f64 = 0.03;
/// The varying part of a clock's error, m, and its correlation time, s.
const CLOCK_M: f64 = 0.006;
const CLOCK_MEMORY_S: f64 = 5_400.0;

/// A satellite and the errors of its products.
#[derive(Debug, Clone)]
pub(super) struct Spacecraft {
    pub(super) orbit: Kepler,
    pub(super) clock: SatelliteClock,
    /// The published minus the true clock, s.
    clock_error: Vec<f64>,
    /// The amplitude (m) and phase of the orbit's error in three directions, at once and twice per revolution.
    orbit_error: [[(f64, f64); 3]; 2],
}

/// All satellites.
#[derive(Debug, Clone)]
pub(super) struct Services(pub(super) Vec<Spacecraft>);

impl Services {
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        let orbits = Kepler::constellation(rng);
        Self(orbits.into_iter().map(|orbit| Spacecraft::draw(orbit, rng)).collect())
    }

    /// The published products.
    pub(super) fn products(&self) -> Products {
        Products::of_satellites(MIDNIGHT, self.0.iter().map(Spacecraft::published))
    }
}

fn second(sample: usize) -> f64 {
    (sample as f64 - LAST) * INTERVAL_S
}

impl Spacecraft {
    fn draw(orbit: Kepler, rng: &mut impl Rng) -> Self {
        let clock = SatelliteClock::draw(rng);
        let bias = normal(rng, CLOCK_BIAS_M);
        let mut wander = Wander::draw(CLOCK_MEMORY_S, rng);
        let error = |_| (bias + CLOCK_M * wander.next(rng)) / SPEED_OF_LIGHT;
        let clock_error = (0..SAMPLES).map(error).collect();
        // Two waves, each with a variance of half its squared amplitude.
        let mut wave = |size: f64| (normal(rng, size), TAU * uniform(rng));
        let orbit_error = [ORBIT_M.map(&mut wave), ORBIT_M.map(&mut wave)];
        Self { orbit, clock, clock_error, orbit_error }
    }

    fn published(&self) -> Satellite {
        let seconds = (0..SAMPLES).map(second);
        let biases = self.clock.samples().iter().zip(&self.clock_error);
        let clock = seconds
            .zip(biases)
            .map(|(second, (bias, error))| ClockSample { second, bias: bias + error });
        let orbit = (0..SAMPLES).step_by(TO_ORBIT).map(|sample| {
            let second = second(sample);
            OrbitSample { second, position: self.published_position(second) }
        });
        Satellite { orbit: orbit.collect(), clock: clock.collect(), antenna: None }
    }

    fn published_position(&self, second: f64) -> Vector3<f64> {
        let motion = self.orbit.at(second);
        let radial = motion.position.normalize();
        let cross = motion.position.cross(&motion.velocity).normalize();
        let axes = Matrix3::from_columns(&[radial, cross.cross(&radial), cross]);
        let angle = Kepler::rate() * second;
        let mut error = Vector3::zeros();
        for (turns, waves) in [1.0, 2.0].into_iter().zip(self.orbit_error) {
            error += Vector3::from(waves.map(|(size, phase)| size * (turns * angle + phase).cos()));
        }
        motion.position + axes * error
    }
}
