use super::CONTRADICTION;
use kestirim_kalman::{Error, Gaussian, Observation, SparseRow};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A standstill: one component of the velocity is measured as zero.
///
/// Physics: h(x) = vᵢ, z = 0.
///
/// Jacobian: ∂h/∂vᵢ = 1, zero otherwise.
///
/// Source: the zero-velocity update of inertial navigation (Groves 2013, 15.3).
pub(crate) struct Standstill {
    /// Index of vᵢ among the states.
    index: usize,
}

impl Standstill {
    /// Standard deviation of the velocity of a stationary tag, m/s.
    const SIGMA: f64 = 0.015;
    /// Velocity that range errors of a stationary tag cannot cause, m/s.
    const FAST: f64 = 0.3;

    /// Updates the estimate with all D components of the velocity being zero.
    #[inline]
    pub(crate) fn correct<T: Scalar, const D: usize, const N: usize>(
        estimate: &mut Gaussian<T, N>,
    ) -> Result<(), Error> {
        for index in D..2 * D {
            estimate.observe(&Self { index }, T::from_f64(Self::SIGMA * Self::SIGMA))?;
        }
        Ok(())
    }

    /// Whether the velocity is consistent with zero: no component exceeds 3 σ.
    #[inline]
    pub(crate) fn agrees<T: Scalar, const D: usize, const N: usize>(
        estimate: &Gaussian<T, N>,
    ) -> bool {
        Self::is_within::<T, D, N>(estimate, T::ZERO)
    }

    /// Whether the velocity is certainly not zero: a component exceeds both 3 σ and `FAST`.
    #[inline]
    pub(crate) fn is_refuted<T: Scalar, const D: usize, const N: usize>(
        estimate: &Gaussian<T, N>,
    ) -> bool {
        !Self::is_within::<T, D, N>(estimate, T::from_f64(Self::FAST * Self::FAST))
    }

    /// Whether no component's square exceeds both that of 3 σ and `least`, (m/s)².
    #[inline]
    fn is_within<T: Scalar, const D: usize, const N: usize>(
        estimate: &Gaussian<T, N>,
        least: T,
    ) -> bool {
        let variances = estimate.covariance.variances();
        let pairs = estimate.mean.iter().zip(variances.iter()).skip(D).take(D);
        let mut standing = pairs.map(|(&velocity, &variance)| {
            let spread = variance + T::from_f64(Self::SIGMA * Self::SIGMA);
            velocity * velocity <= (spread * T::from_f64(CONTRADICTION)).max(least)
        });
        standing.all(|standing| standing)
    }
}

impl<T: Scalar, const N: usize> Observation<T, N> for Standstill {
    type Row = SparseRow<T, 1>;

    #[inline]
    fn linearise(&self, mean: &SVector<T, N>) -> Result<(T, Self::Row), Error> {
        let velocity = mean.as_array().get(self.index).copied().unwrap_or(T::ZERO);
        Ok((-velocity, SparseRow::new([(self.index, T::ONE)])))
    }
}
