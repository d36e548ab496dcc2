//! Discretisation of continuous-time systems.

use crate::Error;
use crate::covariance;
use crate::extended::Extended;
use crate::number::{Square, Times, extend, finite, norm, round, symmetrised};
use crate::solve::Eliminated;
use nalgebra::SMatrix;

/// A discrete-time system x⁺ = A x + B u.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Discrete<const N: usize, const M: usize> {
    /// A, N × N.
    pub a: SMatrix<f64, N, N>,
    /// B, N × M.
    pub b: SMatrix<f64, N, M>,
}

/// Discretises ẋ = A x + B u with an input held for `interval` seconds: `e^(A h)` and `∫ e^(A s) ds B`.
///
/// The result is exact up to rounding, whether or not A can be inverted.
///
/// # Errors
/// [`Error::Interval`] or [`Error::NotFinite`].
pub fn zero_order_hold<const N: usize, const M: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SMatrix<f64, N, M>,
    interval: f64,
) -> Result<Discrete<N, M>, Error> {
    let flow = Flow::new(a, &Square::zeros(), interval)?;
    answer(&flow.transition, &flow.integral.times(&extend(b)))
}

/// Discretises ẋ = A x + B u by the trapezoidal rule: (I − A h/2)⁻¹ (I + A h/2) and (I − A h/2)⁻¹ B h.
///
/// # Errors
/// [`Error::Interval`], [`Error::NotFinite`], or [`Error::Singular`] if 2/h is a pole.
pub fn tustin<const N: usize, const M: usize>(
    a: &SMatrix<f64, N, N>,
    b: &SMatrix<f64, N, M>,
    interval: f64,
) -> Result<Discrete<N, M>, Error> {
    let interval = checked(a, interval)?;
    let half = extend(a).map(|value| value * interval * Extended::from(0.5));
    let identity = Square::<Extended, N>::identity();
    let backward = Eliminated::new(&(identity - half)).ok_or(Error::Singular)?;
    let input = extend(b).map(|value| value * interval);
    answer(&backward.solve(&(identity + half)), &backward.solve(&input))
}

/// The covariance that white noise of spectral density Qc accumulates over `interval` seconds:
/// `∫ e^(A s) Qc e^(Aᵀ s) ds` (Van Loan 1978).
///
/// # Errors
/// [`Error::Interval`], [`Error::NotFinite`]; [`Error::NotSymmetric`] or [`Error::NotPositive`] for the density.
pub fn discrete_noise<const N: usize>(
    a: &SMatrix<f64, N, N>,
    density: &SMatrix<f64, N, N>,
    interval: f64,
) -> Result<SMatrix<f64, N, N>, Error> {
    covariance::checked(density)?;
    let noise = round(&symmetrised(&Flow::new(a, density, interval)?.noise));
    if finite(&noise) { Ok(noise) } else { Err(Error::NotFinite) }
}

fn checked<const N: usize>(a: &Square<f64, N>, interval: f64) -> Result<Extended, Error> {
    if !finite(a) || !interval.is_finite() {
        return Err(Error::NotFinite);
    }
    if interval <= 0.0 {
        return Err(Error::Interval);
    }
    Ok(Extended::from(interval))
}

fn answer<const N: usize, const M: usize>(
    a: &Square<Extended, N>,
    b: &SMatrix<Extended, N, M>,
) -> Result<Discrete<N, M>, Error> {
    let discrete = Discrete { a: round(a), b: round(b) };
    if finite(&discrete.a) && finite(&discrete.b) { Ok(discrete) } else { Err(Error::NotFinite) }
}

/// Flow of ẋ = A x + w over an interval: the transition, its integral, and the covariance of the noise.
struct Flow<const N: usize> {
    transition: Square<Extended, N>,
    integral: Square<Extended, N>,
    noise: Square<Extended, N>,
}

/// Terms of the series that matter at 106 bits for ‖A h‖ ≤ ½; in that of the noise, the argument is twice as large.
const TERMS: u32 = 30;
/// Limit on the halvings of the interval: a norm that needs more leaves nothing finite.
const MOST_HALVINGS: u32 = 64;

impl<const N: usize> Flow<N> {
    /// The flow by series over an interval that is halved until it is short, then doubled again.
    fn new(a: &Square<f64, N>, density: &Square<f64, N>, interval: f64) -> Result<Self, Error> {
        let whole = checked(a, interval)?;
        let mut halvings = 0;
        let mut part = 1.0;
        while norm(a) * interval * part > 0.5 {
            if halvings == MOST_HALVINGS {
                return Err(Error::NotFinite);
            }
            halvings += 1;
            part *= 0.5;
        }
        let mut flow = Self::short(&extend(a), &extend(density), whole * Extended::from(part));
        for _ in 0..halvings {
            flow = flow.doubled();
        }
        Ok(flow)
    }

    fn short(a: &Square<Extended, N>, density: &Square<Extended, N>, interval: Extended) -> Self {
        // Terms h^k A^(k−1) / k!, and h^k/k! times the k-th derivative of the noise, by P ← A P + P Aᵀ.
        let mut term = Square::<Extended, N>::identity().map(|value| value * interval);
        let mut noise_term = density.map(|value| value * interval);
        let mut integral = term;
        let mut noise = noise_term;
        for k in 2..TERMS {
            let factor = interval / Extended::from(f64::from(k));
            term = a.times(&term).map(|value| value * factor);
            let half = a.times(&noise_term);
            noise_term = (half + half.transpose()).map(|value| value * factor);
            integral += term;
            noise += noise_term;
        }
        Self { transition: Square::identity() + a.times(&integral), integral, noise }
    }

    fn doubled(&self) -> Self {
        Self {
            transition: self.transition.times(&self.transition),
            integral: self.integral + self.transition.times(&self.integral),
            noise: self.noise
                + self.transition.times(&self.noise).times(&self.transition.transpose()),
        }
    }
}
