//! Ten seconds of flight: inputs, noise, and where plant and estimator start.

use std::f64::consts::TAU;

use kestirim_observer_design::Discrete;
use nalgebra::{SMatrix, SVector};
use rand_core::Rng;
use serde::Serialize;

use crate::random::normal;

/// Time between samples, s.
pub const INTERVAL_S: f64 = 0.01;
/// Samples of the thesis' flights: 10 s.
pub const SAMPLES: usize = 1000;

/// Where the plant starts: the thesis' airspeed and pitch angle.
pub const START: [f64; 4] = [0.0, 0.0, 40.0, 0.53];
/// Where an estimator starts that knows a little …
pub const NEAR: [f64; 4] = [0.1, 0.1, 35.0, 0.4];
/// … and one that knows less.
pub const FAR: [f64; 4] = [0.2, 0.2, 20.0, 0.2];

/// What the pilot does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Inputs {
    /// Elevator 0.025, throttle 0.155.
    Constant,
    /// The same as amplitudes of sines of 0.5 and 0.2 Hz.
    Sine,
    /// Nothing.
    None,
}

impl Inputs {
    /// At a sample.
    pub fn at(self, sample: usize) -> SVector<f64, 2> {
        let t = sample as f64 * INTERVAL_S;
        let [elevator, throttle] = [0.025, 0.155];
        SVector::from(match self {
            Self::Constant => [elevator, throttle],
            Self::Sine => [elevator * (TAU * 0.5 * t).sin(), throttle * (TAU * 0.2 * t).sin()],
            Self::None => [0.0; 2],
        })
    }

    /// For a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Sine => "sine",
            Self::None => "none",
        }
    }
}

/// Standard deviations of white noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Noise {
    /// For a table.
    pub name: &'static str,
    /// Of what reaches the plant beside δe and δt.
    pub inputs: [f64; 2],
    /// Of what is measured of α, q, V and θ.
    pub outputs: [f64; 4],
}

impl Noise {
    /// None.
    pub const NONE: Self = Self { name: "none", inputs: [0.0; 2], outputs: [0.0; 4] };
    /// The thesis': of equal size on all inputs and outputs. It does not print the size.
    pub const EQUAL: Self = Self { name: "equal", inputs: [0.01; 2], outputs: [0.01; 4] };
    /// Half a degree and half a metre a second.
    pub const SENSORS: Self = Self {
        name: "sensors",
        inputs: [HALF_A_DEGREE, 0.02],
        outputs: [HALF_A_DEGREE, HALF_A_DEGREE, 0.5, HALF_A_DEGREE],
    };

    /// Covariance of what the inputs' noise does to the state in an interval.
    pub fn process(&self, plant: &Discrete<4, 2>) -> SMatrix<f64, 4, 4> {
        let inputs = SVector::from(self.inputs.map(|sigma| sigma * sigma));
        plant.b * SMatrix::from_diagonal(&inputs) * plant.b.transpose()
    }

    /// Covariance of the measurements' noise.
    pub fn measurement<const P: usize>(&self, c: &SMatrix<f64, P, 4>) -> SMatrix<f64, P, P> {
        let outputs = SVector::from(self.outputs.map(|sigma| sigma * sigma));
        c * SMatrix::from_diagonal(&outputs) * c.transpose()
    }

    /// Standard deviation of an output that mixes the states by this row of C.
    pub fn of_output(&self, row: &[f64; 4]) -> f64 {
        let parts = row.iter().zip(&self.outputs);
        parts.fold(0.0, |sum: f64, (part, sigma)| sum.hypot(part * sigma))
    }
}

const HALF_A_DEGREE: f64 = 0.5 * std::f64::consts::PI / 180.0;

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
    /// Outputs y = C x as measured.
    pub fn measured<const P: usize>(&self, c: &SMatrix<f64, P, 4>) -> [Option<f64>; P] {
        <[f64; P]>::from(c * self.y).map(Some)
    }
}

/// A flight from `start`, sample by sample, without end.
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
