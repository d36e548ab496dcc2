//! The gain at which a Kalman filter settles.

use crate::Error;
use crate::covariance::checked;
use crate::extended::Extended;
use crate::lyapunov::stable;
use crate::number::{Square, extend, finite, norm, round, symmetrised};
use crate::observability::least_visible;
use crate::pair::Pair;
use crate::poles::size;
use crate::solve::solve;
use nalgebra::{Complex, SMatrix};

/// What a filter of x⁺ = A x + w, y = C x + v settles at.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Riccati<const N: usize, const P: usize> {
    /// P⁻ = A P⁻ Aᵀ + Q − A P⁻ Cᵀ (C P⁻ Cᵀ + R)⁻¹ C P⁻ Aᵀ, the covariance before an update.
    pub prior: SMatrix<f64, N, N>,
    /// P⁺ = (I − K C) P⁻, the covariance after it.
    pub posterior: SMatrix<f64, N, N>,
    /// K = P⁻ Cᵀ (C P⁻ Cᵀ + R)⁻¹, for x̂ ← x̂⁻ + K (y − C x̂⁻).
    pub filter_gain: SMatrix<f64, N, P>,
    /// A K, for x̂⁺ = A x̂ + B u + A K (y − C x̂).
    pub predictor_gain: SMatrix<f64, N, P>,
    /// Doublings it took: k of them are 2ᵏ steps of the filter.
    pub doublings: u32,
}

const MOST_DOUBLINGS: u32 = 40;
/// A mode this close to the unit circle is taken to lie on it.
const ON_THE_CIRCLE: f64 = 1e-10;
/// The least eigenvalue of a measurement noise that can be inverted, beside its variances.
const LEAST_NOISE: f64 = 1e-13;

/// Solves the Riccati equation by structure-preserving doubling (Chu, Fan, Lin & Wang, Int. J. Control 77
/// (2004)): A may be singular, and 25 doublings do what 30 million steps of the filter would.
///
/// # Errors
/// [`Error::Undetectable`] and [`Error::Undriven`] with the mode in question; [`Error::NotFinite`],
/// [`Error::NotSymmetric`], [`Error::NotPositive`] (R must be positive in every direction);
/// [`Error::NotConverged`].
pub fn riccati<const N: usize, const P: usize>(
    a: &SMatrix<f64, N, N>,
    c: &SMatrix<f64, P, N>,
    q: &SMatrix<f64, N, N>,
    r: &SMatrix<f64, P, P>,
) -> Result<Riccati<N, P>, Error> {
    if !finite(a) || !finite(c) {
        return Err(Error::NotFinite);
    }
    let process = checked(q)?.0;
    let (measurement, least) = checked(r)?;
    if least < LEAST_NOISE {
        return Err(Error::NotPositive);
    }
    detectable(a, c)?;
    driven(a, q)?;

    let (dynamics, outputs) = (extend(a), extend(c));
    let information = solve(&measurement, &outputs).ok_or(Error::NotPositive)?;
    let (prior, doublings) =
        doubled(&dynamics.transpose(), &(outputs.transpose() * information), &process)?;

    let innovation = symmetrised(&(outputs * prior * outputs.transpose())) + measurement;
    let gain = solve(&innovation, &(outputs * prior)).ok_or(Error::NotConverged)?.transpose();
    let predictor = dynamics * gain;
    stable(&(dynamics - predictor * outputs)).map_err(|_| Error::NotConverged)?;
    let answer = Riccati {
        prior: round(&prior),
        posterior: round(&symmetrised(&(prior - gain * outputs * prior))),
        filter_gain: round(&gain),
        predictor_gain: round(&predictor),
        doublings,
    };
    let all_finite =
        finite(&answer.prior) && finite(&answer.posterior) && finite(&answer.predictor_gain);
    if all_finite { Ok(answer) } else { Err(Error::NotFinite) }
}

/// X = Fᵀ X (I + G X)⁻¹ F + H, and the doublings it took.
fn doubled<const N: usize>(
    f: &Square<Extended, N>,
    g: &Square<Extended, N>,
    h: &Square<Extended, N>,
) -> Result<(Square<Extended, N>, u32), Error> {
    let (mut f, mut g, mut h) = (*f, symmetrised(g), *h);
    for doubling in 1..=MOST_DOUBLINGS {
        let both = Square::identity() + g * h;
        let forward = solve(&both, &f).ok_or(Error::NotConverged)?;
        let cross = solve(&both, &g).ok_or(Error::NotConverged)?;
        let step = symmetrised(&(f.transpose() * h * forward));
        g = symmetrised(&(g + f * cross * f.transpose()));
        h += step;
        f *= forward;
        let (change, size) = (norm(&step), norm(&h));
        if !size.is_finite() {
            return Err(Error::NotConverged);
        }
        // Convergence is quadratic: the next change would be the square of this one.
        if change <= 1e-10 * size {
            return Ok((h, doubling));
        }
    }
    Err(Error::NotConverged)
}

/// Every mode that does not decay must be seen.
fn detectable<const N: usize, const P: usize>(
    a: &SMatrix<f64, N, N>,
    c: &SMatrix<f64, P, N>,
) -> Result<(), Error> {
    let (pair, _) = Pair::new(a, c)?;
    match least_visible(&pair, |mode| size(mode) >= 1.0 - ON_THE_CIRCLE)? {
        Some((_, Some(hidden))) => Err(Error::Undetectable(hidden)),
        _ => Ok(()),
    }
}

/// Every mode on the unit circle must be driven by noise. What Q does not drive is the null space of its rows.
fn driven<const N: usize>(a: &SMatrix<f64, N, N>, q: &SMatrix<f64, N, N>) -> Result<(), Error> {
    let (pair, _) = Pair::new(&a.transpose(), q)?;
    let on_the_circle = |mode: Complex<f64>| (size(mode) - 1.0).abs() <= ON_THE_CIRCLE;
    match least_visible(&pair, on_the_circle)? {
        Some((_, Some(hidden))) => Err(Error::Undriven(hidden)),
        _ => Ok(()),
    }
}
