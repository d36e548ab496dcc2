//! Runs an estimator alongside its plant, sample by sample.

use kestirim_replay::ScalarKind;
use kestirim_replay::uav::{Noise, Plant};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::Error;
use nalgebra::{SMatrix, SVector};

use super::design::Kind;
use crate::random::stream;
use crate::uav::plant::Outputs;
use crate::uav::scenario::{INTERVAL_S, Inputs, Sample, fly};
use crate::with_outputs;

/// A flight, and the initial state of an estimator on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    /// The aircraft.
    pub plant: Plant,
    /// The measured states.
    pub outputs: Outputs,
    /// The pilot's inputs.
    pub inputs: Inputs,
    /// The noise.
    pub noise: Noise,
    /// The initial state of the plant.
    pub truth: [f64; 4],
    /// The initial state of the estimator.
    pub start: [f64; 4],
    /// The duration in samples.
    pub samples: usize,
}

/// A sample, and its estimate before it was measured.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// The true state, the input, and all states as measured.
    pub sample: Sample,
    /// The estimate x̂.
    pub estimate: SVector<f64, 4>,
}

impl Moment {
    /// The estimation error x − x̂.
    pub fn error(&self) -> SVector<f64, 4> {
        self.sample.x - self.estimate
    }
}

impl Flight {
    /// Runs an estimator in this scalar; every estimator is given the same noise for the same seed.
    ///
    /// # Errors
    /// Why there is no such estimator.
    pub fn follow(&self, kind: &Kind, scalar: ScalarKind, seed: u64) -> Result<Vec<Moment>, Error> {
        match scalar {
            ScalarKind::F32 => with_outputs!(self.outputs, follow::<f32, _>, self, kind, seed),
            ScalarKind::F64 => with_outputs!(self.outputs, follow::<f64, _>, self, kind, seed),
            ScalarKind::Fixed => with_outputs!(self.outputs, follow::<Q16_16, _>, self, kind, seed),
        }
    }
}

fn follow<T: Scalar, const P: usize>(
    c: &SMatrix<f64, P, 4>,
    flight: &Flight,
    kind: &Kind,
    seed: u64,
) -> Result<Vec<Moment>, Error> {
    let plant = flight.plant.discrete(INTERVAL_S);
    let (truth, start) = (SVector::from(flight.truth), SVector::from(flight.start));
    let mut estimator = kind.estimator::<T, P>(&plant, c, &start, &(truth - start))?;
    let samples = fly(plant, truth, flight.inputs, flight.noise, stream(seed, 0));
    Ok(samples
        .take(flight.samples)
        .map(|sample| {
            let estimate = estimator.estimate();
            // Where fixed point saturates, the estimate stays as it is, and so does its error.
            let _ = estimator.step(&sample.u, &sample.measured(c));
            Moment { sample, estimate }
        })
        .collect())
}
