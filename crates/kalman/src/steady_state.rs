//! The gain at which a filter settles when neither its model nor its sensors change.

use crate::{Covariance, Error, Gaussian};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// Gain and covariances at which a time-invariant filter settles.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SteadyState<T: Scalar, const N: usize, const M: usize> {
    /// K of x ← x⁻ + K (z − H x⁻), N × M.
    pub gain: SMatrix<T, N, M>,
    /// P⁻, the covariance before an update.
    pub prior: Covariance<T, N>,
    /// P⁺, the covariance after it.
    pub posterior: Covariance<T, N>,
}

/// Limit on the steps of the Riccati recursion, after which it is given up.
const MOST_STEPS: u32 = 100_000;

/// Gain and covariances at which the filter of x ← F x + w, z = H x + v settles, with covariances Q
/// of w and R of v.
///
/// Repeats the Riccati recursion itself until no variance changes by more than its rounding: as
/// slow as the slowest mode, and without any inverse. For firmware, run it on the host.
///
/// # Errors
/// [`Error::NotConverged`], or the reason why an update was refused.
pub fn steady_state<T: Scalar, const N: usize, const M: usize>(
    f: &SMatrix<T, N, N>,
    q: &Covariance<T, N>,
    h: &SMatrix<T, M, N>,
    r: &Covariance<T, M>,
) -> Result<SteadyState<T, N, M>, Error> {
    let nothing = SVector::<T, M>::zeros();
    let mut filter = Gaussian::new(SVector::zeros(), *q);
    // A state that Q does not drive starts uncertain, so that the recursion shows whether it decays
    // or is learnt.
    filter.covariance.add(&Covariance::from_variances(&[T::ONE; N]));
    for _ in 0..MOST_STEPS {
        let before = filter.covariance.variances();
        filter.update_block(h, &nothing, r)?;
        let posterior = filter.covariance;
        filter.predict(f, q)?;
        let after = filter.covariance.variances();
        if before.iter().zip(after.iter()).all(|(&a, &b)| (a - b).abs() <= b.rounding(1)) {
            let prior = filter.covariance;
            return Ok(SteadyState { gain: gain(&prior, h, r)?, prior, posterior });
        }
    }
    Err(Error::NotConverged)
}

/// The gain K by columns: the mean, at first zero, after an update whose only nonzero innovation is
/// 1.
fn gain<T: Scalar, const N: usize, const M: usize>(
    prior: &Covariance<T, N>,
    h: &SMatrix<T, M, N>,
    r: &Covariance<T, M>,
) -> Result<SMatrix<T, N, M>, Error> {
    let mut gain = SMatrix::<T, N, M>::zeros();
    for column in 0..M {
        let mut unit = SVector::<T, M>::zeros();
        unit.as_array_mut()[column] = T::ONE;
        let mut filter = Gaussian::new(SVector::zeros(), *prior);
        filter.update_block(h, &unit, r)?;
        gain.as_columns_mut()[column] = *filter.mean.as_array();
    }
    Ok(gain)
}
