use crate::carried::Carried;
use crate::dense::less_identity;
use crate::full_order::{FullOrder, FullOrderGains};
use crate::increment::Increment;
use crate::increment::IntegerIncrement;
use crate::integers::{and_magnitudes, exponents, larger};
use crate::rows::Rows;
use crate::{Error, Plant};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The coefficients of a [`CurrentObserver`], independent of its scalar type.
///
/// As a `const`, they need no double-precision arithmetic on the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurrentGains<const N: usize, const M: usize, const P: usize> {
    core: FullOrderGains<N, M, P>,
}

impl<const N: usize, const M: usize, const P: usize> CurrentGains<N, M, P> {
    /// The coefficients for a plant and the gain K, N × P: that of a settled Kalman filter, or A⁻¹ L for a predictor's
    /// L, with which the poles are the predictor's.
    pub const fn new(plant: &Plant<N, M, P>, k: &SMatrix<f64, N, P>) -> Self {
        let (b, c, k) = (&plant.b.data.0, &plant.c.data.0, &k.data.0);
        let state = less_identity(&plant.a.data.0);
        // The rounding remainder is passed between the two halves of a step, so both must be scaled alike.
        let exponents = larger(
            exponents(and_magnitudes(and_magnitudes([0.0; N], &state), b)),
            exponents(and_magnitudes([0.0; N], k)),
        );
        Self { core: FullOrderGains::new(IntegerIncrement::with(exponents, &state, b, k), c) }
    }
}

/// A full-order observer in current form: x̂⁻ = A x̂ + B u, then x̂ = x̂⁻ + K (y − C x̂⁻).
///
/// The estimate includes the newest measurement, whereas that of a [`Predictor`](crate::Predictor) is one interval
/// older. Its error obeys e⁺ = (A − K C A) e, whose poles are those of A − A K C: with K = A⁻¹ L both forms
/// have the same poles. With the gain of `kestirim_kalman::steady_state`, it is the settled Kalman filter.
///
/// Units are the plant's. Cost: N (N + M + 2 P) multiplications.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(
        transparent,
        bound(
            serialize = "T: serde::Serialize, T::Accumulator: serde::Serialize",
            deserialize = "T: serde::Deserialize<'de>, T::Accumulator: serde::Deserialize<'de>"
        )
    )
)]
pub struct CurrentObserver<T: Scalar, const N: usize, const M: usize, const P: usize> {
    /// The increment with the blocks A − I, B and K, and −C.
    core: FullOrder<T, N, M, P>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize> CurrentObserver<T, N, M, P> {
    /// An observer that starts at the state `start`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::TooLarge`].
    #[inline]
    pub fn new(gains: &CurrentGains<N, M, P>, start: &SVector<T, N>) -> Result<Self, Error> {
        Ok(Self {
            core: FullOrder {
                estimate: Carried::new(start)?,
                step: Increment::new(&gains.core.step)?,
                unseen: Rows::new(&gains.core.unseen)?,
            },
        })
    }

    /// Restarts at the state `start`.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn reset(&mut self, start: &SVector<T, N>) -> Result<(), Error> {
        self.core.reset(start)
    }

    /// x̂, the state after the last prediction or correction.
    #[inline]
    pub const fn estimate(&self) -> &SVector<T, N> {
        &self.core.estimate.value
    }

    /// Predicts over one interval, during which these inputs were applied.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn predict(&mut self, input: &SVector<T, M>) -> Result<(), Error> {
        self.core.estimate = self.predicted(input)?;
        Ok(())
    }

    /// Takes in a measurement made at the time of the estimate, and returns the innovation y − C x̂⁻.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn correct(&mut self, measured: &SVector<T, P>) -> Result<SVector<T, P>, Error> {
        let (estimate, innovation) = self.corrected(&self.core.estimate, measured)?;
        self.core.estimate = estimate;
        Ok(innovation)
    }

    /// [`CurrentObserver::predict`] with the inputs since the last measurement, then [`CurrentObserver::correct`] with
    /// the new measurement. Either both succeed or neither is applied.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn step(
        &mut self,
        input: &SVector<T, M>,
        measured: &SVector<T, P>,
    ) -> Result<SVector<T, P>, Error> {
        let (estimate, innovation) = self.corrected(&self.predicted(input)?, measured)?;
        self.core.estimate = estimate;
        Ok(innovation)
    }

    #[inline(always)]
    fn predicted(&self, input: &SVector<T, M>) -> Result<Carried<T, N>, Error> {
        if !T::all_finite(input.as_array()) {
            return Err(Error::NotFinite);
        }
        let FullOrder { estimate, step, .. } = &self.core;
        estimate.advanced(&step.driven(estimate, input), &step.shifts)
    }

    #[inline(always)]
    fn corrected(
        &self,
        prior: &Carried<T, N>,
        measured: &SVector<T, P>,
    ) -> Result<(Carried<T, N>, SVector<T, P>), Error> {
        let innovation = self.core.innovation(prior, measured);
        // In fixed point, a measurement at a limit may not show in the difference.
        if !(T::all_finite(measured.as_array()) && T::all_finite(innovation.as_array())) {
            return Err(Error::NotFinite);
        }
        let mut sums = prior.sums();
        self.core.step.and_output(&mut sums, &innovation);
        Ok((prior.advanced(&sums, &self.core.step.shifts)?, innovation))
    }
}
