//! `kestirim_uwb_tracker::DifferenceTracker` behind the trackers' interface.

use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{Config, DifferenceSample, DifferenceTracker};

use super::{Follow, Reception, bias_variance, place, with_bias};
use crate::robot::{Difference, Error, Event, MOST, Setup};
use crate::stored::{behind, read};
use crate::{Number, Stored};

/// A tracker that processes every difference individually, with N states including the clock. Until the first
/// difference, its answers are those of another tracker, for ranges.
#[derive(Debug)]
pub(super) struct Listening<T: Scalar, const D: usize, const N: usize> {
    ranges: Box<dyn Follow>,
    tracker: DifferenceTracker<T, D, N, MOST>,
    /// Whether a difference has come.
    listens: bool,
    /// Time of the last event, µs.
    now_us: u64,
    height_m: f64,
}

impl<T: Scalar, const D: usize, const N: usize> Listening<T, D, N> {
    /// A tracker of differences among the anchors of a setup, beside one of ranges.
    ///
    /// # Errors
    /// [`Error::Anchors`] if the anchors are unsuitable.
    pub(super) fn beside(
        ranges: Box<dyn Follow>,
        setup: &Setup,
        config: Config<T>,
    ) -> Result<Self, Error> {
        let config = Config { room: setup.room(), ..config };
        let tracker = DifferenceTracker::new(config, &setup.anchors())?;
        Ok(Self { ranges, tracker, listens: false, now_us: 0, height_m: setup.height_m })
    }

    fn bias_variance(&self) -> f64 {
        bias_variance(&self.tracker.health(self.now_us), D)
    }
}

impl<T: Number, const D: usize, const N: usize> Follow for Listening<T, D, N> {
    fn take(&mut self, time_us: u64, event: &Event) -> Reception {
        self.now_us = time_us;
        if let Event::Difference(Difference { anchors, metres, .. }) = *event {
            self.listens = true;
            let difference = T::from_f64(metres);
            let sample = DifferenceSample { time_us, anchors, difference };
            return Reception::of_range(&self.tracker.difference(&sample));
        }
        if let Event::Height { metres, .. } = *event
            && self.tracker.set_height(T::from_f64(metres)).is_ok()
        {
            self.height_m = metres;
        }
        self.ranges.take(time_us, event)
    }

    fn position(&self) -> Option<[f64; 3]> {
        if self.listens {
            return place(&self.tracker.position()?, self.height_m);
        }
        self.ranges.position()
    }

    fn spread(&self) -> Option<[f64; 3]> {
        if self.listens {
            return with_bias(&self.tracker.estimate()?.covariance, self.bias_variance());
        }
        self.ranges.spread()
    }

    fn height_variance(&self) -> Option<f64> {
        if self.listens {
            let covariance = &self.tracker.estimate().filter(|_| D == 3)?.covariance;
            return Some(covariance.get(2, 2)?.to_f64() + self.bias_variance());
        }
        self.ranges.height_variance()
    }

    fn mirror(&self) -> Option<[f64; 3]> {
        self.ranges.mirror().filter(|_| !self.listens)
    }

    fn health(&self) -> kestirim_health::Health {
        if self.listens {
            return self.tracker.health(self.now_us).in_short();
        }
        self.ranges.health()
    }

    fn snapshot(&self) -> Option<Vec<u8>> {
        // Most tags never receive differences.
        let tracker = if self.listens { self.tracker.stored()? } else { Vec::new() };
        let ranges = self.ranges.snapshot()?;
        let numbers = [self.now_us, self.height_m.to_bits(), tracker.len() as u64];
        Some(behind(numbers, &[tracker, ranges].concat()))
    }

    fn restore(&mut self, snapshot: &[u8]) -> Option<()> {
        let ([now_us, height, length], rest) = read(snapshot)?;
        let (tracker, ranges) = rest.split_at_checked(usize::try_from(length).ok()?)?;
        let listens = !tracker.is_empty();
        // A tracker that has received differences cannot return to a state without them.
        if self.listens && !listens {
            return None;
        }
        let tracker = if listens { Some(Stored::restored(tracker)?) } else { None };
        self.ranges.restore(ranges)?;
        if let Some(tracker) = tracker {
            self.tracker = tracker;
        }
        (self.listens, self.now_us, self.height_m) = (listens, now_us, f64::from_bits(height));
        Some(())
    }
}
