//! The covariance at which errors settle.

use crate::Error;
use crate::covariance::checked;
use crate::eigenvalues::eigenvalues_extended;
use crate::error::Mode;
use crate::extended::Extended;
use crate::number::{Square, extend, finite, norm, round, round_complex, symmetrised};
use crate::poles::size;
use nalgebra::{Complex, SMatrix};

/// Doublings after which the slowest mode a double can hold has settled.
const MOST_DOUBLINGS: u32 = 64;

/// P of P = F P Fᵀ + Q, by doubling (Smith 1968).
///
/// # Errors
/// [`Error::Unstable`] with the mode of F that does not decay, [`Error::NotFinite`], [`Error::NotSymmetric`] or
/// [`Error::NotPositive`] of Q.
pub fn lyapunov<const N: usize>(
    f: &SMatrix<f64, N, N>,
    q: &SMatrix<f64, N, N>,
) -> Result<SMatrix<f64, N, N>, Error> {
    let noise = checked(q)?.0;
    if !finite(f) {
        return Err(Error::NotFinite);
    }
    settled(&extend(f), &noise)
}

/// The covariance of the error of x̂⁺ = A x̂ + B u + L (y − C x̂), where the plant's state is disturbed by noise of
/// covariance Q a step and its outputs by R: its diagonal holds the squares of the expected RMSE. Nothing is
/// rounded in between.
///
/// # Errors
/// As [`lyapunov`], of A − L C, Q and R.
pub fn error_covariance<const N: usize, const P: usize>(
    a: &SMatrix<f64, N, N>,
    c: &SMatrix<f64, P, N>,
    gain: &SMatrix<f64, N, P>,
    q: &SMatrix<f64, N, N>,
    r: &SMatrix<f64, P, P>,
) -> Result<SMatrix<f64, N, N>, Error> {
    let (process, measurement) = (checked(q)?.0, checked(r)?.0);
    if !finite(a) || !finite(c) || !finite(gain) {
        return Err(Error::NotFinite);
    }
    let gain = extend(gain);
    settled(&(extend(a) - gain * extend(c)), &(process + gain * measurement * gain.transpose()))
}

fn settled<const N: usize>(
    f: &Square<Extended, N>,
    q: &Square<Extended, N>,
) -> Result<SMatrix<f64, N, N>, Error> {
    stable(f)?;
    let (mut transition, mut sum) = (*f, *q);
    for _ in 0..MOST_DOUBLINGS {
        let step = transition * sum * transition.transpose();
        sum = symmetrised(&(sum + step));
        transition *= transition;
        // The next step is as much smaller than this one as this one was than the sum.
        if norm(&step) <= 1e-17 * norm(&sum) {
            let answer = round(&sum);
            return if finite(&answer) { Ok(answer) } else { Err(Error::NotFinite) };
        }
    }
    Err(Error::NotConverged)
}

/// # Errors
/// [`Error::Unstable`] with an eigenvalue on or outside the unit circle.
pub(crate) fn stable<const N: usize>(f: &Square<Extended, N>) -> Result<(), Error> {
    let values = eigenvalues_extended(f)?;
    let radius = |value: &Complex<Extended>| (value.re * value.re + value.im * value.im).to_f64();
    match values.iter().max_by(|a, b| radius(a).total_cmp(&radius(b))) {
        Some(largest) if size(round_complex(*largest)) >= 1.0 || !(radius(largest) < 1.0) => {
            Err(Error::Unstable(Mode::new(round_complex(*largest), 0)))
        }
        _ => Ok(()),
    }
}
