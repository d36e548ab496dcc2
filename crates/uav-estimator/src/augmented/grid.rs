//! The local models of a grid, and their interpolation.

use core::array::from_fn;

use kestirim_kalman::{Covariance, Gaussian, Process};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{ArrayStorage, SMatrix, SVector};

use super::filter::AugmentedTransition;
use super::row::{AIRSPEED, Row, blend, unit_of};
use super::{AugmentedFilter, AugmentedStep, LocalModel};
use crate::Error;
use crate::kalman_filter::UNITS;

/// The steps of all local models, in the scalar and the units of a [`ScheduledFilter`](crate::ScheduledFilter).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct ScheduledTransition<T: Scalar, const N: usize, const K: usize, const G: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    steps: [LocalTransition<T, N, K>; G],
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
struct LocalTransition<T: Scalar, const N: usize, const K: usize> {
    step: AugmentedTransition<T, N, K>,
    constant: SVector<T, 4>,
}

impl<T: Scalar, const N: usize, const K: usize> LocalTransition<T, N, K> {
    fn nothing() -> Self {
        let step = AugmentedTransition {
            rows: SMatrix::zeros(),
            b: SMatrix::zeros(),
            fading: SVector::zeros(),
            noise: Covariance::zero(),
        };
        Self { step, constant: SVector::zeros() }
    }
}

/// The local models of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(super) struct Grid<T: Scalar, const N: usize, const P: usize, const G: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    local: [Local<T, N, P>; G],
}

impl<T: Scalar, const N: usize, const P: usize, const G: usize> Grid<T, N, P, G> {
    /// Creates the grid of these models, for a filter of the first one, whose output units are set to suit all of
    /// them.
    pub(super) fn new<const K: usize>(
        models: &[LocalModel<N, K, P>; G],
        filter: &mut AugmentedFilter<T, N, K, P>,
    ) -> Result<Self, Error> {
        let mut units = [0.0_f64; P];
        for local in models {
            for (unit, output) in units.iter_mut().zip(&local.model.outputs) {
                *unit = unit.max(unit_of(output));
            }
        }
        filter.output_units = SVector::from(units);
        let mut grid = Self { local: [Local::new(); G] };
        let mut nexts = models.iter().skip(1);
        for (place, local) in grid.local.iter_mut().zip(models) {
            if !local.is_finite() {
                return Err(Error::NotFinite);
            }
            let next = nexts.next().unwrap_or(local);
            let apart = next.state.as_array()[AIRSPEED] - local.state.as_array()[AIRSPEED];
            if !(apart >= 0.0 && models.first().is_some_and(|first| local.is_like(first))) {
                return Err(Error::Grid);
            }
            *place = Local::of(local, filter.state_units.as_array(), &units, apart);
            if !place.is_finite() {
                return Err(Error::NotFinite);
            }
        }
        Ok(grid)
    }

    /// Converts the steps of all models for this filter.
    pub(super) fn transition<const K: usize>(
        &self,
        filter: &AugmentedFilter<T, N, K, P>,
        steps: &[AugmentedStep<N>; G],
    ) -> ScheduledTransition<T, N, K, G> {
        let mut converted = [LocalTransition::nothing(); G];
        let each = steps.iter().zip(&self.local);
        for (converted, (step, local)) in converted.iter_mut().zip(each) {
            let step = filter.transition(step);
            *converted = LocalTransition { step, constant: local.constant(&step) };
        }
        ScheduledTransition { steps: converted }
    }

    /// Index of the model below an airspeed, and the relative distance to the next one: 0 to 1.
    fn place(&self, airspeed: T) -> (usize, T) {
        let (mut place, mut share) = (0, T::ZERO);
        let pairs = self.local.iter().zip(self.local.iter().skip(1)).enumerate();
        for (index, (local, next)) in pairs {
            if index == 0 || airspeed >= local.airspeed {
                // Limited to the interval, so that fixed point holds the product.
                let beyond = airspeed.clamp(local.airspeed, next.airspeed) - local.airspeed;
                place = index;
                share = (beyond * local.slope).clamp(T::ZERO, T::ONE);
            }
        }
        (place, share)
    }

    /// Predicts with the step at the filter's estimated airspeed.
    pub(super) fn predict<const K: usize>(
        &self,
        filter: &mut AugmentedFilter<T, N, K, P>,
        transition: &ScheduledTransition<T, N, K, G>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        let (place, share) = self.place(filter.state.mean.as_array()[AIRSPEED]);
        let (below, above) = about(&transition.steps, place)?;
        let mut step = below.step;
        step.blend(&above.step, share);
        let mut constant = below.constant;
        blend(constant.as_array_mut(), above.constant.as_array(), share);
        let fading = filter.bounded(&step);
        let process = step.forced(&fading, input);
        filter.state.advance(&Shifted { process, constant: &constant })?;
        Ok(())
    }

