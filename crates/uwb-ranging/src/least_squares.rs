use crate::symmetric::{MOST, NormalEquations};
use crate::{Error, Room, expected_range};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// A range from a place that is known.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Observation<T: Scalar> {
    /// The anchor's place in the room, m.
    pub anchor: SVector<T, 3>,
    /// The measured distance, m.
    pub range: T,
    /// Variance of the range, m².
    pub variance: T,
}

/// From how many standard deviations on a residual counts less (Huber 1964), for each sign.
///
/// An obstacle can only lengthen a range: what is too long is doubted sooner than what is too short.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Huber<T> {
    /// Threshold of residuals that say "too long".
    pub long: T,
    /// Threshold of residuals that say "too short".
    pub short: T,
}

impl<T: Scalar> Huber<T> {
    /// The threshold of a residual of this sign.
    #[inline]
    pub fn threshold(&self, residual: T) -> T {
        if residual > T::ZERO { self.long } else { self.short }
    }
}

/// A position from ranges taken at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Fix<T: Scalar, const D: usize> {
    /// Position of the tag, m, in the frame of the anchors.
    pub position: SVector<T, D>,
    /// Covariance of the position, m².
    pub covariance: SMatrix<T, D, D>,
    /// Bias common to all ranges, m; 0 unless it was asked for.
    pub common_bias: T,
    /// Variance of the common bias, m².
    pub common_bias_variance: T,
    /// The weighted squares (Huber's beyond his threshold) that are left: as many as there are ranges
    /// beyond the unknowns, on average.
    pub cost: T,
    /// Whether another place explains the ranges nearly as well: three anchors, or nearly a line.
    pub ambiguous: bool,
}

/// Weighted nonlinear least squares over ranges: Gauss and Newton's steps from several starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solver<T> {
    /// The tag's height in two dimensions, m.
    pub height: T,
    /// Bounds of the position.
    pub room: Option<Room<T>>,
    /// The standard deviation that a bias common to all ranges may have, m: it is estimated if there are
    /// ranges enough.
    pub common_bias: Option<T>,
    /// Thresholds of the robust weights, if any.
    pub huber: Option<Huber<T>>,
}

/// Starts: the anchors' centre, and a place on either side of it along each axis.
const STARTS: usize = 7;

impl<T: Scalar> Solver<T> {
    const MOST_STEPS: u16 = 30;
    /// A step of no more than this ends the search, m.
    const SETTLED: f64 = 1e-3;
    /// Two starts that come so close to each other lead to the same place, m.
    const SAME: f64 = 0.05;
    /// Steps in which every range counts, so that Huber's weights begin near the answer.
    const PLAIN_STEPS: u16 = 3;

    /// A plain solver for a tag at `height`.
    pub const fn new(height: T) -> Self {
        Self { height, room: None, common_bias: None, huber: None }
    }

    /// The position that fits best, of those in the room if there is one.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`], [`Error::NotFinite`] or [`Error::NotPositive`] for what was given;
    /// [`Error::DegenerateGeometry`] or [`Error::NotConverged`] if no start leads anywhere.
    pub fn solve<const D: usize>(
        &self,
        observations: &[Observation<T>],
        start: Option<SVector<T, D>>,
    ) -> Result<Fix<T, D>, Error> {
        let scale = least_variance::<T, D>(observations)?;
        let mut best: Option<(bool, Fix<T, D>)> = None;
        let mut failure = Error::NotConverged;
        for start in starts(observations, start) {
            if best.is_some_and(|best| good_enough(&best, observations.len())) {
                break;
            }
            let known = best.map(|(_, fix)| fix.position);
            match self.descend(observations, &start, scale, known) {
                Ok(Some(fix)) => best = Some(self.better(best, fix)),
                Ok(None) => {}
                Err(error) => failure = error,
            }
        }
        best.map(|(_, fix)| fix).ok_or(failure)
    }

    /// The better of two fixes: one in the room, and else the one of smaller cost.
    fn better<const D: usize>(
        &self,
        best: Option<(bool, Fix<T, D>)>,
        mut fix: Fix<T, D>,
    ) -> (bool, Fix<T, D>) {
        let margin = T::HALF;
        let inside = self.room.is_none_or(|room| room.contains(&fix.position, margin));
        let Some((best_inside, mut best)) = best else { return (inside, fix) };
        if inside != best_inside {
            return if inside { (true, fix) } else { (best_inside, best) };
        }
        let apart = T::norm((fix.position - best.position).as_array()) > T::HALF;
        // Four is two standard deviations.
        let alike = (fix.cost - best.cost).abs() < T::TWO + T::TWO;
        let ambiguous = fix.ambiguous || best.ambiguous || (apart && alike);
        if fix.cost < best.cost {
            fix.ambiguous = ambiguous;
            return (inside, fix);
        }
        best.ambiguous = ambiguous;
        (best_inside, best)
    }

