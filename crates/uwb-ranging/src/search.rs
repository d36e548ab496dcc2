//! Steps from several starts, as many at a time as there is time for.

use crate::descent::{Care, Descent, Noise, Step};
use crate::least_squares::least_variance;
use crate::{Error, Fix, Observation, Solver};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A search for the position that fits ranges best, which can be interrupted after each of Gauss and Newton's steps: a
/// processor that has no time for all of them between two samples takes a few with each.
///
/// It looks from the same starts as [`Solver::solve`], and no farther than a filter needs to begin: to a centimetre, or a few
/// where Huber's weights settle slowly, and to the end only from starts that promise more than the best so far. Five to eight
/// steps in all for ranges that agree in a room, thirty for those that do not.
///
/// The ranges are kept by whoever takes the steps: they are the same from the first to the last.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Search<T: Scalar, const D: usize> {
    /// That from the last start; none before the first one.
    descent: Option<Descent<T, D>>,
    /// Number of the next start around the anchors' centre.
    next: u8,
    best: Option<Found<T, D>>,
    is_exact: bool,
    failure: Error,
}

/// Two starts that come so close to each other lead to the same place, m, …
const SAME: f64 = 0.05;
/// … or roughly, at the first step that is shorter than this.
const ROUGHLY_SAME: f64 = 0.5;

/// A minimum, and whether it is in the room.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
struct Found<T: Scalar, const D: usize> {
    inside: bool,
    fix: Fix<T, D>,
}

impl<T: Scalar, const D: usize> Search<T, D> {
    /// Starts around the centre, and at it: on either side along each axis.
    const STARTS: u8 = 2 * D as u8 + 1;

    /// Before the first step: from `start` (m) if one is given, and then from starts among the anchors.
    pub fn new(start: Option<SVector<T, D>>) -> Self {
        let descent = start.map(Descent::from);
        Self { descent, next: 0, best: None, is_exact: false, failure: Error::NotConverged }
    }

    /// The same to the end from every start.
    pub(crate) fn exact(start: Option<SVector<T, D>>) -> Self {
        Self { is_exact: true, ..Self::new(start) }
    }

    /// Before the first step from this place (m) alone.
    pub fn near(start: SVector<T, D>) -> Self {
        Self { next: Self::STARTS, ..Self::new(Some(start)) }
    }

    /// Takes no more than so many steps. None if there are more to take.
    ///
    /// # Errors
    /// As [`Solver::solve`]; the search is over.
    pub fn advance(
        &mut self,
        solver: &Solver<T>,
        observations: &[Observation<T>],
        steps: usize,
    ) -> Result<Option<&Fix<T, D>>, Error> {
        let noise = Noise::new(least_variance::<T, D>(observations)?);
        let care = if self.is_exact { Care::exact() } else { Care::rough() };
        for _ in 0..steps {
            let next = &mut self.next;
            let descent = self.descent.get_or_insert_with(|| {
                let start = start_among(observations, *next);
                *next = next.saturating_add(1);
                Descent::from(start)
            });
            match descent.step(solver, observations, &noise, &care) {
                Ok(Step::First) => continue,
                Ok(Step::Next { cost, moved }) => {
                    let here = *descent.position();
                    if !self.promises_nothing(solver, &here, cost, moved) {
                        continue;
                    }
                }
                Ok(Step::Settled(fix)) => self.settle(solver, fix),
                Err(error) => self.failure = error,
            }
            self.descent = None;
            let is_good_enough = |best: &Found<T, D>| best.is_good_enough(observations.len());
            if self.next >= Self::STARTS || self.best.as_ref().is_some_and(is_good_enough) {
                return self.best.as_ref().map(|best| Some(&best.fix)).ok_or(self.failure);
            }
        }
        Ok(None)
    }

