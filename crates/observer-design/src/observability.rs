//! Observability and controllability of modes.

use crate::Error;
use crate::eigenvalues::eigenvalues_extended;
use crate::error::Mode;
use crate::extended::Extended;
use crate::number::{Real, Square, Times, adjoint, complex, norm, round_complex, shifted};
use crate::orthonormal::{inner, length, normalised, oblique};
use crate::pair::Pair;
use crate::solve::Eliminated;
use nalgebra::{Complex, SMatrix, SVector};

/// Observability of the least observable mode, by the test of Popov, Belevitch and Hautus.
///
/// It is the smallest singular value of [A − λ; C] at an eigenvalue λ, on a balanced scale on which A (without its mean
/// diagonal) and C have size 1. The rank and the determinant of [C; CA; …] say little: at 100 Hz, powers of A are so
/// alike that the determinant of a perfectly observable aircraft vanishes in rounding.
///
/// # Errors
/// [`Error::Unobservable`] with the mode that no output sees, if the singular value is no larger than
/// rounding of A and C to doubles can explain; [`Error::NotFinite`]; [`Error::NotConverged`].
pub fn observability<const N: usize, const P: usize>(
    a: &SMatrix<f64, N, N>,
    c: &SMatrix<f64, P, N>,
) -> Result<f64, Error> {
    let (pair, _) = Pair::new(a, c)?;
    match least_visible(&pair)? {
        (_, Some(mode)) => Err(Error::Unobservable(mode)),
        (margin, None) => Ok(margin),
    }
}

/// The modes that no output sees, each once, followed by `None` in the remaining places.
///
/// # Errors
/// [`Error::NotFinite`]; [`Error::NotConverged`].
pub fn hidden_modes<const N: usize, const P: usize>(
    a: &SMatrix<f64, N, N>,
    c: &SMatrix<f64, P, N>,
) -> Result<[Option<Mode>; N], Error> {
    hidden(&Pair::new(a, c)?.0)
}

pub(crate) fn hidden<const N: usize>(pair: &Pair<N>) -> Result<[Option<Mode>; N], Error> {
    let (mut modes, mut count) = ([None; N], 0);
    for (_, hidden) in sights(pair)? {
        if let Some(mode) = hidden
            && !modes.iter().flatten().any(|other: &Mode| other.is_twin_of(&mode))
            && let Some(place) = modes.get_mut(count)
        {
            *place = Some(mode);
            count += 1;
        }
    }
    Ok(modes)
}

/// Controllability of the least controllable mode: the [`observability`] of (Aᵀ, Bᵀ).
///
/// # Errors
/// [`Error::Uncontrollable`] with the mode that no input moves; [`Error::NotFinite`]; [`Error::NotConverged`].
pub fn controllability<const N: usize, const M: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SMatrix<f64, N, M>,
) -> Result<f64, Error> {
    observability(&a.transpose(), &b.transpose()).map_err(|error| match error {
        Error::Unobservable(mode) => Error::Uncontrollable(mode),
        other => other,
    })
}

/// Observability of the least observable mode, and that mode itself if it counts as hidden.
pub(crate) fn least_visible<const N: usize>(pair: &Pair<N>) -> Result<(f64, Option<Mode>), Error> {
    let worst = sights(pair)?.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b));
    Ok(worst.unwrap_or((f64::INFINITY, None)))
}

/// Observability of each mode, and the mode itself if it counts as hidden: if rounding can explain its observability.
fn sights<const N: usize>(pair: &Pair<N>) -> Result<[(f64, Option<Mode>); N], Error> {
    // A shift of the diagonal changes no eigenvector, and at high rates A is nearly the identity.
    let mut mean = Extended::from(0.0);
    for state in 0..N {
        mean += pair.dynamics[(state, state)];
    }
    mean /= Extended::from(N as f64);
    let centred = shifted(&pair.dynamics, mean);
    // A multiple of the identity vanishes when centred, but its rounding does not.
    let size = |norm: f64, otherwise: f64| if norm > 0.0 { norm } else { otherwise };
    let whole = norm(&pair.dynamics);
    let spread = size(norm(&centred), size(whole, 1.0));
    let unit = Extended::from(1.0 / spread);
    let dynamics = complex(&centred.map(|value| value * unit));
    let output_unit = Extended::from(1.0 / size(pair.outputs_norm(), 1.0));
    let outputs = complex(&pair.outputs.map(|value| value * output_unit));
    let rounding = 4.0 * f64::EPSILON * (1.0 + whole / spread);

    let mut sights = [(f64::INFINITY, None); N];
    for (seen, eigenvalue) in sights.iter_mut().zip(eigenvalues_extended(&pair.dynamics)?) {
        let start = Complex { re: (eigenvalue.re - mean) * unit, im: eigenvalue.im * unit };
        let (sight, at, vector) =
            visibility(&dynamics, &outputs, start).ok_or(Error::NotConverged)?;
        let pole = Complex { re: at.re / unit + mean, im: at.im / unit };
        let hidden = (sight <= rounding).then(|| Mode::new(round_complex(pole), dominant(&vector)));
        *seen = (sight, hidden);
    }
    Ok(sights)
}

/// Limit on the iterations in which λ follows the vector: at a multiple mode, each halves the distance.
const FOLLOWED: u32 = 80;

/// The smallest singular value of [A − λ; C] near an eigenvalue, the λ at which it is reached, and its vector.
///
/// A multiple eigenvalue is only known roughly, so λ follows the singular vector to where
/// the singular value is smallest.
fn visibility<const N: usize>(
    dynamics: &Square<Complex<Extended>, N>,
    outputs: &Square<Complex<Extended>, N>,
    eigenvalue: Complex<Extended>,
) -> Option<(f64, Complex<Extended>, SVector<Complex<Extended>, N>)> {
    let outputs_squared = adjoint(outputs).times(outputs);
    let mut at = eigenvalue;
    let mut vector = oblique();
    let mut best: Option<(f64, Complex<Extended>, SVector<Complex<Extended>, N>)> = None;
    for _ in 0..FOLLOWED {
        let distance = shifted(dynamics, at);
        // The small diagonal term keeps an exactly singular matrix from stopping the inverse iteration.
        let gram = Eliminated::new(&shifted(
            &(adjoint(&distance).times(&distance) + outputs_squared),
            Complex::from(Extended::from(-1e-30)),
        ));
        for _ in 0..2 {
            let next = gram.as_ref().map_or(vector, |gram| gram.solve(&vector));
            vector = normalised(&next, 0.0)?;
        }
        let seen = length(&distance.times(&vector)).rounded();
        let sight = libm::hypot(seen, length(&outputs.times(&vector)).rounded());
        let before = best.as_ref().map_or(f64::INFINITY, |(least, ..)| *least);
        if sight < before {
            best = Some((sight, at, vector));
        }
        if sight > 0.9 * before {
            break;
        }
        at = inner(&vector, &dynamics.times(&vector));
    }
    best
}

/// The index of the state that has the largest part in a mode.
pub(crate) fn dominant<const N: usize>(vector: &SVector<Complex<Extended>, N>) -> usize {
    let sizes = vector.iter().map(|value| value.norm_sqr().rounded()).enumerate();
    sizes.max_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(state, _)| state)
}
