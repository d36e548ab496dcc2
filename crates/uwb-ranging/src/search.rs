//! A search from several starts that can be spread over several calls.

use crate::descent::{Care, Descent, Noise, Step};
use crate::least_squares::least_variance;
use crate::{Error, Fix, Observation, Solver};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A search for the position that fits ranges best, which can be interrupted after each Gauss-Newton step.
///
/// A processor that has no time for all steps between two samples takes a few with each.
///
/// It uses the same starts as [`Solver::solve`], but only the accuracy that a filter needs to begin: a centimetre,
/// or a few where Huber's weights settle slowly. Starts are only followed to the end if they promise more than the
/// best so far. Consistent ranges in a room take five to eight steps in all, inconsistent ones thirty.
///
/// The caller keeps the ranges, which must be the same from the first step to the last.
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
    /// The iterations from the current start; `None` before the first step from it.
    descent: Option<Descent<T, D>>,
    /// Index of the next start around the anchors' centre.
    next: u8,
    best: Option<Found<T, D>>,
    aim: Aim,
    failure: Error,
}

/// What a search is for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Aim {
    /// A filter's first position: the first good minimum is enough.
    Begin,
    /// The best of all minima.
    Best,
    /// The best of all minima, but the one that the caller's start leads to where others fit alike.
    BestNear,
}

/// Iterations that come within this distance of an earlier minimum are taken to lead there, m.
const SAME: f64 = 0.05;
/// Distance that replaces `SAME` in a search that is not exact, for steps shorter than this, m.
const ROUGHLY_SAME: f64 = 0.5;

/// A minimum, and whether it is inside the room.
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
    /// Number of starts: the centre, and one on either side of it along each axis.
    const STARTS: u8 = 2 * D as u8 + 1;

    /// The state before the first step: from `start` (m) if one is given, and then from starts among the anchors.
    pub fn new(start: Option<SVector<T, D>>) -> Self {
        let descent = start.map(Descent::from);
        Self { descent, next: 0, best: None, aim: Aim::Begin, failure: Error::NotConverged }
    }

    /// A search that follows every start to the end.
    pub(crate) fn exact(start: Option<SVector<T, D>>) -> Self {
        let aim = if start.is_some() { Aim::BestNear } else { Aim::Best };
        Self { aim, ..Self::new(start) }
    }

    /// Whether every start is followed to the end.
    fn is_exact(&self) -> bool {
        self.aim != Aim::Begin
    }

    /// The state before the first step, from this start (m) alone.
    pub fn near(start: SVector<T, D>) -> Self {
        Self { next: Self::STARTS, ..Self::new(Some(start)) }
    }

    /// Takes up to `steps` steps. Returns `None` if more are needed.
    ///
    /// # Errors
    /// Those of [`Solver::solve`]; the search is over.
    pub fn advance(
        &mut self,
        solver: &Solver<T>,
        observations: &[Observation<T>],
        steps: usize,
    ) -> Result<Option<&Fix<T, D>>, Error> {
        let noise = Noise::new(least_variance::<T, D>(observations)?);
        let care = if self.is_exact() { Care::exact() } else { Care::rough() };
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
                Err(error) => {
                    self.failure = error;
                    // Before the first of the other starts it is the caller's that failed.
                    if self.next == 0 {
                        self.prefer_none();
                    }
                }
            }
            self.descent = None;
            let is_good_enough = |best: &Found<T, D>| best.is_good_enough(observations.len());
            let is_enough = !self.is_exact() && self.best.as_ref().is_some_and(is_good_enough);
            if self.next >= Self::STARTS || is_enough {
                return self.best.as_ref().map(|best| Some(&best.fix)).ok_or(self.failure);
            }
        }
        Ok(None)
    }

    /// Whether the current iterations cannot lead to a better minimum than the best so far.
    fn promises_nothing(
        &self,
        solver: &Solver<T>,
        position: &SVector<T, D>,
        cost: T,
        moved: T,
    ) -> bool {
        let Some(best) = &self.best else { return false };
        if self.is_exact() {
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

    /// Keeps the better of two fixes: one inside the room, otherwise the one with the smaller cost.
    #[inline(never)]
    fn settle(&mut self, solver: &Solver<T>, mut fix: Fix<T, D>) {
        // A value on a rail of fixed point could not be stored.
        fix.cost = fix.cost.min(T::MAX - T::EPSILON);
        let inside = is_inside(solver, &fix.position);
        let (is_exact, is_near_start) = (self.is_exact(), self.aim == Aim::BestNear);
        let Some(best) = &mut self.best else {
            self.best = Some(Found { inside, fix });
            return;
        };
        if inside != best.inside {
            if inside {
                *best = Found { inside, fix };
                self.prefer_none();
            }
            return;
        }
        if is_exact && are_near(&fix.position, &best.fix.position, T::from_f64(SAME)) {
            return;
        }
        let apart = !are_near(&fix.position, &best.fix.position, T::HALF);
        // Four is two standard deviations.
        let alike = (fix.cost - best.fix.cost).abs() < T::TWO + T::TWO;
        let ambiguous = fix.ambiguous || best.fix.ambiguous || (apart && alike);
        let is_kept = apart && alike && is_near_start;
        let is_replaced = fix.cost < best.fix.cost && !is_kept;
        if is_replaced {
            best.fix = fix;
        }
        best.fix.ambiguous = ambiguous;
        if is_replaced && apart {
            self.prefer_none();
        }
    }

    /// Prefers no minimum any more: that of the caller's start is not the best, or there is none.
    fn prefer_none(&mut self) {
        if self.aim == Aim::BestNear {
            self.aim = Aim::Best;
        }
    }
}

impl<T: Scalar, const D: usize> Found<T, D> {
    /// Whether another start would hardly do better: the residuals are consistent with the noise, and there are enough
    /// ranges to exclude a mirror image, unless the anchors are nearly collinear.
    fn is_good_enough(&self, observations: usize) -> bool {
        let most = T::from_micro(observations.min(2000) as i32 * 1_000_000);
        self.inside && observations > D + 1 && self.fix.cost <= most
    }
}

/// Whether two positions are closer to each other than `metres`.
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

/// A start: the anchors' centre (index 0), or a point beside it along an axis.
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
