use core::array::from_fn;

use kestirim_kalman::{Covariance, Driven, Gaussian, Innovation, Weighed};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

use super::row::{Row, blend, unit_of};
use super::{AugmentedModel, AugmentedStep};
use crate::Error;
use crate::kalman_filter::{Forced, UNITS, power_of_two};

/// Number of units per initial standard deviation of an added state, chosen so that fixed point holds the variance
/// and what remains of it.
const UNITS_A_SIGMA: f64 = 8.0;
/// In fixed point, a state beyond the first four is faded when its variance exceeds the initial one by this factor.
const MOST_VARIANCE: f64 = 4.0;
/// Share of such a state that remains after a step.
const FADING: f64 = 0.98;

/// An [`AugmentedStep`] in the scalar and the units of an [`AugmentedFilter`].
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
pub struct AugmentedTransition<T: Scalar, const N: usize, const K: usize> {
    pub(super) rows: SMatrix<T, 4, K>,
    pub(super) b: SMatrix<T, 4, 2>,
    pub(super) fading: SVector<T, N>,
    pub(super) noise: Covariance<T, N>,
}

/// A Kalman filter for the N states of an [`AugmentedModel`], with P outputs, any of which may be missing.
///
/// Inputs and results are in the scalar T and in the filter's units, powers of two of the SI units
/// ([`AugmentedFilter::state_units`], [`AugmentedFilter::output_units`]), so that firmware needs no double precision.
/// Outputs are processed one after the other, so their noise must be independent.
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
pub struct AugmentedFilter<T: Scalar, const N: usize, const K: usize, const P: usize> {
    pub(super) state: Gaussian<T, N>,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(super) rows: [Row<T, N>; P],
    pub(super) state_units: SVector<f64, N>,
    pub(super) output_units: SVector<f64, P>,
    /// Initial variances of the states.
    start: SVector<T, N>,
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize> AugmentedFilter<T, N, K, P> {
    /// Creates a filter that starts at zero, with the initial standard deviations of the model.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a number is out of range for the scalar.
    pub fn new(model: &AugmentedModel<N, K, P>) -> Result<Self, Error> {
        let known = model.start.as_array();
        let state_units: [f64; N] = from_fn(|state| match UNITS.get(state) {
            Some(unit) => *unit,
            None => power_of_two(known[state] / UNITS_A_SIGMA),
        });
        let start = from_fn(|state| {
            let sigma = known[state] / state_units[state];
            T::from_f64(sigma * sigma)
        });
        let mut output_units = [1.0; P];
        let columns = model.c.as_columns();
        let outputs = output_units.iter_mut().zip(&model.outputs).enumerate();
        let mut rows = [Row::new(); P];
        for (row, (place, (unit, output))) in rows.iter_mut().zip(outputs) {
            let parts = from_fn(|state| columns[state][place] * state_units[state]);
            *unit = unit_of(output);
            *row = Row::of(output, parts, *unit);
        }
        let finite = |row: &Row<T, N>| row.is_finite();
        if !(T::all_finite(&start) && rows.iter().all(finite)) {
            return Err(Error::NotFinite);
        }
        let state = Gaussian::new(SVector::zeros(), Covariance::from_variances(&start));
        let (state_units, output_units) = (SVector::from(state_units), SVector::from(output_units));
        Ok(Self { state, rows, state_units, output_units, start: SVector::from(start) })
    }

    /// A copy of the filter, reset to its initial state.
    pub fn begun_anew(&self) -> Self {
        let covariance = Covariance::from_variances(self.start.as_array());
        Self { state: Gaussian::new(SVector::zeros(), covariance), ..*self }
    }

    /// Converts a step to the filter's scalar and units.
    pub fn transition(&self, step: &AugmentedStep<N>) -> AugmentedTransition<T, N, K> {
        let units = self.state_units.as_array();
        let a = step.transition.a.as_columns();
        let b = step.transition.b.as_columns();
        let noise = step.noise.as_columns();
        let mut rows = SMatrix::<T, 4, K>::zeros();
        for (k, column) in rows.as_columns_mut().iter_mut().enumerate() {
            for (row, part) in column.iter_mut().enumerate() {
                if let (Some(a), Some(unit)) = (a.get(k), units.get(k)) {
                    *part = T::from_f64(a[row] * *unit / UNITS[row]);
                }
            }
        }
        let mut inputs = SMatrix::<T, 4, 2>::zeros();
        for (input, column) in inputs.as_columns_mut().iter_mut().enumerate() {
            for (row, part) in column.iter_mut().enumerate() {
                *part = T::from_f64(b[input][row] / UNITS[row]);
            }
        }
        let mut lower = SMatrix::<T, N, N>::zeros();
        for (j, column) in lower.as_columns_mut().iter_mut().enumerate() {
            for (i, part) in column.iter_mut().enumerate() {
                *part = T::from_f64(noise[j][i] / (units[i] * units[j]));
            }
        }
        AugmentedTransition {
            rows,
            b: inputs,
            fading: SVector::from(from_fn(|state| T::from_f64(a[state][state]))),
            noise: Covariance::from_lower_triangle(&lower),
        }
    }

    /// Units of the states: a value of 1 in the filter corresponds to this many rad, rad/s, m/s, rad, …
    pub const fn state_units(&self) -> &SVector<f64, N> {
        &self.state_units
    }

    /// Units of the outputs: a value of 1 in the filter corresponds to this many of the output's own unit.
    pub const fn output_units(&self) -> &SVector<f64, P> {
        &self.output_units
    }

    /// The estimate and its covariance, in the filter's units.
    pub const fn state(&self) -> &Gaussian<T, N> {
        &self.state
    }

    /// Whether an output depends directly on the inputs, or on the square of the airspeed.
    pub(super) fn is_direct(&self, output: usize) -> bool {
        self.rows.get(output).is_some_and(|row| {
            row.pressure.is_some() || row.direct.iter().any(|part| *part != T::ZERO)
        })
    }

    /// The estimate x̂: deviations of α (rad), q (rad/s), V (m/s), θ (rad), and the states that the model adds, in SI
    /// units.
    pub fn estimate(&self) -> SVector<f64, N> {
        self.state.mean.map(T::to_f64).component_mul(&self.state_units)
    }

    /// Standard deviations of the estimation errors, in the units of [`AugmentedFilter::estimate`].
    pub fn sigma(&self) -> SVector<f64, N> {
        let variances = self.state.covariance.variances();
        let sigmas = variances.map(|variance| libm::sqrt(variance.to_f64().max(0.0)));
        sigmas.component_mul(&self.state_units)
    }

    /// Predicts over a step with these inputs δe (rad) and δt.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged.
    pub fn predict(
        &mut self,
        transition: &AugmentedTransition<T, N, K>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        let fading = self.bounded(transition);
        self.state.advance(&transition.forced(&fading, input))?;
        Ok(())
    }

    /// Predicts over a step with the inputs held during it, then processes the outputs measured with the present
    /// inputs: [`AugmentedFilter::predict`] and [`AugmentedFilter::correct`] combined, with one copy of the estimate
    /// less.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged, including by the prediction.
    pub fn step(
        &mut self,
        transition: &AugmentedTransition<T, N, K>,
        held: &SVector<T, 2>,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let mut next = self.state;
        let fading = self.bounded(transition);
        next.advance(&transition.forced(&fading, held))?;
        let innovations = self.taken(&mut next, measured, input, always)?;
        self.state = next;
        Ok(innovations)
    }

    /// The share of each state that remains after a step, reduced for states whose variance approaches the range of
    /// the scalar.
    ///
    /// In fixed point the rounding of every step accumulates in a state that no output measures, such as a head wind
    /// without a ground speed. Its variance would overflow, and then every sample would be refused. Floating point
    /// has enough range.
    #[inline(always)]
    pub(super) fn bounded(&self, transition: &AugmentedTransition<T, N, K>) -> SVector<T, N> {
        let mut bounded = transition.fading;
        if T::IS_FLOAT {
            return bounded;
        }
        let least = T::from_f64(UNITS_A_SIGMA * UNITS_A_SIGMA);
        let variances = self.state.covariance.variances();
        let beside = variances.as_array().iter().zip(self.start.as_array());
        for (left, (variance, start)) in bounded.iter_mut().zip(beside).skip(UNITS.len()) {
            if *variance > start.max(least) * T::from_f64(MOST_VARIANCE) {
                *left *= T::from_f64(FADING);
            }
        }
        bounded
    }

    /// Processes the outputs measured while these inputs were applied, and returns their innovations, in the outputs'
    /// units.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged.
    pub fn correct(
        &mut self,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        self.correct_with(measured, input, always)
    }

    /// Processes the outputs as [`AugmentedFilter::correct`] does, where `correct` decides whether an output is used.
    pub(super) fn correct_with(
        &mut self,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
        correct: impl FnMut(&mut Gaussian<T, N>, &Weighed<T, N>, usize) -> Result<Innovation<T>, Error>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let mut next = self.state;
        let innovations = self.taken(&mut next, measured, input, correct)?;
        self.state = next;
        Ok(innovations)
    }

    /// Applies the outputs to an estimate, which must be discarded after an error.
    #[inline(always)]
    fn taken(
        &self,
        next: &mut Gaussian<T, N>,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
        mut correct: impl FnMut(
            &mut Gaussian<T, N>,
            &Weighed<T, N>,
            usize,
        ) -> Result<Innovation<T>, Error>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let mut innovations = [None; P];
        let outputs = self.rows.iter().zip(measured).zip(&mut innovations).enumerate();
        for (output, ((row, measured), innovation)) in outputs {
            let Some(measured) = *measured else { continue };
            let (expected, derivatives) = row.linearised::<K>(next.mean.as_array(), input);
            let weighed = next.weigh_row(&derivatives, measured - expected, row.variance)?;
            *innovation = Some(correct(next, &weighed, output)?);
        }
        Ok(innovations)
    }
}

impl<T: Scalar, const N: usize, const K: usize> AugmentedTransition<T, N, K> {
    /// Interpolates towards another step over the same interval; `share` is from 0 to 1.
    #[inline(always)]
    pub(super) fn blend(&mut self, other: &Self, share: T) {
        let (rows, others) = (self.rows.as_columns_mut(), other.rows.as_columns());
        blend(rows.as_flattened_mut(), others.as_flattened(), share);
        let (b, others) = (self.b.as_columns_mut(), other.b.as_columns());
        blend(b.as_flattened_mut(), others.as_flattened(), share);
        blend(self.fading.as_array_mut(), other.fading.as_array(), share);
        self.noise.blend(&other.noise, share);
    }

    /// The step with these inputs, after which the share `fading` of each state remains.
    #[inline(always)]
    pub(super) fn forced<'a>(
        &'a self,
        fading: &'a SVector<T, N>,
        input: &'a SVector<T, 2>,
    ) -> Forced<'a, T, Driven<'a, T, N, 4, K>> {
        let process = Driven { rows: &self.rows, fading: fading.as_array(), noise: &self.noise };
        Forced { process, b: &self.b, input }
    }
}

/// Uses every output.
#[inline(always)]
fn always<T: Scalar, const N: usize>(
    next: &mut Gaussian<T, N>,
    weighed: &Weighed<T, N>,
    _output: usize,
) -> Result<Innovation<T>, Error> {
    Ok(next.correct(weighed)?)
}
