//! The height of a tag that moves in a plane, from its ranges.

use crate::pace::Pace;
use crate::{Anchor, Error, RangeSample};
use heapless::Vec;
use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::{Error as NoPlace, Height, HeightSearch, Quartiles};
use nalgebra::SVector;

/// Finds the constant height of a tag, from single ranges as they arrive, for up to A anchors.
///
/// Ranges at different times are interpolated to common times, and those within a place, half a metre wide, are
/// reduced to medians, so that outliers do not count; [`HeightSearch`] computes the height from the places. A height
/// is available at any time. Use it, together with its biases unless the anchors are calibrated, once its
/// [`Height::position_sigma`] is small enough: `host-sim` requires 15 cm, and adds it to the tracker's own position
/// uncertainty.
///
/// Takes 2.3 kB for four anchors in `f32`, 6.4 kB for eight.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HeightFinder<T: Scalar, const A: usize> {
    search: HeightSearch<T, A>,
    biases: Vec<T, A>,
    /// The last range of each anchor without its bias, and the one before it.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    links: [Link<T>; A],
    /// Time of the newest range, µs.
    newest_us: Option<u64>,
    /// Time of the last common time that was used, µs.
    moment_us: Option<u64>,
    place: Option<Place<T, A>>,
    pace: Pace,
}

/// An anchor's last two ranges (m) with their times (µs).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Link<T> {
    last: Option<(u64, T)>,
    before: Option<(u64, T)>,
}

/// The ranges at all times at which the tag was within a place.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
struct Place<T, const A: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    first: [Option<T>; A],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    ranges: [Quartiles<T>; A],
    moments: u32,
}

/// Prior standard deviations of the common bias and of each anchor's own bias, m. Uncalibrated, these are
/// `Config::common_bias_sigma` and the standard deviation of the anchors' calibration; for calibrated anchors, their
/// variances may fall to (5 cm)².
const UNCALIBRATED: [f64; 2] = [0.3, 0.1];
const CALIBRATED: [f64; 2] = [0.05, 0.05];
/// A place ends when two ranges differ by more than this from those at its beginning, m. Errors of links at places
/// farther apart are independent: on 90 recorded points, their correlation is 0.2 over 9 cm, 0.1 from 20 to 40 cm, and
/// 0.03 over 2 m.
const PLACE: f64 = 0.5;

impl<T: Scalar, const A: usize> HeightFinder<T, A> {
    /// Creates a search for anchors with known biases.
    ///
    /// # Errors
    /// [`Error::TooManyAnchors`], [`Error::TooFewAnchors`] for fewer than three, or [`Error::NotFinite`].
    pub fn calibrated(anchors: &[Anchor<T>]) -> Result<Self, Error> {
        let [common, own] = CALIBRATED;
        Self::new(anchors, T::from_f64(common), T::from_f64(own))
    }

    /// Creates a search for uncalibrated anchors.
    ///
    /// # Errors
    /// Those of [`HeightFinder::calibrated`].
    pub fn uncalibrated(anchors: &[Anchor<T>]) -> Result<Self, Error> {
        let [common, own] = UNCALIBRATED;
        Self::new(anchors, T::from_f64(common), T::from_f64(own))
    }

    fn new(anchors: &[Anchor<T>], common: T, own: T) -> Result<Self, Error> {
        let (mut places, mut biases) = (Vec::<SVector<T, 3>, A>::new(), Vec::new());
        for anchor in anchors {
            anchor.check()?;
            places.push(anchor.position).map_err(|_| Error::TooManyAnchors)?;
            biases.push(anchor.bias).map_err(|_| Error::TooManyAnchors)?;
        }
        let search = HeightSearch::new(&places, common, own).map_err(|error| match error {
            NoPlace::TooFewRanges => Error::TooFewAnchors,
            _ => Error::NotFinite,
        })?;
        let links = [Link { last: None, before: None }; A];
        Ok(Self {
            search,
            biases,
            links,
            newest_us: None,
            moment_us: None,
            place: None,
            pace: Pace::new(anchors.len()),
        })
    }

