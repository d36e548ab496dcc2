use core::array::from_fn;

use kestirim_kalman::{
    Covariance, Gaussian, Innovation, Linear, LinearObservation, Process, SparseRow, Weighed,
};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

use crate::gate::Gate;
use crate::{Error, Step};

/// Units of the states (rad, rad/s, m/s, rad) inside the filter, in which fixed point holds the smallest and the
/// largest variance of a flight. Powers of two, which do not affect floating-point rounding.
pub(crate) const UNITS: [f64; 4] = [1.0 / 256.0, 1.0 / 256.0, 0.25, 1.0 / 256.0];

/// Normalised innovation squared beyond which an output contradicts the estimate: 5 σ.
pub(crate) const GATE: f64 = 25.0;

/// A [`Step`] in the scalar and the units of a [`KalmanFilter`].
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
pub struct Transition<T: Scalar> {
    a: SMatrix<T, 4, 4>,
    b: SMatrix<T, 4, 2>,
    noise: Covariance<T, 4>,
}

impl<T: Scalar> Transition<T> {
    /// Converts a step to the filter's scalar and units.
    pub fn new(step: &Step) -> Self {
        let (units, in_units) = units();
        let noise = in_units * step.noise * in_units;
        Self {
            a: (in_units * step.transition.a * units).map(T::from_f64),
            b: (in_units * step.transition.b).map(T::from_f64),
            noise: Covariance::from_lower_triangle(&noise.map(T::from_f64)),
        }
    }
}

/// The innovation of each output, and whether a gate rejected it.
pub(crate) struct Gated<const P: usize> {
    pub(crate) innovations: [Option<Innovation<f64>>; P],
    pub(crate) is_left_out: [bool; P],
}

/// A Kalman filter with time-varying gain for α, q, V and θ, with P outputs, any of which may be missing.
///
/// Inputs and results are in `f64` and SI units; internally, all arithmetic is in `T`, in units in which Q16.16 holds
/// a flight's variances. Outputs are processed one after the other, so their noise must be independent.
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
pub struct KalmanFilter<T: Scalar, const P: usize> {
    state: Gaussian<T, 4>,
    /// Rows of C as columns, and the variances of the outputs' noise, both in the internal units.
    rows: SMatrix<T, 4, P>,
    variances: SVector<T, P>,
    /// Internal units of the outputs: powers of two.
    units: SVector<f64, P>,
}

