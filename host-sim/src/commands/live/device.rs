//! One sender of a line: the order of its frames, its estimator, and its counters.

use std::sync::Arc;

use kestirim_health::Health;
use kestirim_telemetry::{Frame, Order, Origin};
use serde::Serialize;

use super::feed::Feed;
use super::order::Sorter;
use super::own_health::OwnHealth;
use super::state::State;
use crate::Error;
use crate::numbers::{Numbers, Place};
use crate::system::Plan;

/// The counters of a device's frames, and its position.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Row {
    /// The boot number of the device.
    pub boot: u32,
    /// The number of good frames.
    pub received: u32,
    /// Missing sequence numbers.
    pub lost: u32,
    /// Frames that were duplicates, too late, or from another sender.
    pub left_out: u64,
    /// Left-out frames from another sender with this number, or from one that does not count its boots.
    pub another: u32,
    /// Measurements that the estimator used.
    pub taken: u64,
    /// Measurements that are implausible or older than earlier ones.
    pub refused: u64,
    /// The number of times that the device was switched on again.
    pub restarts: u32,
    /// The latest time of the device's clock, in microseconds.
    pub time_us: Option<u64>,
    /// The position estimate (m).
    pub position: Option<[f64; 3]>,
    /// For a walk, its horizontal length from stance to stance (m).
    pub path_length_m: Option<f64>,
    /// How far the estimate made here can be relied upon.
    pub health: Option<Health>,
    /// How far the device relies on its own estimate.
    pub own_health: Option<OwnHealth>,
}

impl Row {
    /// The health of the estimate made here, and of the device's own, in words.
    pub(super) fn healths(&self) -> [String; 2] {
        let unknown = || "–".to_owned();
        [
            self.health.map_or_else(unknown, |health| health.to_string()),
            self.own_health.map_or_else(unknown, |health| health.to_string()),
        ]
    }
}

/// A sender.
#[derive(Debug)]
pub(super) struct Device {
    sorter: Sorter,
    feed: Feed,
    /// The tracker of sequence numbers; `None` for a sender that does not identify itself.
    numbers: Option<Numbers>,
    row: Row,
    twice: u64,
    /// A state without figures, for a device that is not shown in detail.
    brief: Option<Box<State>>,
    /// Whether anything has arrived since the device was last shown.
    pub(super) is_news: bool,
}

impl Device {
    /// A device with a fresh estimator.
    pub(super) fn new(plan: Option<Arc<dyn Plan>>, is_shown: bool) -> Result<Self, Error> {
        Ok(Self {
            sorter: Sorter::default(),
            feed: Feed::new(plan)?,
            numbers: None,
            row: Row::default(),
            twice: 0,
            brief: (!is_shown).then(|| Box::new(State::brief())),
            is_news: false,
        })
    }

    /// Processes a frame; `shown` is the state that is shown in detail.
    pub(super) fn take(&mut self, frame: Frame, shown: &mut State) -> Result<(), Error> {
        self.is_news = true;
        self.row.received = self.row.received.saturating_add(1);
        let state = self.brief.as_deref_mut().unwrap_or(shown);
        let order = match (frame.origin, frame.order) {
            (Some(origin), _) => {
                self.row.boot = self.row.boot.max(origin.boot);
                match place(&mut self.numbers, origin, &frame) {
                    Place::Newest { missing } => {
                        self.row.lost = self.row.lost.saturating_add(missing);
                        Order::Newest { missing: u16::try_from(missing).unwrap_or(u16::MAX) }
                    }
                    Place::Restarted { missing } => {
                        self.row.lost = self.row.lost.saturating_add(missing);
                        self.sorter.release_all(|message| self.feed.take(message, state))?;
                        self.feed.begin_anew(state)?;
                        // Frames right after the restart may have been overtaken, too.
                        Order::Newest { missing: u16::try_from(missing).unwrap_or(u16::MAX) }
                    }
                    Place::Late { behind } => {
                        self.row.lost = self.row.lost.saturating_sub(1);
                        Order::Late { behind }
                    }
                    Place::Twice => {
                        self.twice += 1;
                        return Ok(());
                    }
                    Place::Another => {
                        self.row.another = self.row.another.saturating_add(1);
                        return Ok(());
                    }
                }
            }
            (None, order) => order.unwrap_or(Order::Newest { missing: 0 }),
        };
        self.sorter.take(frame, order, |message| self.feed.take(message, state))
    }

    /// Notes that nothing arrives at the moment.
    pub(super) fn pause(&mut self, shown: &mut State) -> Result<(), Error> {
        // Waiting frames may now be released, and there is time for lengthy work.
        self.is_news = true;
        let state = self.brief.as_deref_mut().unwrap_or(shown);
        self.sorter.release_all(|message| self.feed.take(message, state))
    }

    /// Releases the remaining frames at the end of the stream.
    pub(super) fn finish(&mut self, shown: &mut State) -> Result<(), Error> {
        self.is_news = true;
        let state = self.brief.as_deref_mut().unwrap_or(shown);
        self.sorter.finish(|message| self.feed.take(message, state))
    }

    /// Ends the estimator.
    ///
    /// # Errors
    /// Those of [`Feed::finish`].
    pub(super) fn end(&mut self) -> Result<(), Error> {
        self.feed.finish()
    }

    /// Performs lengthy work.
    pub(super) fn settle(&mut self) {
        self.feed.settle();
    }

    /// Updates the state that is shown, and returns the device's row.
    pub(super) fn show(&mut self, shown: &mut State) -> Row {
        self.is_news = false;
        let left_out = self.left_out();
        let state = self.brief.as_deref_mut().unwrap_or(shown);
        self.feed.show(state);
        Row {
            left_out,
            taken: state.counts.taken,
            refused: state.counts.refused,
            restarts: state.counts.restarts,
            time_us: state.time_us,
            position: state.position,
            path_length_m: state.path_length_m,
            health: state.estimate_health,
            own_health: state.own_health,
            ..self.row
        }
    }

    /// The number of frames that were left out.
    pub(super) fn left_out(&self) -> u64 {
        self.sorter.left_out() + self.twice + u64::from(self.row.another)
    }

    /// The number of missing frames of a sender that identifies itself.
    pub(super) const fn lost(&self) -> u32 {
        self.row.lost
    }
}

/// The place of a frame in the sequence; the first frame starts it.
fn place(numbers: &mut Option<Numbers>, origin: Origin, frame: &Frame) -> Place {
    if let Some(numbers) = numbers {
        return numbers.take(origin, frame);
    }
    *numbers = Some(Numbers::from(origin, frame));
    Place::Newest { missing: 0 }
}