    /// Sets the filter's output rows to those at its estimated airspeed, and subtracts from the measurements what
    /// these do not model.
    pub(super) fn prepare<const K: usize>(
        &self,
        filter: &mut AugmentedFilter<T, N, K, P>,
        measured: &mut [Option<T>; P],
    ) -> Result<(), Error> {
        let (place, share) = self.place(filter.state.mean.as_array()[AIRSPEED]);
        let (below, above) = about(&self.local, place)?;
        filter.rows = below.rows;
        for (row, above) in filter.rows.iter_mut().zip(&above.rows) {
            row.blend(above, share);
        }
        let mut taken = below.taken;
        blend(taken.as_array_mut(), above.taken.as_array(), share);
        for (measured, taken) in measured.iter_mut().zip(taken.as_array()) {
            *measured = measured.map(|measured| measured - *taken);
        }
        Ok(())
    }
}

/// An element of a list and the next one; at the end, the same one twice.
fn about<X, const G: usize>(all: &[X; G], place: usize) -> Result<(&X, &X), Error> {
    let below = all.get(place).ok_or(Error::Grid)?;
    Ok((below, all.get(place.wrapping_add(1)).unwrap_or(below)))
}

/// A process followed by the addition of a constant to the four states.
struct Shifted<'a, T, Q> {
    process: Q,
    constant: &'a SVector<T, 4>,
}

impl<T: Scalar, const N: usize, Q: Process<T, N>> Process<T, N> for Shifted<'_, T, Q> {
    #[inline(always)]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        self.process.advance(estimate);
        for (mean, constant) in
            estimate.mean.as_array_mut().iter_mut().zip(self.constant.as_array())
        {
            *mean += *constant;
        }
    }
}

/// A model of a grid, in the scalar and the units of its filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(super) struct Local<T: Scalar, const N: usize, const P: usize> {
    /// Airspeed relative to that of the origin.
    pub(super) airspeed: T,
    /// Inverse of the airspeed difference to the next model; zero if there is none.
    pub(super) slope: T,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(super) rows: [Row<T, N>; P],
    /// Constant that is subtracted from each measured output.
    pub(super) taken: SVector<T, P>,
    /// The steady flight: states in their units, and inputs.
    pub(super) state: SVector<f64, 4>,
    pub(super) input: SVector<f64, 2>,
}

impl<T: Scalar, const N: usize, const P: usize> Local<T, N, P> {
    const fn new() -> Self {
        Self {
            airspeed: T::ZERO,
            slope: T::ZERO,
            rows: [Row::new(); P],
            taken: SVector::from_array_storage(ArrayStorage([[T::ZERO; P]])),
            state: SVector::from_array_storage(ArrayStorage([[0.0; 4]])),
            input: SVector::from_array_storage(ArrayStorage([[0.0; 2]])),
        }
    }

    /// Converts a model; `apart` is the airspeed difference to the next one (m/s).
    fn of<const K: usize>(
        local: &LocalModel<N, K, P>,
        state_units: &[f64; N],
        units: &[f64; P],
        apart: f64,
    ) -> Self {
        let [_, _, unit_of_airspeed, _] = UNITS;
        let state = local.state.component_div(&SVector::from(UNITS));
        let slope = if apart > 0.0 { unit_of_airspeed / apart } else { 0.0 };
        let mut this = Self {
            airspeed: T::from_f64(state.as_array()[AIRSPEED]),
            slope: T::from_f64(slope),
            state,
            input: local.input,
            ..Self::new()
        };
        let columns = local.model.c.as_columns();
        let places = this.rows.iter_mut().zip(this.taken.as_array_mut());
        let outputs = local.model.outputs.iter().zip(local.outputs.as_array()).zip(units);
        for (index, ((row, taken), ((output, shown), unit))) in places.zip(outputs).enumerate() {
            let (seen, constant) = local.seen(output, *shown);
            let parts = from_fn(|state| {
                let own = seen.row.get(state).copied();
                own.or_else(|| columns[state].get(index).copied()).unwrap_or(0.0)
                    * state_units[state]
            });
            *row = Row::of(&seen, parts, *unit);
            *taken = T::from_f64(constant / *unit);
        }
        this
    }

    pub(super) fn is_finite(&self) -> bool {
        T::all_finite(&[self.airspeed, self.slope])
            && T::all_finite(self.taken.as_array())
            && self.rows.iter().all(Row::is_finite)
    }

    /// The constant that a step adds to the four states beside A x + B u, so that the steady flight is stationary.
    pub(super) fn constant<const K: usize>(
        &self,
        step: &AugmentedTransition<T, N, K>,
    ) -> SVector<T, 4> {
        // Computed from A and B as rounded to the scalar: with the exact ones their rounding errors would remain.
        let mut constant = *self.state.as_array();
        let states = step.rows.column_iter().zip(&self.state);
        let inputs = step.b.column_iter().zip(&self.input);
        for (column, value) in states {
            for (left, part) in constant.iter_mut().zip(&column) {
                *left -= part.to_f64() * value;
            }
        }
        for (column, value) in inputs {
            for (left, part) in constant.iter_mut().zip(&column) {
                *left -= part.to_f64() * value;
            }
        }
        SVector::from(constant.map(T::from_f64))
    }
}
