//! Errors of estimators that are given the same noise, flight by flight.

use kestirim_replay::ScalarKind;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::Error;
use nalgebra::{SMatrix, SVector};

use super::design::Kind;
use super::flight::Flight;
use crate::random::stream;
use crate::uav::scenario::{INTERVAL_S, fly};
use crate::with_outputs;

/// The errors of an estimator on a flight.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Errors {
    /// The sums over all samples of the squared errors of α (rad), q (rad/s), V (m/s), θ (rad).
    pub squares: [f64; 4],
    /// The number of steps that failed in this scalar.
    pub refused: u32,
}

/// Simulates the flight with a number, and returns the errors of each estimator.
pub type Flights = Box<dyn Fn(u64) -> Vec<Errors> + Send + Sync>;

impl Flight {
    /// Prepares many flights with these estimators; a seed and the number of a flight determine the noise. Errors in
    /// the first `settling` samples are not counted.
    ///
    /// # Errors
    /// Why there is no such estimator.
    pub fn errors(
        &self,
        kinds: &[Kind],
        settling: usize,
        scalar: ScalarKind,
        seed: u64,
    ) -> Result<Flights, Error> {
        match scalar {
            ScalarKind::F32 => {
                with_outputs!(self.outputs, errors::<f32, _>, self, kinds, settling, seed)
            }
            ScalarKind::F64 => {
                with_outputs!(self.outputs, errors::<f64, _>, self, kinds, settling, seed)
            }
            ScalarKind::Fixed => {
                with_outputs!(self.outputs, errors::<Q16_16, _>, self, kinds, settling, seed)
            }
        }
    }
}

fn errors<T: Scalar<Accumulator: Send + Sync> + Send + Sync, const P: usize>(
    c: &SMatrix<f64, P, 4>,
    flight: &Flight,
    kinds: &[Kind],
    settling: usize,
    seed: u64,
) -> Result<Flights, Error> {
    let (c, flight, plant) = (*c, *flight, flight.plant.discrete(INTERVAL_S));
    let (truth, start) = (SVector::from(flight.truth), SVector::from(flight.start));
    let new = |kind: &Kind| kind.estimator::<T, P>(&plant, &c, &start, &(truth - start));
    let estimators = kinds.iter().map(new).collect::<Result<Vec<_>, _>>()?;
    Ok(Box::new(move |index| {
        let begin = |it: &_| (Clone::clone(it), SVector::<f64, 4>::zeros(), 0);
        let mut flying: Vec<_> = estimators.iter().map(begin).collect();
        let samples = fly(plant, truth, flight.inputs, flight.noise, stream(seed, index));
        for (number, sample) in samples.take(flight.samples).enumerate() {
            let measured = sample.measured(&c);
            for (estimator, squares, refused) in &mut flying {
                if number >= settling {
                    let error = sample.x - estimator.estimate();
                    *squares += error.component_mul(&error);
                }
                *refused += u32::from(estimator.step(&sample.u, &measured).is_err());
            }
        }
        flying.iter().map(|&(_, it, refused)| Errors { squares: it.into(), refused }).collect()
    }))
}
