use crate::carried::Carried;
use crate::dense::{less_identity, less_product};
use crate::full_order::{FullOrder, FullOrderGains};
use crate::increment::Increment;
use crate::increment::IntegerIncrement;
use crate::rows::Rows;
use crate::{Error, Plant};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The coefficients of a [`Predictor`], independent of its scalar type.
///
/// As a `const`, they need no double-precision arithmetic on the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictorGains<const N: usize, const M: usize, const P: usize> {
    core: FullOrderGains<N, M, P>,
}

impl<const N: usize, const M: usize, const P: usize> PredictorGains<N, M, P> {
    /// The coefficients for a plant and the gain L, N × P, that places the poles of A − L C; or A K, where K is the
    /// gain of a settled Kalman filter.
    pub const fn new(plant: &Plant<N, M, P>, l: &SMatrix<f64, N, P>) -> Self {
        let (b, c, l) = (&plant.b.data.0, &plant.c.data.0, &l.data.0);
        let state = less_product(&less_identity(&plant.a.data.0), l, c);
        Self { core: FullOrderGains::new(IntegerIncrement::new(&state, b, l), c) }
    }
}

/// A full-order observer in predictor form: x̂⁺ = A x̂ + B u + L (y − C x̂) (the thesis' eq. 4.14, in discrete
/// time).
///
/// A step takes inputs and measurements of one instant and gives the estimate for the next, which leaves a
/// whole interval for the arithmetic but makes the estimate one interval old. It is computed as
/// x̂⁺ = x̂ + (A − I − L C) x̂ + B u + L y, whose coefficients are small where the modes are slow and keep all
/// their digits, and the rounding remainder of a step is carried to the next.
///
/// Units are the plant's. Cost: N (N + M + P) multiplications.
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
pub struct Predictor<T: Scalar, const N: usize, const M: usize, const P: usize> {
    /// The increment with the blocks A − I − L C, B and L, and −C.
    core: FullOrder<T, N, M, P>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize> Predictor<T, N, M, P> {
    /// An observer that starts at the state `start`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::TooLarge`].
    #[inline]
    pub fn new(gains: &PredictorGains<N, M, P>, start: &SVector<T, N>) -> Result<Self, Error> {
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

    /// x̂, the state at the time of the next measurement.
    #[inline]
    pub const fn estimate(&self) -> &SVector<T, N> {
        &self.core.estimate.value
    }

    /// y − C x̂, the innovation that [`Predictor::step`] with this measurement would use. The step itself does not need
    /// it.
    #[inline]
    pub fn innovation(&self, measured: &SVector<T, P>) -> SVector<T, P> {
        self.core.innovation(&self.core.estimate, measured)
    }

    /// Moves on by one step with the inputs that the actuators applied and a measurement made at the estimate's time.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn step(&mut self, input: &SVector<T, M>, measured: &SVector<T, P>) -> Result<(), Error> {
        self.core.estimate = self.core.step.advanced(&self.core.estimate, input, measured)?;
        Ok(())
    }

    /// Moves on by one step without a measurement, as if the expected one had been made.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; the estimate is untouched.
    #[inline]
    pub fn coast(&mut self, input: &SVector<T, M>) -> Result<(), Error> {
        let mut expected = self.innovation(&SMatrix::from([[T::ZERO; P]; 1]));
        for output in expected.as_array_mut() {
            *output = -*output;
        }
        self.step(input, &expected)
    }
}
