//! An estimator beside its plant, sample by sample.

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

/// A flight, and where an estimator starts on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    /// The aircraft.
    pub plant: Plant,
    /// What is measured.
    pub outputs: Outputs,
    /// What the pilot does.
    pub inputs: Inputs,
    /// The noise.
    pub noise: Noise,
    /// Where the plant starts.
    pub truth: [f64; 4],
    /// Where the estimator starts.
    pub start: [f64; 4],
    /// How long it takes.
    pub samples: usize,
}

/// A sample, and what was expected of it before it was measured.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Truth, input and all states as measured.
    pub sample: Sample,
    /// x̂.
    pub estimate: SVector<f64, 4>,
}

impl Moment {
    /// x − x̂.
    pub fn error(&self) -> SVector<f64, 4> {
        self.sample.x - self.estimate
    }
}

impl Flight {
    /// Flies with an estimator in this scalar; every estimator meets the same noise of a seed.
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
            // Where fixed point is at its rails, the estimate stays, and so does its error.
            let _ = estimator.step(&sample.u, &sample.measured(c));
            Moment { sample, estimate }
        })
        .collect())
}
