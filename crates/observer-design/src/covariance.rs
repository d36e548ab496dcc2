//! Checks of covariances.

use crate::Error;
use crate::eigenvalues::eigenvalues_extended;
use crate::extended::Extended;
use crate::number::{Square, extend, finite, symmetrised};
use nalgebra::SMatrix;

/// Asymmetry and negative eigenvalues attributed to rounding, relative to the variances.
const NEGLIGIBLE: f64 = 1e-10;

/// The covariance with 106 bits, exactly symmetric, and its smallest eigenvalue on a scale on which all
/// variances are 1.
///
/// # Errors
/// [`Error::NotFinite`], [`Error::NotSymmetric`], or [`Error::NotPositive`] for a negative eigenvalue.
pub(crate) fn checked<const N: usize>(
    covariance: &SMatrix<f64, N, N>,
) -> Result<(Square<Extended, N>, f64), Error> {
    if !finite(covariance) {
        return Err(Error::NotFinite);
    }
    let mut scales = [0.0; N];
    for (index, scale) in scales.iter_mut().enumerate() {
        *scale = libm::sqrt(covariance[(index, index)].max(0.0));
    }
    let mut correlation = Square::<f64, N>::zeros();
    for row in 0..N {
        for column in 0..N {
            let (here, there) = (covariance[(row, column)], covariance[(column, row)]);
            let scale = scales[row] * scales[column];
            let rounding = if scale > 0.0 { scale } else { here.abs().max(there.abs()) };
            if (here - there).abs() > NEGLIGIBLE * rounding {
                return Err(Error::NotSymmetric);
            }
            correlation[(row, column)] = if scale > 0.0 { here / scale } else { 0.0 };
            if covariance[(row, row)] < 0.0 || (scale == 0.0 && here != 0.0) {
                return Err(Error::NotPositive);
            }
        }
    }
    let values = eigenvalues_extended(&symmetrised(&extend(&correlation)))?;
    let least = values.iter().map(|value| value.re.to_f64()).fold(f64::INFINITY, f64::min);
    if least < -NEGLIGIBLE {
        return Err(Error::NotPositive);
    }
    Ok((symmetrised(&extend(covariance)), least))
}
