use crate::Learning;
use kestirim_kalman::Covariance;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The diagonal process noise Q of N states, learnt from how far updates move them.
///
/// Q ← α Q + (1 − α) diag(Δx²) with Δx = K ν, the change by an epoch's updates (the diagonal of eq.
/// 19), each entry within its limits. With a lower limit, the filter never stops following its
/// measurements.
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
pub struct ProcessNoise<T: Scalar, const N: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    variances: [T; N],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    learning: [Learning<T>; N],
}

impl<T: Scalar, const N: usize> ProcessNoise<T, N> {
    /// Starts from variances over one step, clamped to their limits.
    pub fn new(variances: [T; N], learning: [Learning<T>; N]) -> Self {
        let mut limited = variances;
        for (variance, learning) in limited.iter_mut().zip(&learning) {
            *variance = learning.limited(*variance);
        }
        Self { variances: limited, learning }
    }

    /// The diagonal of Q, over one step.
    #[inline]
    pub fn variances(&self) -> &[T; N] {
        &self.variances
    }

    /// Q as a covariance, over one step.
    #[inline]
    pub fn covariance(&self) -> Covariance<T, N> {
        Covariance::from_variances(&self.variances)
    }

    /// Learns from Δx, the change of the mean by the updates of one epoch.
    #[inline]
    pub fn learn(&mut self, moved: &SVector<T, N>) {
        for ((variance, learning), &moved) in
            self.variances.iter_mut().zip(&self.learning).zip(moved.as_array())
        {
            *variance = learning.learn(*variance, moved * moved);
        }
    }
}
