use crate::Config;
use crate::link::Link;
use crate::pace::Pace;
use kestirim_health::Reason;
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{
    ExpectedRange, dilution_of_precision, expected_range, position_error, weighted_dilution,
};
use nalgebra::SVector;

/// State of a tracker's position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum State {
    /// No position has been found yet.
    Initialising,
    /// Ranges come in and fit.
    Tracking,
    /// No range came for a second, or two rounds of the anchors where those take longer: the position is extrapolated.
    Coasting,
    /// The position has become worthless: the next ranges make a new one.
    Lost,
}

/// Health of a tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Health<T> {
    /// State of the position.
    pub state: State,
    /// Mean NIS of the last twenty ranges or so that were taken in: 1 when the model is right.
    pub nis: T,
    /// Ranges taken in so far.
    pub taken: u32,
    /// Ranges left out so far.
    pub rejected: u32,
    /// Positions begun anew after the first.
    pub restarts: u16,
    /// Anchors heard within the last second, or two rounds of the anchors where those take longer, but for those that have
    /// long measured too long.
    pub heard: u8,
    /// Dilution of precision of those anchors; none if they do not determine a position.
    pub dilution: Option<T>,
    /// How far [`Tracker::mirror_image`](crate::Tracker::mirror_image) is, the other place that the ranges allow, m; none if they
    /// allow one only, or of a tracker that does not look for it, as that on wheels.
    pub mirror: Option<T>,
    /// Standard deviation of the position, root of its variances' sum, m: the filter's own, that of the anchors'
    /// constant errors, and that of being at the other place as likely as here; none without a position.
    pub position_sigma: Option<T>,
    /// That of constant errors alone, m: what [`Config::bias_sigma`](crate::Config::bias_sigma), more where the tag stands, and what
    /// was learnt beyond [`Config::range_sigma`](crate::Config::range_sigma) makes of the position through the anchors heard, and so does the common bias where these are too few to tell it; where
    /// they do not determine a position, through all that ever were.
    pub bias_sigma: T,
    /// Whether lately more than a third of the ranges were left out, but for those of blocked anchors.
    pub distrusted: bool,
    /// Whether the tag stands still, as far as IMU or wheels tell.
    pub still: bool,
}

impl<T: Copy> Health<T> {
    /// The same in the words of all systems. That no position has been found yet is no fault.
    pub fn in_short(&self) -> kestirim_health::Health {
        let is_blind = self.state == State::Tracking && self.dilution.is_none();
        kestirim_health::Health::GOOD
            .with(Reason::Dropout, self.state == State::Coasting)
            .with(Reason::Rejected, self.distrusted)
            .with(
                Reason::NotObservable,
                self.state == State::Lost || is_blind || self.mirror.is_some(),
            )
    }
}

/// Mean NIS of ranges up to which they agree.
const NIS_OF_AGREEMENT: f64 = 4.0;

/// Speed at which what is around a tag changes within the second or so that a position is averaged over, m/s.
const CHANGING_SPEED: f64 = 0.1;

/// Least weight of a link's constant error beside the best link's.
const LEAST_WEIGHT: f64 = 1e-3;

/// Root mean square error of one of two equally likely places, as a share of their distance.
const SQRT_HALF: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// Counters of a tracker.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Counters<T> {
    pub(crate) nis: T,
    pub(crate) taken: u32,
    pub(crate) rejected: u32,
    /// Two for each that was rejected lately, less one for each that was taken in.
    pub(crate) distrust: u16,
    pub(crate) starts: u16,
}

impl<T: Scalar> Counters<T> {
    pub(crate) fn new() -> Self {
        Self { nis: T::ONE, taken: 0, rejected: 0, distrust: 0, starts: 0 }
    }

    #[inline(always)]
    pub(crate) fn take(&mut self, nis: T) {
        self.nis += (nis - self.nis) * T::from_f64(0.05);
        self.taken = self.taken.wrapping_add(1);
        self.distrust = self.distrust.saturating_sub(1);
    }

    /// Whether at least one anchor more than the `coordinates` agree beside this one (that counts among those `heard` unless it
    /// is blocked).
    #[inline]
    pub(crate) fn others_agree(&self, is_blocked: bool, heard: u8, coordinates: usize) -> bool {
        let others = usize::from(heard).saturating_sub(usize::from(!is_blocked));
        self.nis < T::from_f64(NIS_OF_AGREEMENT) && others > coordinates
    }

