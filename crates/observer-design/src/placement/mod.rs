//! Pole placement.

mod polish;
mod problem;
mod several;
mod single;

use crate::Error;
use crate::extended::Extended;
use crate::number::{Square, round};
use crate::observability::least_visible;
use crate::pair::Pair;
use crate::poles::{arrange, multiplicity};
use nalgebra::{Complex, SMatrix};
use problem::{Checked, Problem};

/// An observer gain and the poles that result from it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Placement<const N: usize, const P: usize> {
    /// L of x̂⁺ = A x̂ + B u + L (y − C x̂), N × P.
    pub gain: SMatrix<f64, N, P>,
    /// The actual eigenvalues of A − L C in the order of the wanted ones, computed with 106 bits
    /// from the doubles in `gain`.
    pub poles: [PlacedPole; N],
    /// Error of the worst pole, relative to its own magnitude (to the size of the system for a wanted pole of zero).
    pub error: f64,
    /// Observability of the least observable mode; see [`observability`](crate::observability).
    pub visibility: f64,
}

/// An eigenvalue of A − L C.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PlacedPole {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl<const N: usize, const P: usize> Placement<N, P> {
    /// Number of the 16 digits of a double that the worst pole has lost because the gain is rounded to doubles.
    pub fn digits_lost(&self) -> f64 {
        libm::log10((self.error / f64::EPSILON).max(1.0))
    }
}

/// Relative error above which a pole counts as not placed.
const HOPELESS: f64 = 1e-2;

/// Finds the gain L such that A − L C has the wanted eigenvalues.
///
/// For continuous time pass A and poles in 1/s, for discrete time the transition matrix and poles within the unit
/// circle. With one output the gain is unique. With several, the remaining freedom is used to make the
/// poles insensitive: every eigenvector is turned, within what the outputs allow, as far as possible from the
/// others (Kautsky, Nichols & Van Dooren, "Robust pole assignment in linear state feedback", Int. J. Control 41
/// (1985), method 0, extended to complex pairs). Poles may coincide with those of A, and with each other; a pole
/// wanted more often than there are independent outputs is necessarily a sensitive one.
///
/// # Errors
/// [`Error::Unobservable`] with the mode that no output sees, [`Error::NotConjugate`], [`Error::NotFinite`],
/// [`Error::NotConverged`], and [`Error::IllConditioned`] if rounding the gain to doubles moves a pole by
/// more than a hundredth of its magnitude.
pub fn place<const N: usize, const P: usize>(
    a: &SMatrix<f64, N, N>,
    c: &SMatrix<f64, P, N>,
    poles: &[Complex<f64>; N],
) -> Result<Placement<N, P>, Error> {
    let (arranged, origin) = arrange(poles)?;
    let (pair, merging) = Pair::new(a, c)?;
    let visibility = match least_visible(&pair)? {
        (_, Some(hidden)) => return Err(Error::Unobservable(hidden)),
        (visibility, None) => visibility,
    };
    let problem = Problem { a, c, pair: &pair, merging: &merging, poles: &arranged };
    let checked = if pair.rank == 1 {
        problem.rounded(
            &single::place(&pair.dynamics, &pair.outputs, &arranged).ok_or(Error::NotConverged)?,
        )?
    } else if multiplicity(&arranged) <= pair.rank
        && let Some(gain) = several::place(&pair, &arranged)
    {
        problem.rounded(&gain)?
    } else {
        problem.through_one_output()?
    };
    if checked.loss.total_cmp(&HOPELESS).is_gt() {
        return Err(Error::IllConditioned(checked.loss));
    }
    let mut in_order = [PlacedPole { re: 0.0, im: 0.0 }; N];
    for (pole, &place) in checked.placed.iter().zip(&origin) {
        if let Some(place) = in_order.get_mut(place) {
            *place = PlacedPole { re: pole.re, im: pole.im };
        }
    }
    Ok(Placement { gain: checked.gain, poles: in_order, error: checked.error, visibility })
}

impl<const N: usize, const P: usize> Problem<'_, N, P> {
    /// Rounds a gain of the balanced pair and improves the rounding. Where more poles coincide than there
    /// are outputs, they have no derivative, and the nearest gain is kept.
    fn rounded(&self, gain: &Square<Extended, N>) -> Result<Checked<N, P>, Error> {
        let nearest = self.check(&round(&self.pair.gain(gain, self.merging)))?;
        if multiplicity(self.poles) > self.pair.rank {
            return Ok(nearest);
        }
        let polished = polish::polish(self, &nearest).and_then(|gain| self.check(&gain).ok());
        Ok(polished.filter(|polished| polished.error < nearest.error).unwrap_or(nearest))
    }

    /// Places poles that are wanted more often than there are outputs: a first gain makes all modes visible in one
    /// combination of the outputs (Heymann 1968), through which they are then placed.
    fn through_one_output(&self) -> Result<Checked<N, P>, Error> {
        let mut best: Option<Checked<N, P>> = None;
        for attempt in 0..ATTEMPTS {
            let Some(gain) = single::through_a_mixture(self.pair, self.poles, attempt) else {
                continue;
            };
            let Ok(checked) = self.rounded(&gain) else { continue };
            if best.as_ref().is_none_or(|best| checked.error < best.error) {
                best = Some(checked);
            }
        }
        best.ok_or(Error::NotConverged)
    }
}

/// Number of mixtures of outputs that are tried.
const ATTEMPTS: u32 = 12;