impl<T: Scalar, const P: usize> KalmanFilter<T, P> {
    /// Creates a filter for outputs y = C x with noise of the standard deviations `sigmas`, from an initial state
    /// whose errors have the standard deviations `start_sigmas`.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(
        c: &SMatrix<f64, P, 4>,
        sigmas: &SVector<f64, P>,
        start: &SVector<f64, 4>,
        start_sigmas: &SVector<f64, 4>,
    ) -> Result<Self, Error> {
        let (units, in_units) = units();
        let seen = c * units;
        let mut rows = SMatrix::<T, 4, P>::zeros();
        let mut variances = SVector::<T, P>::zeros();
        let mut output_units = SVector::<f64, P>::zeros();
        for output in 0..P {
            let row: [f64; 4] = from_fn(|state| seen.as_columns()[state][output]);
            let unit = power_of_two(row.iter().fold(0.0, |sum, part| sum + part.abs()));
            let sigma = sigmas.as_array()[output];
            rows.as_columns_mut()[output] = row.map(|part| T::from_f64(part / unit));
            variances.as_array_mut()[output] = T::from_f64(sigma * sigma / (unit * unit));
            output_units.as_array_mut()[output] = unit;
        }
        let known = (in_units * start_sigmas).map(|sigma| T::from_f64(sigma * sigma));
        let mean = (in_units * start).map(T::from_f64);
        let given = c.iter().chain(sigmas).chain(start).chain(start_sigmas);
        if !(given.copied().all(f64::is_finite)
            && T::all_finite(mean.as_array())
            && T::all_finite(known.as_array())
            && T::all_finite(variances.as_array()))
        {
            return Err(Error::NotFinite);
        }
        let state = Gaussian::new(mean, Covariance::from_variances(known.as_array()));
        Ok(Self { state, rows, variances, units: output_units })
    }

    /// A copy of the filter, reset to zero with errors of these standard deviations.
    pub(crate) fn begun_anew(&self, start_sigmas: &SVector<f64, 4>) -> Self {
        let (_, in_units) = units();
        let known = (in_units * start_sigmas).map(|sigma| T::from_f64(sigma * sigma));
        let covariance = Covariance::from_variances(known.as_array());
        Self { state: Gaussian::new(SVector::zeros(), covariance), ..*self }
    }

    /// The estimate x̂: α (rad), q (rad/s), V (m/s), θ (rad).
    pub fn estimate(&self) -> SVector<f64, 4> {
        self.state.mean.map(T::to_f64).component_mul(&SVector::from(UNITS))
    }

    /// The covariance P of the estimation error, in the states' units.
    pub fn covariance(&self) -> SMatrix<f64, 4, 4> {
        let (units, _) = units();
        units * self.state.covariance.to_matrix().map(T::to_f64) * units
    }

    /// Standard deviations of the estimation errors: rad, rad/s, m/s, rad.
    pub fn sigma(&self) -> SVector<f64, 4> {
        let variances = self.state.covariance.variances();
        let sigmas = variances.map(|variance| libm::sqrt(variance.to_f64().max(0.0)));
        sigmas.component_mul(&SVector::from(UNITS))
    }

    /// Predicts over a step with these inputs δe (rad) and δt.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged.
    pub fn predict(
        &mut self,
        transition: &Transition<T>,
        input: &SVector<f64, 2>,
    ) -> Result<(), Error> {
        if !input.iter().copied().all(f64::is_finite) {
            return Err(Error::NotFinite);
        }
        let process = Linear { f: &transition.a, q: &transition.noise };
        let input = &input.map(T::from_f64);
        Ok(self.state.advance(&Forced { process, b: &transition.b, input })?)
    }

    /// Processes the measured outputs, and returns for each the innovation in its unit, the innovation's variance and
    /// its NIS.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is unchanged.
    pub fn correct(
        &mut self,
        measured: &[Option<f64>; P],
    ) -> Result<[Option<Innovation<f64>>; P], Error> {
        self.correct_with(measured, |next, weighed, _| Ok(next.correct(weighed)?))
    }

    /// Processes the measured outputs, except those that a gate rejects; innovations are returned for all.
    ///
    /// # Errors
    /// Those of [`KalmanFilter::correct`]; filter and gates are unchanged.
    pub(crate) fn correct_gated(
        &mut self,
        measured: &[Option<f64>; P],
        gates: &mut [Gate; P],
    ) -> Result<Gated<P>, Error> {
        let (mut judging, mut is_left_out) = (*gates, [false; P]);
        let innovations = self.correct_with(measured, |next, weighed, output| {
            // No index is used: it would require a bounds check.
            let places = judging.get_mut(output).zip(is_left_out.get_mut(output));
            if let Some((gate, is_left_out)) = places {
                *is_left_out = !gate.admits(weighed.exceeds(T::from_f64(GATE)));
                if *is_left_out {
                    return Ok(weighed.report());
                }
            }
            Ok(next.correct(weighed)?)
        })?;
        *gates = judging;
        Ok(Gated { innovations, is_left_out })
    }

    fn correct_with(
        &mut self,
        measured: &[Option<f64>; P],
        mut correct: impl FnMut(
            &mut Gaussian<T, 4>,
            &Weighed<T, 4>,
            usize,
        ) -> Result<Innovation<T>, Error>,
    ) -> Result<[Option<Innovation<f64>>; P], Error> {
        let mut next = self.state;
        let mut innovations = [None; P];
        for output in 0..P {
            let Some(measured) = measured[output] else { continue };
            if !measured.is_finite() {
                return Err(Error::NotFinite);
            }
            let unit = self.units.as_array()[output];
            let parts = &self.rows.as_columns()[output];
            let row = SparseRow::<T, 4>::new(from_fn(|state| (state, parts[state])));
            let observation = LinearObservation { row, measured: T::from_f64(measured / unit) };
            let variance = self.variances.as_array()[output];
            let weighed = next.weigh_observation(&observation, variance)?;
            let innovation = correct(&mut next, &weighed, output)?;
            innovations[output] = Some(Innovation {
                innovation: innovation.innovation.to_f64() * unit,
                variance: innovation.variance.to_f64() * (unit * unit),
                nis: innovation.nis.to_f64(),
            });
        }
        self.state = next;
        Ok(innovations)
    }
}

/// The diagonal matrix of the units, and its inverse.
fn units() -> (SMatrix<f64, 4, 4>, SMatrix<f64, 4, 4>) {
    let units = SVector::from(UNITS);
    (SMatrix::from_diagonal(&units), SMatrix::from_diagonal(&units.map(f64::recip)))
}

/// A process of the states with the inputs' effect added, so that the estimate is checked and stored only once.
pub(crate) struct Forced<'a, T, Q> {
    pub(crate) process: Q,
    pub(crate) b: &'a SMatrix<T, 4, 2>,
    pub(crate) input: &'a SVector<T, 2>,
}

impl<T: Scalar, const N: usize, Q: Process<T, N>> Process<T, N> for Forced<'_, T, Q> {
    #[inline(always)]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        self.process.advance(estimate);
        let [elevator, throttle] = self.b.as_columns();
        let parts = elevator.iter().zip(throttle);
        for (mean, (&elevator, &throttle)) in estimate.mean.as_array_mut().iter_mut().zip(parts) {
            *mean += T::dot(&[elevator, throttle], self.input.as_array());
        }
    }
}

/// The largest power of two not above `size`; 1 if `size` is not a normal number.
pub(crate) fn power_of_two(size: f64) -> f64 {
    const EXPONENT: u64 = 0x7FF << 52;
    if size.is_normal() { f64::from_bits(size.to_bits() & EXPONENT) } else { 1.0 }
}