    /// Counts a range that was left out; whether half of them are lately, of so many anchors `heard`: then the position
    /// is to be given up. That an anchor is blocked is known, and no reason.
    #[inline]
    pub(crate) fn reject(&mut self, heard: u8, is_blocked: bool) -> bool {
        self.rejected = self.rejected.wrapping_add(1);
        if is_blocked {
            return false;
        }
        self.distrust = self.distrust.saturating_add(2);
        self.distrust > 2 * u16::from(heard)
    }

    /// A position was begun.
    pub(crate) fn begun(&mut self) {
        self.starts = self.starts.saturating_add(1);
        (self.distrust, self.nis) = (0, T::ONE);
    }
}

/// Anchors that were heard lately and of which nothing is in the way, with their numbers.
#[inline]
pub(crate) fn heard_lately<'a, T: Scalar>(
    links: &'a [Link<T>],
    pace: &Pace,
    time_us: u64,
) -> impl Iterator<Item = (usize, &'a Link<T>)> + Clone {
    let fresh_us = pace.fresh_us();
    let is_heard =
        move |link: &Link<T>| !link.is_blocked && link.fresh(time_us, fresh_us).is_some();
    links.iter().enumerate().filter(move |(_, link)| is_heard(link))
}

/// How many they are.
#[inline]
pub(crate) fn count_heard<T: Scalar>(links: &[Link<T>], pace: &Pace, time_us: u64) -> u8 {
    heard_lately(links, pace, time_us).count() as u8
}

/// What health needs to know of an estimate.
pub(crate) struct Place<T, const D: usize> {
    /// Position, m.
    pub(crate) position: SVector<T, D>,
    /// Sum of its coordinates' variances, m².
    pub(crate) variance: T,
    /// Square of the speed, m²/s².
    pub(crate) speed_squared: T,
    /// How far from it the other place is that the ranges allow, if there is one, m.
    pub(crate) mirror: Option<T>,
    /// What all ranges may be too long by beyond what the covariance knows of.
    pub(crate) common: Common<T>,
}

/// A common bias that is considered, and not learnt.
#[derive(Clone, Copy)]
pub(crate) struct Common<T> {
    /// Its standard deviation, m.
    pub(crate) sigma: T,
    /// How it depends on the distance: a constant, and a slope, 1/m.
    pub(crate) shape: [T; 2],
}

impl<T: Scalar> Common<T> {
    /// None is considered: there is none, or it is a state that every range tells.
    pub(crate) const NONE: Self = Self { sigma: T::ZERO, shape: [T::ZERO; 2] };
}

/// Health of a tracker that has this place.
pub(crate) fn health<T: Scalar, const D: usize>(
    (counters, config): (&Counters<T>, &Config<T>),
    (links, pace): (&[Link<T>], &Pace),
    place: Option<Place<T, D>>,
    time_us: u64,
    still: bool,
) -> Health<T> {
    let fresh = heard_lately(links, pace, time_us).map(|(_, link)| link);
    let heard = fresh.clone().count() as u8;
    let dilution = place.as_ref().and_then(|place| {
        let direction = |link: &Link<T>| expected(place, config, link).direction;
        dilution_of_precision(fresh.clone().map(direction)).ok()
    });
    let bias_sigma = place.as_ref().map_or(T::ZERO, |place| {
        // Where they are too few, the position keeps what all have made of it.
        let all = || bias_sigma(place, config, links.iter().filter(|link| link.is_heard()));
        let found = bias_sigma(place, config, fresh.clone()).or_else(all);
        let own = found.or(dilution.map(|dilution| dilution * config.bias_sigma));
        let all = || common_sigma(place, config, links.iter().filter(|link| link.is_heard()));
        let common = common_sigma(place, config, fresh).or_else(all);
        own.unwrap_or(T::ZERO).hypot(common.unwrap_or(T::ZERO))
    });
    Health {
        state: match (&place, counters.starts) {
            (None, 0) => State::Initialising,
            (None, _) => State::Lost,
            (Some(_), _) if heard == 0 => State::Coasting,
            (Some(_), _) => State::Tracking,
        },
        nis: counters.nis,
        taken: counters.taken,
        rejected: counters.rejected,
        restarts: counters.starts.saturating_sub(1),
        heard,
        dilution,
        mirror: place.as_ref().and_then(|place| place.mirror),
        position_sigma: place.map(|place| {
            let either = place.mirror.unwrap_or(T::ZERO) * T::from_f64(SQRT_HALF);
            place.variance.sqrt().hypot(bias_sigma).hypot(either)
        }),
        bias_sigma,
        distrusted: counters.distrust > u16::from(heard.max(1)),
        still,
    }
}

