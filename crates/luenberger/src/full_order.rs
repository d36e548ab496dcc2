//! Parts shared by the predictor and the current form of a full-order observer.

use crate::Error;
use crate::carried::Carried;
use crate::dense::{Dense, negative};
use crate::increment::{Increment, IntegerIncrement};
use crate::rows::{IntegerRows, Rows};
use kestirim_scalar::Scalar;
use nalgebra::SVector;

/// The coefficients of a [`FullOrder`] as integers, before conversion to a scalar type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FullOrderGains<const N: usize, const M: usize, const P: usize> {
    pub(crate) step: IntegerIncrement<N, M, P>,
    pub(crate) unseen: IntegerRows<P, N>,
}

impl<const N: usize, const M: usize, const P: usize> FullOrderGains<N, M, P> {
    /// The coefficients from the blocks of a step and from C.
    pub(crate) const fn new(step: IntegerIncrement<N, M, P>, c: &Dense<P, N>) -> Self {
        Self { step, unseen: IntegerRows::new(&negative(c)) }
    }
}

/// An estimate of all N states, the increment of a step, and the model of the measurement.
///
/// Each observer builds it in place: a constructor would cost a copy at opt-level "s".
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
    /// −C, which yields the innovation.
    pub(crate) unseen: Rows<T, P, N>,
}

impl<T: Scalar, const N: usize, const M: usize, const P: usize> FullOrder<T, N, M, P> {
    #[inline(always)]
    pub(crate) fn reset(&mut self, start: &SVector<T, N>) -> Result<(), Error> {
        self.estimate = Carried::new(start)?;
        Ok(())
    }

    /// The innovation y − C x for a measurement and a state.
    #[inline(always)]
    pub(crate) fn innovation(
        &self,
        state: &Carried<T, N>,
        measured: &SVector<T, P>,
    ) -> SVector<T, P> {
        self.unseen.added(measured, &state.value)
    }
}
