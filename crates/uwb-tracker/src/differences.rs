//! Tracking of a tag that only listens.

use crate::config::{OFFICE, size};
use crate::health::Common;
use crate::measurement::Range;
use crate::tracker::{LATE_US, Place};
use crate::{
    Anchor, Config, DifferenceSample, Error, Health, Outcome, RangeSample, Report, Tracker,
};
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_ranging::{dilution_of_precision, expected_range};
use nalgebra::SVector;

/// Tracks position, velocity and clock of a tag from differences of its distances to up to A anchors (TDOA, downlink
/// or uplink).
///
/// A difference consists of two arrivals with independent errors, and a clock between them. Therefore the tracker
/// keeps arrivals: the distance and the clock of the latest anchor, to which the difference to the next one is added.
/// Its states are D coordinates (m), their velocities (m/s) and that clock (m), N = 2 D + 1. Successive differences
/// share a reception, and are not independent: treated as if they were, they would give positions with larger errors
/// than necessary, and standard deviations that are too small. As each arrival belongs to one anchor, each has its
/// noise, gate and bias as in a [`Tracker`], and an obstacle can only delay it.
///
/// A difference that does not continue another one starts with an unknown clock.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DifferenceTracker<T: Scalar, const D: usize, const N: usize, const A: usize> {
    tracker: Tracker<T, D, N, A>,
    /// The second anchor of the last difference, and whether its arrival was used.
    last: Option<(usize, bool)>,
    /// When the clock began, µs: earlier arrivals belong to another one.
    begun_us: u64,
    /// Mean distance from the anchors' centre to the anchors, at least that of an office, m.
    reach: T,
}

/// Standard deviation of the anchors' receptions of each other, m: the random walk of the clock between two
/// differences.
const LINK_SIGMA: f64 = 0.02;
/// Standard deviation of an unknown clock, m: its drift during the time without a link does not matter, because its
/// zero is then chosen anew.
const CLOCK_SIGMA: f64 = 3.0;
/// Clock value beyond which it is set back to zero, m, so that fixed point has room.
const FARTHEST: f64 = 8.0;
/// Longest time for which a reception continues the last difference, µs.
const CHAINED_US: u64 = 100_000;
/// Longest time for which a reception that did not end the last difference is used, µs: the anchor may have sent
/// another message since.
const REMEMBERED_US: u64 = 20_000;

impl<T: Scalar, const D: usize, const N: usize, const A: usize> DifferenceTracker<T, D, N, A> {
    /// Creates a tracker for these anchors, before its first position.
    ///
    /// # Errors
    /// [`Error::TooManyAnchors`] or [`Error::NotFinite`].
    pub fn new(config: Config<T>, anchors: &[Anchor<T>]) -> Result<Self, Error> {
        const { assert!(N == 2 * D + 1, "positions, velocities and the clock") };
        let mut tracker = Tracker::new(config, anchors)?;
        tracker.bias_shape = [T::ONE, T::ZERO];
        let reach = size(anchors) * T::from_f64(OFFICE);
        tracker.config.common_bias_sigma = reach + reach;
        // Mirror images are only considered with ranges.
        tracker.flat = None;
        Ok(Self { tracker, last: None, begun_us: 0, reach })
    }

    /// Position of the tag, m; `None` before the first one, or when it is lost.
    pub fn position(&self) -> Option<SVector<T, D>> {
        self.tracker.position()
    }

    /// Velocity of the tag, m/s.
    pub fn velocity(&self) -> Option<SVector<T, D>> {
        self.tracker.velocity()
    }

    /// Mean and covariance of all states; `None` without a position.
    pub fn estimate(&self) -> Option<&Gaussian<T, N>> {
        self.tracker.estimate()
    }