    /// Processes a range. Returns whether it ended a place, so that the height may have changed.
    ///
    /// # Errors
    /// [`Error::NoSuchAnchor`], [`Error::NotFinite`], [`Error::ImplausibleRange`], [`Error::Duplicate`] or
    /// [`Error::OutOfOrder`]; nothing is changed.
    pub fn range(&mut self, sample: &RangeSample<T>) -> Result<bool, Error> {
        let bias = *self.biases.get(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let link = self.links.get(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        sample.check()?;
        match link.last {
            Some((heard_us, _)) if heard_us == sample.time_us => return Err(Error::Duplicate),
            Some((heard_us, _)) if heard_us > sample.time_us => return Err(Error::OutOfOrder),
            _ => {}
        }
        // All ranges of a time have arrived when there is one with a later time.
        let is_later = self.newest_us.is_none_or(|newest_us| newest_us < sample.time_us);
        let ended = is_later && self.take_moment();
        if is_later {
            self.newest_us = Some(sample.time_us);
        }
        self.pace.hear(sample.time_us);
        if let Some(link) = self.links.get_mut(sample.anchor) {
            let last = Some((sample.time_us, sample.range - bias));
            *link = Link { last, before: link.last };
        }
        Ok(ended)
    }

    /// Ends the present place, as when the tag is picked up or no more ranges will come. Otherwise a place counts once
    /// it has been left.
    pub fn end_place(&mut self) {
        self.take_moment();
        self.close_place();
    }

    fn close_place(&mut self) {
        let Some(place) = self.place.take() else { return };
        let mut medians = [None; A];
        for (median, ranges) in medians.iter_mut().zip(&place.ranges) {
            // Only for an anchor that was heard half of the time.
            if ranges.count() >= place.moments.div_ceil(2) {
                *median = ranges.median();
            }
        }
        // A place with too few anchors, or without a consistent position, is ignored.
        let _ = self.search.add(&medians);
    }

    /// The height, with its standard deviation and the anchors' biases in addition to [`Anchor::bias`]; `None` before
    /// the tag has left a place.
    pub fn height(&self) -> Option<Height<T, A>> {
        self.search.height()
    }

    /// Uses the newest common time, if it is new. Returns whether that ended a place.
    fn take_moment(&mut self) -> bool {
        let moment = self.newest_us.and_then(|newest_us| self.moment(newest_us));
        moment.is_some_and(|ranges| self.take(&ranges))
    }

    /// The ranges at the newest time to which those of all anchors heard can be interpolated; `None` if that is not
    /// new.
    fn moment(&mut self, time_us: u64) -> Option<[Option<T>; A]> {
        let fresh_us = self.pace.fresh_us();
        let fresh = |heard_us: u64| time_us.saturating_sub(heard_us) <= fresh_us;
        let last = self.links.iter().filter_map(|link| link.last.map(|(heard_us, _)| heard_us));
        let moment_us = last.filter(|&heard_us| fresh(heard_us)).min()?;
        if self.moment_us.is_some_and(|before_us| moment_us <= before_us) {
            return None;
        }
        self.moment_us = Some(moment_us);
        Some(self.links.map(|link| {
            let (last_us, last) = link.last.filter(|&(heard_us, _)| fresh(heard_us))?;
            if last_us == moment_us {
                return Some(last);
            }
            let (before_us, before) = link.before?;
            let since_us = moment_us.checked_sub(before_us)?;
            let interval_us = last_us.saturating_sub(before_us);
            if interval_us == 0 || interval_us > fresh_us {
                return None;
            }
            // No longer than the longest time for which ranges are fresh.
            let seconds = |us: u64| T::from_micro(us.min(u64::from(Pace::MOST_US)) as i32);
            Some(before + (last - before) * (seconds(since_us) / seconds(interval_us)))
        }))
    }

    fn take(&mut self, ranges: &[Option<T>; A]) -> bool {
        if ranges.iter().flatten().count() < 3 {
            return false;
        }
        let ended = self.place.as_ref().is_some_and(|place| place.is_left(ranges));
        if ended {
            self.close_place();
        }
        let place = self.place.get_or_insert_with(|| Place {
            first: *ranges,
            ranges: [Quartiles::within(-T::ONE, T::from_f64(200.0)); A],
            moments: 0,
        });
        place.moments = place.moments.saturating_add(1);
        for (all, range) in place.ranges.iter_mut().zip(ranges) {
            if let Some(range) = *range {
                all.add(range);
            }
        }
        ended
    }
}

impl<T: Scalar, const A: usize> Place<T, A> {
    /// Whether two ranges differ from those at the beginning: one alone may be an outlier.
    fn is_left(&self, ranges: &[Option<T>; A]) -> bool {
        let pairs = self.first.iter().zip(ranges);
        let pairs = pairs.filter_map(|(first, range)| Some(((*first)?, (*range)?)));
        let (mut common, mut far) = (0_u16, 0_u16);
        for (first, range) in pairs {
            common = common.saturating_add(1);
            far = far.saturating_add(u16::from((range - first).abs() > T::from_f64(PLACE)));
        }
        common < 2 || far >= 2
    }
}

#[cfg(test)]
mod tests;
