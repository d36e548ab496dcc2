//! Parts that the predictor and the current form of a full-order observer share.

use crate::Error;
use crate::carried::Carried;
use crate::dense::{Dense, negative};
use crate::increment::{Increment, IntegerIncrement};
use crate::rows::{IntegerRows, Rows};
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// The coefficients of a [`FullOrder`] on their way to a scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FullOrderGains<const N: usize, const M: usize, const P: usize> {
    pub(crate) step: IntegerIncrement<N, M, P>,
    pub(crate) unseen: IntegerRows<P, N>,
}

impl<const N: usize, const M: usize, const P: usize> FullOrderGains<N, M, P> {
    /// From the blocks of a step, and C.
    pub(crate) const fn new(step: IntegerIncrement<N, M, P>, c: &Dense<P, N>) -> Self {
        Self { step, unseen: IntegerRows::new(&negative(c)) }
    }
}

/// An estimate of all N states, what a step adds to it, and what is expected of a measurement.
///
/// Each observer puts it together in place: a constructor of its own would cost a copy at opt-level "s".
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, T::Accumulator: serde::Serialize",
        deserialize = "T: serde::Deserialize<'de>, T::Accumulator: serde::Deserialize<'de>"
    ))
)]
pub(crate) struct FullOrder<T: Scalar, const N: usize, const M: usize, const P: usize> {
    pub(crate) estimate: Carried<T, N>,
    pub(crate) step: Increment<T, N, M, P>,
    /// −C.
    pub(crate) unseen: Rows<T, P, N>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize> FullOrder<T, N, M, P> {
    #[inline(always)]
    pub(crate) fn reset(&mut self, start: &SVector<T, N>) -> Result<(), Error> {
        self.estimate = Carried::new(start)?;
        Ok(())
    }

    /// y − C x of this measurement and this state.
    #[inline(always)]
    pub(crate) fn innovation(
        &self,
        state: &Carried<T, N>,
        measured: &SVector<T, P>,
    ) -> SVector<T, P> {
        self.unseen.added(measured, &state.value)
    }
}