    /// Sets the height of the tag, m, for a position in two dimensions.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn set_height(&mut self, height: T) -> Result<(), Error> {
        self.tracker.set_height(height)
    }

    /// Processes a difference. The report is that of the second anchor's arrival.
    ///
    /// # Errors
    /// [`Error::NoSuchAnchor`], also if both anchors are the same; [`Error::NotFinite`], [`Error::ImplausibleRange`]
    /// beyond 200 m, [`Error::Duplicate`], [`Error::OutOfOrder`] or [`Error::Estimate`]; the tracker is unchanged.
    pub fn difference(&mut self, sample: &DifferenceSample<T>) -> Result<Report<T>, Error> {
        let sample = &self.turned(sample);
        let difference = self.admit(sample)?;
        let time_us = sample.time_us.max(self.tracker.time_us);
        let before = (self.tracker.timed(), self.tracker.is_located());
        let report = self.tracker.advance(time_us, None).and_then(|()| {
            if self.tracker.is_located() {
                self.measure(sample, difference)
            } else {
                if before.1 {
                    self.forget();
                }
                Ok(self.collect(sample, difference))
            }
        });
        match report {
            Err(_) => self.tracker.restore(before.0),
            Ok(_) if self.tracker.is_located() => self.set_back(),
            // The position was just given up: the arrivals no longer belong to a clock.
            Ok(Report { outcome: Outcome::Rejected, .. }) => self.forget(),
            Ok(_) => {}
        }
        report
    }

    /// Health of the tracker at `time_us`. The dilution of precision is that of differences.
    pub fn health(&self, time_us: u64) -> Health<T> {
        // The clock absorbs any common bias.
        let mut health = self.tracker.health_beside(Common::NONE, time_us);
        let Some(dilution) = health.dilution else { return health };
        let own = self.dilution(time_us);
        // The clock magnifies constant errors as it does all others.
        let factor = own.map_or(T::ONE, |own| own / dilution).max(T::ONE);
        let bias_sigma = health.bias_sigma * factor;
        health.position_sigma = health.position_sigma.map(|sigma| {
            let rest = (sigma - health.bias_sigma) * (sigma + health.bias_sigma);
            rest.max(T::ZERO).sqrt().hypot(bias_sigma)
        });
        (health.dilution, health.bias_sigma) = (own, bias_sigma);
        health
    }

    /// Dilution of precision of the directions minus their mean, which the clock absorbs.
    fn dilution(&self, time_us: u64) -> Option<T> {
        let (position, fresh_us) = (self.position()?, self.tracker.pace.fresh_us());
        let heard = self.tracker.links.iter();
        let heard =
            heard.filter(|link| !link.is_blocked && link.fresh(time_us, fresh_us).is_some());
        let direction = |place: &SVector<T, 3>| {
            expected_range(&position, self.tracker.config.height, place).direction
        };
        let (mut mean, mut count) = ([T::ZERO; D], 0);
        for link in heard.clone() {
            let direction = direction(&link.anchor.position);
            for axis in 0..D {
                mean[axis] += direction[axis];
            }
            count += 1;
        }
        let share = T::from_micro(count.clamp(1, 2000) * 1_000_000).recip();
        let mean = mean.map(|sum| sum * share);
        let centred = heard.map(|link| {
            let direction = direction(&link.anchor.position);
            core::array::from_fn::<T, D, _>(|axis| direction[axis] - mean[axis])
        });
        dilution_of_precision(centred).ok()
    }

    /// The sample, turned round if its second anchor is the one that was heard at this time: some receivers name the reference last.
    fn turned(&self, sample: &DifferenceSample<T>) -> DifferenceSample<T> {
        let DifferenceSample { time_us, anchors: [first, second], difference } = *sample;
        let links = &self.tracker.links;
        let is_heard =
            |anchor: usize| links.get(anchor).is_some_and(|link| link.is_heard_at(time_us));
        if is_heard(second) && !is_heard(first) {
            DifferenceSample { time_us, anchors: [second, first], difference: -difference }
        } else {
            *sample
        }
    }

    /// The difference without both anchors' biases, if it is plausible and new.
    fn admit(&self, sample: &DifferenceSample<T>) -> Result<T, Error> {
        let [first, second] = sample.anchors;
        let links = &self.tracker.links;
        let (Some(one), Some(other)) = (links.get(first), links.get(second)) else {
            return Err(Error::NoSuchAnchor);
        };
        if first == second {
            return Err(Error::NoSuchAnchor);
        }
        sample.check()?;
        if self.tracker.time_us.saturating_sub(sample.time_us) > LATE_US {
            return Err(Error::OutOfOrder);
        }
        let is_last = self.last.is_some_and(|(last, _)| last == second);
        let is_again = is_last && other.fresh(sample.time_us, 0).is_some();
        if is_again || other.is_heard_at(sample.time_us) {
            return Err(Error::Duplicate);
        }
        Ok(sample.difference - other.anchor.bias + one.anchor.bias)
    }

    /// The first anchor's arrival, if this difference continues another one.
    fn continued(&self, sample: &DifferenceSample<T>) -> Option<T> {
        let [first, _] = sample.anchors;
        let age_us = match self.last {
            Some((last, true)) if last == first => CHAINED_US,
            // Either this anchor's arrival was late, or the clock has jumped.
            Some((last, false)) if last == first => return None,
            _ => REMEMBERED_US.min(sample.time_us.saturating_sub(self.begun_us)),
        };
        let link = self.tracker.links.get(first)?;
        link.fresh(sample.time_us, age_us).map(|(arrival, _)| arrival)
    }

    fn measure(&mut self, sample: &DifferenceSample<T>, difference: T) -> Result<Report<T>, Error> {
        let [first, second] = sample.anchors;
        let continued = self.continued(sample);
        let height = self.tracker.config.height;
        let (Some(link), Place::Known(estimate)) =
            (self.tracker.links.get(first), &mut self.tracker.place)
        else {
            return Err(Error::NoSuchAnchor);
        };
        let mut begun = None;
        let arrival = if let Some(arrival) = continued {
            estimate.add_variance_at(2 * D, T::from_f64(LINK_SIGMA * LINK_SIGMA))?;
            arrival
        } else {
            let position = SVector::<T, D>::from_fn(|axis, _| estimate.mean.as_array()[axis]);
            let place = link.anchor.position;
            let measured = expected_range(&position, height, &place).distance;
            estimate.reset_at(2 * D, T::ZERO, T::from_f64(CLOCK_SIGMA * CLOCK_SIGMA))?;
            let observation = Range::<T, D> {
                measured,
                anchor: &place,
                height,
                observes_bias: true,
                bias_shape: [T::ONE, T::ZERO],
            };
            let weighed = estimate.weigh_observation(&observation, link.noise.variance())?;
            estimate.correct(&weighed)?;
            begun = Some(measured);
            measured
        };
        let range = arrival + difference;
        let own = RangeSample { time_us: sample.time_us, anchor: second, range };
        let redundant = self.tracker.heard as usize > D + 1;
        let report = self.tracker.measure(&own, range, [true, redundant])?;
        if let (Some(measured), Some(link)) = (begun, self.tracker.links.get_mut(first)) {
            link.hear(sample.time_us, measured);
            self.begun_us = sample.time_us;
        }
        self.last = Some((second, report.outcome != Outcome::Rejected));
        Ok(report)
    }

    /// Stores the arrivals of a difference for a first position, and determines one if possible.
    fn collect(&mut self, sample: &DifferenceSample<T>, difference: T) -> Report<T> {
        let [first, second] = sample.anchors;
        let (time_us, fresh_us) = (sample.time_us, self.tracker.pace.fresh_us());
        let links = &self.tracker.links;
        let collected = Report { outcome: Outcome::Collected, innovation: None };
        let heard = |anchor: usize| {
            let (arrival, _) = links.get(anchor)?.fresh(time_us, fresh_us)?;
            Some(arrival)
        };
        let is_first = links.iter().all(|link| link.fresh(time_us, fresh_us).is_none());
        let (anchor, range) = match (heard(first), heard(second)) {
            (Some(arrival), _) => (second, arrival + difference),
            (None, Some(arrival)) => (first, arrival - difference),
            (None, None) if is_first => {
                // The search in progress belongs to another clock.
                self.tracker.give_up();
                if let Some(link) = self.tracker.links.get_mut(first) {
                    link.hear(time_us, T::ZERO);
                }
                (second, difference)
            }
            // Not related to any known clock.
            (None, None) => return collected,
        };
        self.last = Some((anchor, true));
        let is_begun = self.tracker.is_begun();
        let links = &mut self.tracker.links;
        let (mut sum, mut count) = (range, 1);
        for (other, link) in links.iter().enumerate() {
            if let Some((arrival, _)) = link.fresh(time_us, fresh_us).filter(|_| other != anchor) {
                sum += arrival;
                count += 1;
            }
        }
        // One more than the unknowns: with fewer there may be two positions.
        if count < D as i32 + 2 {
            if let Some(link) = links.get_mut(anchor) {
                link.hear(time_us, range);
            }
            self.tracker.pace.hear(time_us);
            return collected;
        }
        let mut range = range;
        // The clock is chosen so that arrivals look like distances: least squares knows it to some metres beforehand.
        // It is kept during the search for a position, to which it belongs.
        if !is_begun {
            let by = self.reach - sum * T::from_micro(count.min(2000) * 1_000_000).recip();
            for link in links.iter_mut() {
                link.shift(by);
            }
            range += by;
        }
        self.tracker.collect(&RangeSample { time_us, anchor, range }, range)
    }

    /// Forgets all arrivals, which belong to no clock any more once the tracker has no position.
    fn forget(&mut self) {
        for link in &mut self.tracker.links {
            link.forget();
        }
        self.last = None;
    }

    /// Resets a clock that has drifted far from zero, and shifts all arrivals accordingly.
    fn set_back(&mut self) {
        let Place::Known(estimate) = &mut self.tracker.place else { return };
        let clock = &mut estimate.mean.as_array_mut()[2 * D];
        if clock.abs() <= T::from_f64(FARTHEST) {
            return;
        }
        for link in &mut self.tracker.links {
            link.shift(-*clock);
        }
        *clock = T::ZERO;
    }
}
