//! The steady-state Kalman filter.

use crate::Error;
use crate::covariance::checked;
use crate::error::Mode;
use crate::extended::Extended;
use crate::lyapunov::stable;
use crate::number::{Square, Times, extend, finite, norm, round, symmetrised};
use crate::observability::hidden;
use crate::pair::Pair;
use crate::solve::{Eliminated, solve};
use kestirim_scalar::Columns;
use nalgebra::SMatrix;

/// Steady-state Kalman filter of x⁺ = A x + w, y = C x + v.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Riccati<const N: usize, const P: usize> {
    /// P⁻ = A P⁻ Aᵀ + Q − A P⁻ Cᵀ (C P⁻ Cᵀ + R)⁻¹ C P⁻ Aᵀ, the covariance before an update.
    pub prior: SMatrix<f64, N, N>,
    /// P⁺ = (I − K C) P⁻, the covariance after an update.
    pub posterior: SMatrix<f64, N, N>,
    /// K = P⁻ Cᵀ (C P⁻ Cᵀ + R)⁻¹, the gain of the update x̂ ← x̂⁻ + K (y − C x̂⁻).
    pub filter_gain: SMatrix<f64, N, P>,
    /// A K, the gain of the predictor form x̂⁺ = A x̂ + B u + A K (y − C x̂).
    pub predictor_gain: SMatrix<f64, N, P>,
    /// Number of doublings until convergence: k of them are equivalent to 2ᵏ steps of the filter.
    pub doublings: u32,
}

const MOST_DOUBLINGS: u32 = 64;
/// Distance from the unit circle below which a mode is taken to lie on it.
const ON_THE_CIRCLE: f64 = 1e-10;
/// Size of the last step relative to the posterior at which a solution is accepted: only its square remains as error.
const SETTLED: f64 = 1e-10;
/// Initial variance of an almost unknown state, relative to that left by one measurement.
const DOUBT: f64 = 16.0;
/// Smallest eigenvalue, relative to the variances, of a measurement noise that can be inverted.
const LEAST_NOISE: f64 = 1e-13;

/// Solves the Riccati equation by structure-preserving doubling (Chu, Fan, Lin & Wang, Int. J. Control 77
/// (2004)): A may be singular, and 25 doublings replace 30 million steps of the filter.
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
    let (pair, _) = Pair::new(a, c)?;
    detectable(&pair)?;
    driven(a, q)?;

    let (dynamics, outputs) = (pair.dynamics, pair.scaled(&extend(c)));
    let information =
        outputs.transpose().times(&solve(&measurement, &outputs).ok_or(Error::NotPositive)?);
    let equation = Equation {
        f: dynamics.transpose(),
        g: symmetrised(&information),
        h: pair.covariance_in(&process),
    };
    let (prior, doublings) = equation.solved()?;

    let innovation =
        symmetrised(&(outputs.times(&prior).times(&outputs.transpose()))) + measurement;
    let gain = solve(&innovation, &outputs.times(&prior)).ok_or(Error::NotConverged)?.transpose();
    let answer = Riccati {
        prior: round(&pair.covariance_out(&prior)),
        posterior: round(
            &pair.covariance_out(&symmetrised(&(prior - gain.times(&outputs).times(&prior)))),
        ),
        filter_gain: round(&pair.gain_out(&gain)),
        predictor_gain: round(&pair.gain_out(&dynamics.times(&gain))),
        doublings,
    };
    let all_finite =
        finite(&answer.prior) && finite(&answer.posterior) && finite(&answer.predictor_gain);
    if all_finite { Ok(answer) } else { Err(Error::NotFinite) }
}

/// The Riccati equation X = Fᵀ X (I + G X)⁻¹ F + H.
struct Equation<const N: usize> {
    f: Square<Extended, N>,
    g: Square<Extended, N>,
    h: Square<Extended, N>,
}

impl<const N: usize> Equation<N> {
    /// The stabilising solution, and the number of doublings.
    fn solved(&self) -> Result<(Square<Extended, N>, u32), Error> {
        if let Some((solution, doublings)) = self.doubled(self, &Square::zeros())
            && self.settles(&solution)
        {
            return Ok((solution, doublings));
        }
        // A mode that grows without being driven is never found from a covariance of zero: start from an uncertain
        // state.
        let size = norm(&self.g);
        let doubt =
            Square::<Extended, N>::identity().map(|value| value * Extended::from(DOUBT / size));
        let found = self.beside(&doubt).and_then(|moved| moved.doubled(self, &doubt));
        let (solution, doublings) = found.ok_or(Error::NotConverged)?;
        if self.settles(&solution) { Ok((solution, doublings)) } else { Err(Error::NotConverged) }
    }

