//! Ten seconds of flight: inputs, noise, and the initial states of plant and estimator.

use std::f64::consts::TAU;

use kestirim_observer_design::Discrete;
use kestirim_replay::uav::Noise;
use nalgebra::{SMatrix, SVector};
use rand_core::Rng;

use crate::random::normal;

/// The time between samples, s.
pub const INTERVAL_S: f64 = 0.01;
/// The number of samples of the thesis' flights: 10 s.
pub const SAMPLES: usize = 1000;

/// The initial state of the plant: the thesis' airspeed and pitch angle.
pub const START: [f64; 4] = [0.0, 0.0, 40.0, 0.53];
/// An initial estimate close to the plant's.
pub const NEAR: [f64; 4] = [0.1, 0.1, 35.0, 0.4];
/// An initial estimate far from the plant's.
pub const FAR: [f64; 4] = [0.2, 0.2, 20.0, 0.2];

/// The pilot's inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum Inputs {
    /// Constant: elevator 0.025, throttle 0.155.
    Constant,
    /// Sines of 0.5 and 0.2 Hz, with the constant inputs as amplitudes.
    Sine,
    /// No input.
    None,
}

impl Inputs {
    /// The input at a sample.
    pub fn at(self, sample: usize) -> SVector<f64, 2> {
        let t = sample as f64 * INTERVAL_S;
        let [elevator, throttle] = [0.025, 0.155];
        SVector::from(match self {
            Self::Constant => [elevator, throttle],
            Self::Sine => [elevator * (TAU * 0.5 * t).sin(), throttle * (TAU * 0.2 * t).sin()],
            Self::None => [0.0; 2],
        })
    }

    /// The name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Sine => "sine",
            Self::None => "none",
        }
    }
}

/// A sample of a flight.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// The true state.
    pub x: SVector<f64, 4>,
    /// The input that the pilot gave.
    pub u: SVector<f64, 2>,
    /// All states as measured.
    pub y: SVector<f64, 4>,
}

impl Sample {
    /// The outputs y = C x, as measured.
    pub fn measured<const P: usize>(&self, c: &SMatrix<f64, P, 4>) -> [Option<f64>; P] {
        <[f64; P]>::from(c * self.y).map(Some)
    }
}

/// An endless flight from `start`, sample by sample.
pub fn fly<R: Rng>(
    plant: Discrete<4, 2>,
    start: SVector<f64, 4>,
    inputs: Inputs,
    noise: Noise,
    mut rng: R,
) -> impl Iterator<Item = Sample> {
    let mut x = start;
    (0..).map(move |sample| {
        let u = inputs.at(sample);
        let w = SVector::from(noise.inputs.map(|sigma| normal(&mut rng, sigma)));
        let v = SVector::from(noise.outputs.map(|sigma| normal(&mut rng, sigma)));
        let now = Sample { x, u, y: x + v };
        x = plant.a * x + plant.b * (u + w);
        now
    })
}