    /// Whether a way leads nowhere that is better than the best so far.
    fn promises_nothing(
        &self,
        solver: &Solver<T>,
        position: &SVector<T, D>,
        cost: T,
        moved: T,
    ) -> bool {
        let Some(best) = &self.best else { return false };
        if self.is_exact {
            return are_near(position, &best.fix.position, T::from_f64(SAME));
        }
        let near = T::from_f64(ROUGHLY_SAME);
        let is_worse = match (best.inside, is_inside(solver, position)) {
            (true, false) => true,
            (false, true) => false,
            // Four is two standard deviations.
            _ => cost > best.fix.cost + T::TWO + T::TWO,
        };
        let is_near = are_near(position, &best.fix.position, near);
        moved < near && (is_near || is_worse)
    }

    /// Keeps the better of two fixes: one in the room, and else the one of smaller cost.
    #[inline(never)]
    fn settle(&mut self, solver: &Solver<T>, mut fix: Fix<T, D>) {
        // On a rail of fixed point it could not be stored.
        fix.cost = fix.cost.min(T::MAX - T::EPSILON);
        let inside = is_inside(solver, &fix.position);
        let Some(best) = &mut self.best else {
            self.best = Some(Found { inside, fix });
            return;
        };
        if inside != best.inside {
            if inside {
                *best = Found { inside, fix };
            }
            return;
        }
        if self.is_exact && are_near(&fix.position, &best.fix.position, T::from_f64(SAME)) {
            return;
        }
        let apart = !are_near(&fix.position, &best.fix.position, T::HALF);
        // Four is two standard deviations.
        let alike = (fix.cost - best.fix.cost).abs() < T::TWO + T::TWO;
        let ambiguous = fix.ambiguous || best.fix.ambiguous || (apart && alike);
        if fix.cost < best.fix.cost {
            best.fix = fix;
        }
        best.fix.ambiguous = ambiguous;
    }
}

impl<T: Scalar, const D: usize> Found<T, D> {
    /// Whether no other start can do better: the ranges agree to their noise, and there are enough of them
    /// that a mirror image could not.
    fn is_good_enough(&self, observations: usize) -> bool {
        let most = T::from_micro(observations.min(2000) as i32 * 1_000_000);
        self.inside && observations > D + 1 && self.fix.cost <= most
    }
}

/// Whether two places are no farther apart, m.
fn are_near<T: Scalar, const D: usize>(a: &SVector<T, D>, b: &SVector<T, D>, metres: T) -> bool {
    let mut squares = T::ZERO;
    for axis in 0..D {
        let apart = a.as_array()[axis] - b.as_array()[axis];
        squares += apart * apart;
    }
    squares < metres * metres
}

fn is_inside<T: Scalar, const D: usize>(solver: &Solver<T>, position: &SVector<T, D>) -> bool {
    let margin = T::HALF;
    solver.room.is_none_or(|room| room.contains(position, margin))
}

/// A start: the anchors' centre, or a place on a side of it.
#[inline(never)]
fn start_among<T: Scalar, const D: usize>(
    observations: &[Observation<T>],
    index: u8,
) -> SVector<T, D> {
    let share = T::from_micro(observations.len().min(2000) as i32 * 1_000_000).recip();
    let mut centre = SVector::<T, D>::zeros();
    for observation in observations {
        for axis in 0..D {
            centre.as_array_mut()[axis] += observation.anchor.as_array()[axis] * share;
        }
    }
    let Some(side) = index.checked_sub(1) else { return centre };
    let mut extent = T::ZERO;
    for observation in observations {
        let offset: [T; D] = core::array::from_fn(|axis| {
            observation.anchor.as_array()[axis] - centre.as_array()[axis]
        });
        extent = extent.max(T::norm(&offset));
    }
    let reach = extent * T::from_f64(0.7);
    if let Some(coordinate) = centre.as_array_mut().get_mut(usize::from(side / 2)) {
        *coordinate += if side % 2 == 0 { reach } else { -reach };
    }
    centre
}
