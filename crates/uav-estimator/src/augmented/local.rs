use kestirim_scalar::Components;
use nalgebra::SVector;

use super::row::AIRSPEED;
use super::{AugmentedModel, Output, Reference};
use crate::Error;
use crate::transitions::Moves;

/// A model near one steady flight, one of several of an aircraft that [`ScheduledFilter`](crate::ScheduledFilter)
/// interpolates.
///
/// The steady flight is given by its deviations from a common origin, to which samples and estimates are relative,
/// too: the trim of one of the models, which then has zeros here. The model itself describes deviations from its own
/// steady flight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LocalModel<const N: usize, const K: usize, const P: usize> {
    /// Deviations of the aircraft from this steady flight, with noise and gusts for its airspeed. Biases, wind and
    /// forces must be those of all models, in the same order and of the same size.
    pub model: AugmentedModel<N, K, P>,
    /// State α (rad), q (rad/s), V (m/s), θ (rad) of this steady flight, minus that of the origin.
    pub state: SVector<f64, 4>,
    /// Inputs δe (rad) and δt of this steady flight, minus those of the origin.
    pub input: SVector<f64, 2>,
    /// Value of each output in this steady flight, minus that at the origin.
    pub outputs: SVector<f64, P>,
}

impl<const N: usize, const K: usize, const P: usize> LocalModel<N, K, P> {
    pub(super) fn is_finite(&self) -> bool {
        let numbers = self.state.iter().chain(&self.input).chain(&self.outputs);
        numbers.copied().all(f64::is_finite)
    }

    /// Whether both are models with the same states, outputs and origin.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let outputs = self.model.outputs.iter().zip(&other.model.outputs);
        let mut alike = outputs.map(|(one, another)| match (one.reference, another.reference) {
            (
                Reference::Pressure { airspeed, .. },
                Reference::Pressure { airspeed: others, .. },
            ) => {
                let (here, there) = (self.origin(airspeed), other.origin(others));
                (here - there).abs() <= SAME * here.abs()
            }
            (one, another) => one == another,
        });
        self.model.has_states_of(&other.model) && alike.all(|alike| alike)
    }

    /// Airspeed of the origin, m/s.
    fn origin(&self, airspeed: f64) -> f64 {
        airspeed - self.state.as_array()[AIRSPEED]
    }

    /// An output in terms of deviations from the origin, and the constant to be subtracted from its measurements.
    ///
    /// An output proportional to the dynamic pressure is proportional to that of the origin, too: with the airspeeds
    /// V₀ of the origin and V₁ of this flight, (V/V₁)² = (V/V₀)² (V₀/V₁)².
    pub(super) fn seen(&self, output: &Output, shown: f64) -> (Output, f64) {
        let at = |output: &Output| -> f64 {
            let states = output.row.iter().zip(&self.state).map(|(part, it)| part * it);
            let inputs = output.direct.iter().zip(&self.input).map(|(part, it)| part * it);
            states.chain(inputs).sum()
        };
        let Reference::Pressure { steady, airspeed } = output.reference else {
            return (*output, shown - at(output));
        };
        let origin = self.origin(airspeed);
        let share = (origin / airspeed) * (origin / airspeed);
        let mut seen = *output;
        let [_, _, by_airspeed, _] = &mut seen.row;
        *by_airspeed -= 2.0 * steady / airspeed;
        let there = share * (steady - at(&seen));
        seen.row = seen.row.map(|part| share * part);
        seen.direct = seen.direct.map(|part| share * part);
        let [_, _, by_airspeed, _] = &mut seen.row;
        *by_airspeed += 2.0 * there / origin;
        seen.reference = Reference::Pressure { steady: there, airspeed: origin };
        (seen, there - steady + shown)
    }
}

/// Relative difference below which airspeeds count as equal.
const SAME: f64 = 1e-9;

/// Local models that are discretised together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Models<const N: usize, const K: usize, const P: usize, const G: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(super) models: [AugmentedModel<N, K, P>; G],
}

impl<const N: usize, const K: usize, const P: usize, const G: usize> Moves for Models<N, K, P, G> {
    type Step = [super::AugmentedStep<N>; G];

    fn over(
        &self,
        interval: f64,
        sample: f64,
        noise: &SVector<f64, 2>,
    ) -> Result<Self::Step, Error> {
        let first = self.models.first().ok_or(Error::Grid)?;
        let mut step = first.over(interval, sample, noise)?;
        let mut steps = [step; G];
        let mut before = first;
        for (place, model) in steps.iter_mut().zip(&self.models) {
            // A repeated model is discretised once.
            if model != before {
                step = model.over(interval, sample, noise)?;
            }
            (*place, before) = (step, model);
        }
        Ok(steps)
    }
}
