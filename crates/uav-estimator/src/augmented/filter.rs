use core::array::from_fn;

use kestirim_kalman::{Covariance, Driven, Gaussian, Innovation, Weighed};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

use super::row::{Row, blend, unit_of};
use super::{AugmentedModel, AugmentedStep};
use crate::Error;
use crate::kalman_filter::{Forced, UNITS, power_of_two};

/// Fixed point holds a variance of so many units squared as well as what is left of it.
const UNITS_A_SIGMA: f64 = 8.0;
/// In fixed point a state beside the four whose variance is so many times that at the start …
const MOST_VARIANCE: f64 = 4.0;
/// … has so much left after a step.
const FADING: f64 = 0.98;

/// A step of an [`AugmentedModel`] in the scalar and the units of an [`AugmentedFilter`].
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

/// A Kalman filter of the N states of an [`AugmentedModel`], with P outputs of which each may be missing.
///
/// What goes in and comes out is in the scalar T and in the filter's units, powers of two of those of the SI
/// ([`AugmentedFilter::state_units`], [`AugmentedFilter::output_units`]), so that firmware needs no double precision.
/// Outputs are taken in one after the other, so their noise must be independent.
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
    /// Variances of the states at the start.
    start: SVector<T, N>,
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize> AugmentedFilter<T, N, K, P> {
    /// A filter that starts at zero, with the standard deviations of the model.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a number is beyond what the scalar holds.
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

    /// The filter as it was at its start.
    pub fn begun_anew(&self) -> Self {
        let covariance = Covariance::from_variances(self.start.as_array());
        Self { state: Gaussian::new(SVector::zeros(), covariance), ..*self }
    }

    /// The same step, converted once.
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

    /// Units of the states: what is 1 in the filter is so many rad, rad/s, m/s, rad, …
    pub const fn state_units(&self) -> &SVector<f64, N> {
        &self.state_units
    }

    /// Units of the outputs, the same.
    pub const fn output_units(&self) -> &SVector<f64, P> {
        &self.output_units
    }

    /// The estimate and its covariance, in the filter's units.
    pub const fn state(&self) -> &Gaussian<T, N> {
        &self.state
    }

    /// Whether inputs, or a square of the airspeed, show in an output at once.
    pub(super) fn is_direct(&self, output: usize) -> bool {
        self.rows.get(output).is_some_and(|row| {
            row.pressure.is_some() || row.direct.iter().any(|part| *part != T::ZERO)
        })
    }

    /// x̂: deviations α (rad), q (rad/s), V (m/s), θ (rad), and what the model adds, in units of the SI.
    pub fn estimate(&self) -> SVector<f64, N> {
        self.state.mean.map(T::to_f64).component_mul(&self.state_units)
    }

    /// Standard deviations of the estimate's errors, in the same units.
    pub fn sigma(&self) -> SVector<f64, N> {
        let variances = self.state.covariance.variances();
        let sigmas = variances.map(|variance| libm::sqrt(variance.to_f64().max(0.0)));
        sigmas.component_mul(&self.state_units)
    }

    /// Moves on by a step with these inputs δe (rad) and δt.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was.
    pub fn predict(
        &mut self,
        transition: &AugmentedTransition<T, N, K>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        let fading = self.bounded(transition);
        self.state.advance(&transition.forced(&fading, input))?;
        Ok(())
    }

    /// Moves on by a step with the inputs that were held during it, then takes in the outputs that were measured with
    /// those of now: [`AugmentedFilter::predict`] and [`AugmentedFilter::correct`] in one, with one copy of the estimate less.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was before both.
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

    /// What is left of each state after a step; less of one whose variance hardly fits the scalar.
    ///
    /// In fixed point the roundings of every step add to a state that no output measures, such as a head wind without a speed
    /// over ground. Its variance would overflow, and then every sample would be refused. Floats have room.
    #[inline(always)]
    pub(super) fn bounded(&self, transition: &AugmentedTransition<T, N, K>) -> SVector<T, N> {
        let mut bounded = transition.fading;
        // Sums in floats have no headroom to count.
        if T::headroom(0) == Some(0) {
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

    /// Takes in the outputs that were measured while these inputs were applied, and answers with what each said beyond
    /// what was expected of it, in the outputs' units.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was.
    pub fn correct(
        &mut self,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        self.correct_with(measured, input, always)
    }

    /// The same, where `correct` decides whether a weighed output is taken in.
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

    /// What the outputs say, taken into an estimate; of one that is refused nothing is to be used.
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
    /// Moves on to another step over the same interval by a share of the way, 0 to 1.
    #[inline(always)]
    pub(super) fn blend(&mut self, other: &Self, share: T) {
        let (rows, others) = (self.rows.as_columns_mut(), other.rows.as_columns());
        blend(rows.as_flattened_mut(), others.as_flattened(), share);
        let (b, others) = (self.b.as_columns_mut(), other.b.as_columns());
        blend(b.as_flattened_mut(), others.as_flattened(), share);
        blend(self.fading.as_array_mut(), other.fading.as_array(), share);
        self.noise.blend(&other.noise, share);
    }

    /// The step with these inputs, after which so much is left of each state.
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

/// Every weighed output is taken in.
#[inline(always)]
fn always<T: Scalar, const N: usize>(
    next: &mut Gaussian<T, N>,
    weighed: &Weighed<T, N>,
    _output: usize,
) -> Result<Innovation<T>, Error> {
    Ok(next.correct(weighed)?)
}
