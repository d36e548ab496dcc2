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
    /// Ranges arrive and are consistent.
    Tracking,
    /// No range arrived for a second, or for two rounds of the anchors if those take longer: the position is that after the last
    /// sample, and its standard deviation grows with the time since.
    Coasting,
    /// The position has become useless: the next ranges determine a new one.
    Lost,
}

/// Health of a tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Health<T> {
    /// State of the position.
    pub state: State,
    /// Mean NIS of about the last twenty ranges that were used: 1 if the model is right.
    pub nis: T,
    /// Number of ranges used so far.
    pub taken: u32,
    /// Number of ranges rejected so far.
    pub rejected: u32,
    /// Number of positions begun after the first.
    pub restarts: u16,
    /// Number of anchors heard within the last second, or two rounds of the anchors if those take longer, except
    /// blocked ones, whose ranges have been too long for a while; 255 at most.
    pub heard: u8,
    /// Dilution of precision of the anchors heard; `None` if they do not determine a position.
    pub dilution: Option<T>,
    /// Distance (m) to [`Tracker::mirror_image`](crate::Tracker::mirror_image), the other position that the ranges
    /// allow; `None` if they allow only one.
    pub mirror: Option<T>,
    /// Standard deviation of the position (root of the sum of its variances), m: that of the filter, with the way that the tag may have
    /// gone since the last sample, that of the anchors' constant errors, and that of the mirror image being as likely; `None` without
    /// a position.
    pub position_sigma: Option<T>,
    /// The part of `position_sigma` that is due to constant errors, m.
    ///
    /// It comprises the effect on the position, through the anchors heard, of
    /// [`Config::bias_sigma`](crate::Config::bias_sigma) (more while the tag stands), of noise learnt beyond
    /// [`Config::range_sigma`](crate::Config::range_sigma), and of the common bias where these anchors are too few to
    /// estimate it. Where they do not determine a position, all anchors ever heard are used.
    pub bias_sigma: T,
    /// Whether more than a third of the recent ranges were rejected, not counting those of blocked anchors.
    pub distrusted: bool,
    /// Whether the tag stands still, according to the IMU or the wheels.
    pub still: bool,
}

impl<T: Scalar> Health<T> {
    /// Converts to the system-wide health flags. That no position has been found yet is not a fault.
    pub fn in_short(&self) -> kestirim_health::Health {
        let is_blind = self.state == State::Tracking && self.dilution.is_none();
        kestirim_health::Health::GOOD
            .with(Reason::Dropout, self.state == State::Coasting)
            .with(Reason::Rejected, self.distrusted)
            .with(Reason::Innovations, self.nis > T::from_f64(NIS_OF_AGREEMENT))
            .with(
                Reason::NotObservable,
                self.state == State::Lost || is_blind || self.mirror.is_some(),
            )
    }
}

/// Mean NIS of ranges below which they count as consistent.
const NIS_OF_AGREEMENT: f64 = 4.0;

/// Speed at which a tag's surroundings change within the second or so over which a position is averaged, m/s.
const CHANGING_SPEED: f64 = 0.1;

/// Smallest weight of a link's constant error relative to the best link's.
const LEAST_WEIGHT: f64 = 1e-3;

/// Root mean square error of choosing one of two equally likely positions, relative to their distance.
const SQRT_HALF: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// Counters of a tracker.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Counters<T> {
    pub(crate) nis: T,
    pub(crate) taken: u32,
    pub(crate) rejected: u32,
    /// Increased by two for each recent rejection, decreased by one for each range used.
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

    /// Whether the ranges are consistent and more than `coordinates` other anchors are heard. (This anchor is among
    /// the `heard` ones unless it is blocked.)
    #[inline]
    pub(crate) fn others_agree(&self, is_blocked: bool, heard: u8, coordinates: usize) -> bool {
        let others = usize::from(heard).saturating_sub(usize::from(!is_blocked));
        self.nis < T::from_f64(NIS_OF_AGREEMENT) && others > coordinates
    }

    /// Counts a rejected range. Returns whether the position is to be given up: whether more than a third of the
    /// recent ranges, of this many anchors `heard`, were rejected. Ranges of an anchor known to be blocked do not
    /// count.
    #[inline]
    pub(crate) fn reject(&mut self, heard: u8, is_blocked: bool) -> bool {
        self.rejected = self.rejected.wrapping_add(1);
        if is_blocked {
            return false;
        }
        self.distrust = self.distrust.saturating_add(2);
        self.distrust > 2 * u16::from(heard)
    }

    /// Resets the counters for a new position.
    pub(crate) fn begun(&mut self) {
        self.starts = self.starts.saturating_add(1);
        (self.distrust, self.nis) = (0, T::ONE);
    }
}