    /// Minimum that the steps from one start reach; `None` if it is known already.
    pub(crate) fn descend<const D: usize>(
        &self,
        observations: &[Observation<T>],
        start: &SVector<T, D>,
        scale: T,
        known: Option<SVector<T, D>>,
    ) -> Result<Option<Fix<T, D>>, Error> {
        let bias_prior = self.common_bias.filter(|_| observations.len() > D + 1);
        let unknowns = if bias_prior.is_some() { D + 1 } else { D };
        let mut position = *start;
        let mut bias = T::ZERO;
        for step in 0..Self::MOST_STEPS {
            let robust = self.huber.filter(|_| step >= Self::PLAIN_STEPS);
            let mut equations = NormalEquations::new(unknowns);
            let mut cost = T::ZERO;
            for observation in observations {
                let expected = expected_range(&position, self.height, &observation.anchor);
                let mut row = [T::ZERO; MOST];
                row[..D].copy_from_slice(&expected.direction);
                if let (Some(_), Some(entry)) = (bias_prior, row.get_mut(D)) {
                    *entry = T::ONE;
                }
                let residual = observation.range - expected.distance - bias;
                let (weight, square) = weighed(residual, observation.variance, scale, robust);
                cost += square;
                equations.add(&row, residual, weight);
            }
            if let Some(sigma) = bias_prior {
                let mut row = [T::ZERO; MOST];
                if let Some(entry) = row.get_mut(D) {
                    *entry = T::ONE;
                }
                equations.add(&row, -bias, scale / (sigma * sigma));
                cost += (bias / sigma) * (bias / sigma);
            }
            let factors =
                equations.factorised(T::from_f64(1e-4)).ok_or(Error::DegenerateGeometry)?;
            let moved = limited(factors.solve(&equations.b));
            for axis in 0..D {
                position.as_array_mut()[axis] += moved[axis];
            }
            bias += moved.get(D).copied().unwrap_or(T::ZERO);
            if !position.iter().all(|coordinate| coordinate.is_finite()) {
                return Err(Error::NotConverged);
            }
            if step <= Self::PLAIN_STEPS {
                continue;
            }
            if let Some(known) = known
                && T::norm((position - known).as_array()) < T::from_f64(Self::SAME)
            {
                return Ok(None);
            }
            let settled = moved.iter().all(|&moved| moved.abs() <= T::from_f64(Self::SETTLED));
            if settled {
                let inverse = factors.inverse();
                return Ok(Some(Fix {
                    position,
                    covariance: SMatrix::from_fn(|i, j| inverse[i][j] * scale),
                    common_bias: bias,
                    common_bias_variance: inverse
                        .get(D)
                        .map_or(T::ZERO, |row| row[D.min(3)] * scale),
                    cost,
                    ambiguous: false,
                }));
            }
        }
        Err(Error::NotConverged)
    }
}

/// Whether no other start can do better: the ranges agree to their noise, and there are enough of them
/// that a mirror image could not.
fn good_enough<T: Scalar, const D: usize>(
    (inside, fix): &(bool, Fix<T, D>),
    observations: usize,
) -> bool {
    let most = T::from_micro(observations.min(2000) as i32 * 1_000_000);
    *inside && observations > D + 1 && fix.cost <= most
}

/// The smallest variance, to which all weights are relative.
fn least_variance<T: Scalar, const D: usize>(observations: &[Observation<T>]) -> Result<T, Error> {
    if observations.len() <= D {
        return Err(Error::TooFewRanges);
    }
    let mut least = T::MAX;
    for observation in observations {
        let numbers = observation.anchor.iter().chain([&observation.range]);
        if !(numbers.copied().all(T::is_finite) && observation.variance.is_finite()) {
            return Err(Error::NotFinite);
        }
        if observation.variance <= T::ZERO {
            return Err(Error::NotPositive);
        }
        least = least.min(observation.variance);
    }
    Ok(least)
}

/// The weight of a residual, relative to that of variance `scale`, and what it costs.
fn weighed<T: Scalar>(residual: T, variance: T, scale: T, huber: Option<Huber<T>>) -> (T, T) {
    let weight = scale / variance;
    let deviations = residual.abs() / variance.sqrt();
    match huber.map(|huber| huber.threshold(residual)) {
        Some(threshold) if deviations > threshold => {
            let cost = threshold * (T::TWO * deviations - threshold);
            (weight * threshold / deviations, cost)
        }
        _ => (weight, deviations * deviations),
    }
}

/// A step of no more than 2 m: far from the answer the distances are not linear.
fn limited<T: Scalar>(step: [T; MOST]) -> [T; MOST] {
    let length = T::norm(&step);
    if length <= T::TWO {
        return step;
    }
    let divisor = length.divisor();
    step.map(|component| T::TWO * component.divided_by(divisor))
}

/// Starting points: the given place, the anchors' centre, and places around it.
fn starts<T: Scalar, const D: usize>(
    observations: &[Observation<T>],
    given: Option<SVector<T, D>>,
) -> impl Iterator<Item = SVector<T, D>> {
    let share = T::from_micro(observations.len().min(2000) as i32 * 1_000_000).recip();
    let mut centre = SVector::<T, D>::zeros();
    for observation in observations {
        for axis in 0..D {
            centre.as_array_mut()[axis] += observation.anchor.as_array()[axis] * share;
        }
    }
    let mut extent = T::ZERO;
    for observation in observations {
        let offset: [T; D] = core::array::from_fn(|axis| {
            observation.anchor.as_array()[axis] - centre.as_array()[axis]
        });
        extent = extent.max(T::norm(&offset));
    }
    let reach = extent * T::from_f64(0.7);
    let around = (0..STARTS.min(2 * D + 1)).map(move |index| {
        let mut start = centre;
        if let Some(axis) = index.checked_sub(1) {
            let side = if axis % 2 == 0 { reach } else { -reach };
            if let Some(coordinate) = start.as_array_mut().get_mut(axis / 2) {
                *coordinate += side;
            }
        }
        start
    });
    given.into_iter().chain(around)
}
