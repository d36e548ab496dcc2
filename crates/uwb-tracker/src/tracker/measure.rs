//! Updates of the estimate with ranges.

use super::{Place, Tracker};
use crate::measurement::Range;
use crate::mirror;
use crate::take_in::{Known, take_in};
use crate::{Error, Outcome, RangeSample, Report};
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

impl<T: Scalar, const D: usize, const N: usize, const A: usize> Tracker<T, D, N, A> {
    /// Updates the estimate with a range at the estimate's own time. The flags tell whether the common bias is
    /// observed, and whether there are more ranges than unknowns.
    #[inline(always)]
    pub(crate) fn measure(
        &mut self,
        sample: &RangeSample<T>,
        range: T,
        [observes_bias, redundant]: [bool; 2],
    ) -> Result<Report<T>, Error> {
        let known = Known { is_redundant: redundant, is_still: self.stands };
        let link = self.links.get_mut(sample.anchor).ok_or(Error::NoSuchAnchor)?;
        let Place::Known(estimate) = &mut self.place else {
            return Ok(self.collect(sample, range));
        };
        let place = link.anchor.position;
        let observation = Range::<T, D> {
            measured: range,
            anchor: &place,
            height: self.config.height,
            observes_bias,
            bias_shape: self.bias_shape,
        };
        let (blocked, heard) = (link.is_blocked, self.heard);
        let agree = || self.counters.others_agree(blocked, heard, D);
        let (outcome, seen) = take_in(estimate, link, &observation, &self.config, known, agree)?;
        link.hear(sample.time_us, range);
        self.pace.hear(sample.time_us);
        if outcome == Outcome::Rejected {
            let is_blocked = link.is_blocked;
            self.reject(is_blocked);
        } else {
            self.counters.take(seen.nis);
            if self.mirror.is_some() && self.flat.is_none() && outcome != Outcome::Recovered {
                self.tell_apart(&place, (seen.innovation, seen.variance));
            }
        }
        Ok(Report { outcome, innovation: Some(seen) })
    }

    /// Discards the mirror image if a range of the anchor at `place` with this innovation (m) and variance does not
    /// fit it, or if enough anchors are heard and both positions coincide.
    #[inline(never)] // Rare.
    fn tell_apart(&mut self, place: &SVector<T, 3>, seen: (T, T)) {
        let (Some(across), Place::Known(estimate)) = (self.across(), &self.place) else { return };
        let position = SVector::<T, D>::from_fn(|axis, _| estimate.mean.as_array()[axis]);
        let here = (&position, self.config.height);
        let is_one =
            usize::from(self.heard) > D && T::norm(across.as_array()) <= mirror::spread(estimate);
        if is_one || mirror::tells(&across, here, place, seen) {
            self.mirror = None;
        }
    }

    /// Counts a rejected range, and gives the position up if too many were rejected lately.
    pub(super) fn reject(&mut self, is_blocked: bool) {
        if self.counters.reject(self.heard.max(D as u8), is_blocked) {
            self.give_up();
        }
    }

    /// Stores a range for a first position, and determines one if possible.
    #[inline(never)] // Rare, and large.
    pub(crate) fn collect(&mut self, sample: &RangeSample<T>, range: T) -> Report<T> {
        let mut again = false;
        if let Some(link) = self.links.get_mut(sample.anchor) {
            again = link.fresh(self.time_us, self.pace.fresh_us()).is_some();
            link.hear(sample.time_us, range);
        }
        again &= self.pace.collect(sample.time_us, sample.anchor);
        let now_us = self.time_us;
        let started = self.begin(now_us, again);
        if started {
            // It applies to a slightly earlier time. If it cannot be predicted now, it is with the next sample.
            let _ = self.advance(now_us, None);
        }
        let started = started && self.estimate().is_some();
        let outcome = if started { Outcome::Started } else { Outcome::Collected };
        Report { outcome, innovation: None }
    }

    /// Searches for the position from the fresh ranges, if they suffice: when all anchors have been heard, or one of
    /// them `again` after another one, before the others.
    pub(super) fn begin(&mut self, now_us: u64, again: bool) -> bool {
        let heard = self.count_heard(now_us);
        let may = again || usize::from(heard) >= self.links.len();
        let (now, leisure) = ((now_us, self.pace.fresh_us()), self.pace.leisure());
        let Place::Sought(start) = &mut self.place else { return false };
        let Some(begun) = start.go_on(&self.config, &self.links, now, leisure, may) else {
            return false;
        };
        // It applies to the time of its ranges.
        (self.place, self.time_us) = (Place::Known(begun.estimate), begun.time_us);
        for link in &mut self.links {
            *link = link.begun(&self.config);
        }
        (self.heard, self.mirror) = (heard, self.flat);
        self.counters.begun();
        true
    }
}