/// The anchors heard recently and not blocked, with their indices.
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

/// Number of anchors heard recently and not blocked, 255 at most.
#[inline]
pub(crate) fn count_heard<T: Scalar>(links: &[Link<T>], pace: &Pace, time_us: u64) -> u8 {
    heard_lately(links, pace, time_us).count().min(u8::MAX.into()) as u8
}

/// The properties of an estimate that the health depends on.
pub(crate) struct Place<T, const D: usize> {
    /// Position, m.
    pub(crate) position: SVector<T, D>,
    /// Sum of its coordinates' variances, m².
    pub(crate) variance: T,
    /// Square of the speed, m²/s².
    pub(crate) speed_squared: T,
    /// Distance to the mirror image that the ranges allow, if there is one, m.
    pub(crate) mirror: Option<T>,
    /// Common bias that is not represented in the covariance.
    pub(crate) common: Common<T>,
}

/// A common bias that is considered, but not estimated.
#[derive(Clone, Copy)]
pub(crate) struct Common<T> {
    /// Standard deviation of the bias, m.
    pub(crate) sigma: T,
    /// Dependence of the bias on the distance: a constant, and a slope, 1/m.
    pub(crate) shape: [T; 2],
}

impl<T: Scalar> Common<T> {
    /// No bias is considered: there is none, or it is a state that every range observes.
    pub(crate) const NONE: Self = Self { sigma: T::ZERO, shape: [T::ZERO; 2] };
}

/// The health of a tracker with this estimate.
pub(crate) fn health<T: Scalar, const D: usize>(
    (counters, config): (&Counters<T>, &Config<T>),
    (links, pace): (&[Link<T>], &Pace),
    place: Option<Place<T, D>>,
    time_us: u64,
    still: bool,
) -> Health<T> {
    let fresh = heard_lately(links, pace, time_us).map(|(_, link)| link);
    let heard = count_heard(links, pace, time_us);
    let dilution = place.as_ref().and_then(|place| {
        let direction = |link: &Link<T>| expected(place, config, link).direction;
        dilution_of_precision(fresh.clone().map(direction)).ok()
    });
    let bias_sigma = place.as_ref().map_or(T::ZERO, |place| {
        // If the anchors heard are too few, the position retains the errors of all.
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

/// The expected range to an anchor.
fn expected<T: Scalar, const D: usize>(
    place: &Place<T, D>,
    config: &Config<T>,
    link: &Link<T>,
) -> ExpectedRange<T, D> {
    expected_range(&place.position, config.height, &link.anchor.position)
}

/// The effect of the constant errors of these anchors' ranges on the position, m; `None` if they do not determine it.
///
/// Each anchor contributes [`Config::bias_sigma`]. While a tag stands, its surroundings and the obstacles between it
/// and an anchor do not change either: their contribution is then constant, about as much again (an office's links
/// besides its anchors' biases), and variances learnt beyond the noise are not noise; ranges of which nothing has been
/// learnt yet count as poor. While it moves, all this changes and averages out, except for what was learnt beyond
/// [`Config::range_sigma`]: obstacles, and motion that differs from the model, cause errors that persist for many
/// ranges.
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
    // Relative to the best link, so that fixed point has room. With less than a thousandth of its weight, a poor link
    // would seem not to determine what it alone observes.
    let best = links.clone().map(variance).fold(T::MAX, T::min);
    let weighted = links.map(|link| {
        let weight = (best / variance(link)).max(T::from_f64(LEAST_WEIGHT));
        (expected(place, config, link).direction, weight)
    });
    Some(weighted_dilution(weighted).ok()? * best.sqrt())
}

/// The effect of the considered common bias on the position, through the ranges of these anchors with the weights from
/// the noise that the filter has learnt, m; `None` if they do not determine it.
///
/// The part of the bias that no position explains would appear in the residuals, which are no larger than that noise:
/// the larger this part, the smaller the bias must be.
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
    // Near the line of the anchors, a range grows with the square of the distance from it.
    let bent = (T::TWO * farthest * left).sqrt();
    Some((T::norm(&moved) * left).min(bent))
}

#[cfg(test)]
mod tests;