    /// The solution of `whole`, where `self` is the equation for its difference from `start`.
    fn doubled(
        &self,
        whole: &Self,
        start: &Square<Extended, N>,
    ) -> Option<(Square<Extended, N>, u32)> {
        let Self { mut f, mut g, mut h } = *self;
        for doubling in 1..=MOST_DOUBLINGS {
            let both = Eliminated::new(&(Square::identity() + g.times(&h)))?;
            let (forward, cross) = (both.solve(&f), both.solve(&g));
            let step = symmetrised(&f.transpose().times(&h).times(&forward));
            g = symmetrised(&(g + f.times(&cross).times(&f.transpose())));
            h += step;
            f = f.times(&forward);
            let prior = start + h;
            // The posterior is no larger than the prior, so for most steps the first comparison suffices.
            if negligible(&step, &prior) && negligible(&step, &whole.posterior(&prior)?) {
                return Some((prior, doubling));
            }
        }
        None
    }

    /// The posterior covariance after a measurement.
    fn posterior(&self, prior: &Square<Extended, N>) -> Option<Square<Extended, N>> {
        solve(&(Square::identity() + prior.times(&self.g)), prior)
    }

    /// The equation for X − Y that is equivalent to this one for X.
    fn beside(&self, y: &Square<Extended, N>) -> Option<Self> {
        let both = Eliminated::new(&(Square::identity() + self.g.times(y)))?;
        let (f, g) = (both.solve(&self.f), both.solve(&self.g));
        let h = self.f.transpose().times(y).times(&f) + self.h - y;
        Some(Self { f, g: symmetrised(&g), h: symmetrised(&h) })
    }

    /// Whether the filter with this prior covariance is stable, and so forgets its past.
    fn settles(&self, prior: &Square<Extended, N>) -> bool {
        solve(&(Square::identity() + self.g.times(prior)), &self.f)
            .is_some_and(|closed| stable(&closed).is_ok())
    }
}

/// Whether a step was so small relative to the posterior that the next one, which is quadratic in it, is negligible.
/// The prior is no measure: beside a large noise in one direction, what the gain depends on may be tiny in another.
fn negligible<const N: usize>(step: &Square<Extended, N>, posterior: &Square<Extended, N>) -> bool {
    let mut deviations = [0.0; N];
    for (state, (deviation, column)) in
        deviations.iter_mut().zip(posterior.as_columns()).enumerate()
    {
        *deviation = column.get(state).map_or(0.0, |variance| libm::sqrt(variance.to_f64().abs()));
    }
    step.as_columns().iter().zip(deviations).all(|(column, across)| {
        let largest = |down: f64| SETTLED * across * down;
        column.iter().zip(deviations).all(|(step, down)| step.to_f64().abs() <= largest(down))
    })
}

/// Refuses a pair of which a mode that does not decay is unobservable.
fn detectable<const N: usize>(pair: &Pair<N>) -> Result<(), Error> {
    let lasting = |mode: &Mode| libm::hypot(mode.re, mode.im) >= 1.0 - ON_THE_CIRCLE;
    match hidden(pair)?.into_iter().flatten().find(lasting) {
        Some(mode) => Err(Error::Undetectable(mode)),
        None => Ok(()),
    }
}

/// Refuses a mode on the unit circle that no noise drives. The directions not driven by Q are the null space of its
/// rows.
fn driven<const N: usize>(a: &SMatrix<f64, N, N>, q: &SMatrix<f64, N, N>) -> Result<(), Error> {
    let (pair, _) = Pair::new(&a.transpose(), q)?;
    let undying = |mode: &Mode| (libm::hypot(mode.re, mode.im) - 1.0).abs() <= ON_THE_CIRCLE;
    match hidden(&pair)?.into_iter().flatten().find(undying) {
        Some(mode) => Err(Error::Undriven(mode)),
        None => Ok(()),
    }
}
