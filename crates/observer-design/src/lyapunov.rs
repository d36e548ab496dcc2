//! The covariance at which an error settles.

use crate::Error;
use crate::covariance::checked;
use crate::eigenvalues::{eigenvalues_extended, eigenvector};
use crate::error::Mode;
use crate::extended::Extended;
use crate::number::{
    Square, Times, complex, extend, finite, norm, round, round_complex, symmetrised,
};
use crate::observability::dominant;
use nalgebra::{Complex, SMatrix};

/// Limit on the doublings, enough for the slowest mode that a double can represent to settle.
const MOST_DOUBLINGS: u32 = 64;

/// Norm of the transition below which the sum has settled.
const SETTLED: f64 = 1e-20;

/// Solves P = F P Fᵀ + Q for P, by doubling (Smith 1968).
///
/// # Errors
/// [`Error::Unstable`] with the mode of F that does not decay, [`Error::NotFinite`], and [`Error::NotSymmetric`] or
/// [`Error::NotPositive`] for Q.
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

/// The covariance of the error of the observer x̂⁺ = A x̂ + B u + L (y − C x̂).
///
/// In every step, noise G w, where w has covariance Q, disturbs the plant; R is the covariance of the noise of the
/// outputs. The diagonal of the result holds the squares of the expected RMSE. For noise on the inputs G is B, for
/// noise on the states it is the identity.
///
/// # Errors
/// As [`lyapunov`], for A − L C, Q and R.
pub fn error_covariance<const N: usize, const M: usize, const P: usize>(
    observed: (&SMatrix<f64, N, N>, &SMatrix<f64, P, N>),
    gain: &SMatrix<f64, N, P>,
    process: (&SMatrix<f64, N, M>, &SMatrix<f64, M, M>),
    r: &SMatrix<f64, P, P>,
) -> Result<SMatrix<f64, N, N>, Error> {
    let ((a, c), (input, q)) = (observed, process);
    let (process, measurement) = (checked(q)?.0, checked(r)?.0);
    if !finite(a) || !finite(c) || !finite(gain) || !finite(input) {
        return Err(Error::NotFinite);
    }
    let (gain, input) = (extend(gain), extend(input));
    let disturbance = input.times(&process).times(&input.transpose())
        + gain.times(&measurement).times(&gain.transpose());
    settled(&(extend(a) - gain.times(&extend(c))), &symmetrised(&disturbance))
}

fn settled<const N: usize>(
    f: &Square<Extended, N>,
    q: &Square<Extended, N>,
) -> Result<SMatrix<f64, N, N>, Error> {
    stable(f)?;
    let (mut transition, mut sum) = (*f, *q);
    for _ in 0..MOST_DOUBLINGS {
        let step = transition.times(&sum).times(&transition.transpose());
        sum = symmetrised(&(sum + step));
        transition = transition.times(&transition);
        if norm(&transition) <= SETTLED {
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
        // A NaN radius fails as well.
        Some(largest) if radius(largest).total_cmp(&1.0).is_ge() => {
            let state = eigenvector(&complex(f), *largest).map_or(0, |vector| dominant(&vector));
            Err(Error::Unstable(Mode::new(round_complex(*largest), state)))
        }
        _ => Ok(()),
    }
}