/// The range to an anchor.
fn expected<T: Scalar, const D: usize>(
    place: &Place<T, D>,
    config: &Config<T>,
    link: &Link<T>,
) -> ExpectedRange<T, D> {
    expected_range(&place.position, config.height, &link.anchor.position)
}

/// What the constant errors of these anchors' ranges make of the position, m; none if they do not determine it.
///
/// Each anchor keeps [`Config::bias_sigma`]. Where a tag stands, so does what is around it and between it and an anchor: what
/// this adds is constant then, about as much again (an office's links beside its anchors' biases), and what has been learnt
/// of an anchor's ranges beyond their noise is no noise; ranges of which nothing has been learnt yet count as poor. On the way
/// all this changes, and averages, but for what was learnt beyond [`Config::range_sigma`]: what stands in the way, and how a tag moves
/// otherwise than it is supposed to, makes errors that stay for many ranges.
fn bias_sigma<'a, T: Scalar, const D: usize>(
    place: &Place<T, D>,
    config: &Config<T>,
    links: impl Iterator<Item = &'a Link<T>> + Clone,
) -> Option<T> {
    let own = config.bias_sigma * config.bias_sigma;
    if own == T::ZERO {
        return Some(T::ZERO);
    }
    let slow = T::from_f64(CHANGING_SPEED * CHANGING_SPEED);
    let stands = slow / (slow + place.speed_squared);
    let least = config.learning.map_or(T::MAX, |learning| learning.limited(T::ZERO));
    let usual = least.max(config.range_sigma * config.range_sigma);
    let variance = |link: &Link<T>| {
        let learnt = (link.noise.variance() - least).max(T::ZERO);
        let unusual = (link.noise.variance() - usual).max(T::ZERO);
        own + (stands * (own + learnt)).max(unusual)
    };
    // Beside the best link, so that fixed point has room; less than a thousandth of its weight would look as if it did not
    // determine what a poor link alone tells.
    let best = links.clone().map(variance).fold(T::MAX, T::min);
    let weighted = links.map(|link| {
        let weight = (best / variance(link)).max(T::from_f64(LEAST_WEIGHT));
        (expected(place, config, link).direction, weight)
    });
    Some(weighted_dilution(weighted).ok()? * best.sqrt())
}

/// What the common bias that is considered makes of the position through the ranges of these anchors, which the filter weighs by
/// what it has learnt of their noise, m; none if they do not determine it.
///
/// What of the bias no position explains would be in their residuals, which are no larger than that noise: the more there would
/// be, the smaller it must be.
fn common_sigma<'a, T: Scalar, const D: usize>(
    place: &Place<T, D>,
    config: &Config<T>,
    links: impl Iterator<Item = &'a Link<T>> + Clone,
) -> Option<T> {
    let Common { sigma, shape: [constant, slope] } = place.common;
    if sigma == T::ZERO || config.bias_sigma == T::ZERO {
        return Some(T::ZERO);
    }
    let variance = |link: &Link<T>| link.noise.variance();
    let best = links.clone().map(variance).fold(T::MAX, T::min);
    let farthest = links.clone().map(|link| expected(place, config, link).distance);
    let farthest = farthest.fold(T::ZERO, T::max);
    let ranges = links.map(|link| {
        let range = expected(place, config, link);
        let weight = (best / variance(link)).max(T::from_f64(LEAST_WEIGHT));
        (range.direction, weight, constant + slope * range.distance)
    });
    let moved = position_error(ranges.clone()).ok()?;
    let unexplained = ranges.fold(T::ZERO, |sum, (direction, weight, error)| {
        let pairs = direction.iter().zip(&moved);
        let residual = pairs.fold(error, |left, (&along, &way)| left - along * way);
        sum + weight * residual * residual
    });
    let left = sigma * (best / (best + unexplained * sigma * sigma)).sqrt();
    // Near the anchors' line a range grows with the square of the way from it.
    let bent = (T::TWO * farthest * left).sqrt();
    Some((T::norm(&moved) * left).min(bent))
}

#[cfg(test)]
mod tests;
