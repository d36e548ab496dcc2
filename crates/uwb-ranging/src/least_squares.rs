use crate::common_bias::CommonBias;
use crate::symmetric::NormalEquations;
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
        let prior = self.common_bias.filter(|_| observations.len() > D + 1);
        let sigma = scale.sqrt();
        let noise = Noise { variance: scale, per_sigma: sigma.recip() };
        let mut position = *start;
        let mut bias = T::ZERO;
        for step in 0..Self::MOST_STEPS {
            let robust = self.huber.filter(|_| step >= Self::PLAIN_STEPS);
            let mut equations = NormalEquations::<T, D>::new();
            let mut common = CommonBias::new();
            let mut cost = T::ZERO;
            for observation in observations {
                let expected = expected_range(&position, self.height, &observation.anchor);
                let residual = observation.range - expected.distance - bias;
                let (weight, square) = noise.weighed(residual, observation.variance, robust);
                cost += square;
                equations.add(&expected.direction, residual, weight);
                if prior.is_some() {
                    common.add(&expected.direction, residual, weight);
                }
            }
            let least = equations.least_pivot();
            if let Some(bias_sigma) = prior {
                let ratio = sigma / bias_sigma;
                common.add(&[T::ZERO; D], -bias, ratio * ratio);
                cost += (bias / bias_sigma) * (bias / bias_sigma);
                common.eliminate_from(&mut equations);
            }
            let factors = equations.factorised_above(least).ok_or(Error::DegenerateGeometry)?;
            let moved = factors.solve(&equations.b);
            let moved_bias = if prior.is_some() { common.solve(&moved) } else { T::ZERO };
            let (moved, moved_bias) = limited(moved, moved_bias);
            for axis in 0..D {
                position.as_array_mut()[axis] += moved[axis];
            }
            bias += moved_bias;
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
            let settled = moved
                .iter()
                .chain([&moved_bias])
                .all(|&moved| moved.abs() <= T::from_f64(Self::SETTLED));
            if settled {
                let inverse = factors.inverse();
                let common_bias_variance =
                    if prior.is_some() { common.variance(&factors) * scale } else { T::ZERO };
                return Ok(Some(Fix {
                    position,
                    covariance: SMatrix::from_fn(|i, j| inverse[i][j] * scale),
                    common_bias: bias,
                    common_bias_variance,
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

/// The noise of the best range, to which all weights are relative.
struct Noise<T> {
    variance: T,
    per_sigma: T,
}

impl<T: Scalar> Noise<T> {
    /// The weight of a residual of this variance and what it costs. Roots and divisions only where they
    /// change something: a processor without a floating-point unit is in here most of a start.
    fn weighed(&self, residual: T, variance: T, huber: Option<Huber<T>>) -> (T, T) {
        let alike = variance == self.variance;
        let weight = if alike { T::ONE } else { self.variance / variance };
        let mut deviations = residual.abs() * self.per_sigma;
        let square = deviations * deviations * weight;
        match huber.map(|huber| huber.threshold(residual)) {
            Some(threshold) if square > threshold * threshold => {
                if !alike {
                    deviations *= weight.sqrt();
                }
                let cost = threshold * (T::TWO * deviations - threshold);
                (weight * threshold / deviations, cost)
            }
            _ => (weight, square),
        }
    }
}

/// A step of no more than 2 m: far from the answer the distances are not linear.
fn limited<T: Scalar, const D: usize>(step: [T; D], bias: T) -> ([T; D], T) {
    let mut length = T::norm(&step);
    if bias != T::ZERO {
        length = T::norm(&[length, bias]);
    }
    if length <= T::TWO {
        return (step, bias);
    }
    let divisor = length.divisor();
    let shortened = |component| T::TWO * T::divided_by(component, divisor);
    (step.map(shortened), shortened(bias))
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
