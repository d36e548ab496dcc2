//! The satellites as they are, and as a service publishes them.

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

/// Samples of a clock to one of an orbit: 15 minutes.
const TO_ORBIT: usize = 30;
/// Errors of a final orbit, m: radially, along the track and across it.
const ORBIT_M: [f64; 3] = [0.010, 0.020, 0.020];
/// What of a clock's error stays the same all day, m; ambiguities take it up.
const CLOCK_BIAS_M: f64 = 0.03;
/// What of it wanders, m, and how long it remembers, s.
const CLOCK_M: f64 = 0.006;
const CLOCK_MEMORY_S: f64 = 5_400.0;

/// A satellite and what is thought of it.
#[derive(Debug, Clone)]
pub(super) struct Spacecraft {
    pub(super) orbit: Kepler,
    pub(super) clock: SatelliteClock,
    /// The published clock less the true one, s.
    clock_error: Vec<f64>,
    /// Amplitude (m) and phase of the orbit's error in three directions, once and twice a revolution.
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

    /// What is published.
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
        // Two waves, each of which has a variance of half its amplitude's square.
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
