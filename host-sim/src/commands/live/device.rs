//! One sender of a line: its frames in their order, its estimator, and what became of it.

use std::sync::Arc;

use kestirim_telemetry::{Frame, Order, Origin};
use serde::Serialize;

use super::feed::Feed;
use super::order::Sorter;
use super::state::State;
use crate::Error;
use crate::numbers::{Numbers, Place};
use crate::system::Plan;

/// What became of a device's frames, and where it is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Row {
    /// Its boot number.
    pub boot: u32,
    /// Good frames.
    pub received: u32,
    /// Numbers that did not come.
    pub lost: u32,
    /// Frames that came twice, too late, or of another sender.
    pub left_out: u64,
    /// Those of them that are of another sender with this number, or of one that does not count its boots.
    pub another: u32,
    /// Measurements that the estimator took in.
    pub taken: u64,
    /// What cannot be true, or is older than what came before.
    pub refused: u64,
    /// How often it was switched on again.
    pub restarts: u32,
    /// The last time of its clock, µs.
    pub time_us: Option<u64>,
    /// Where the estimator is, m.
    pub position: Option<[f64; 3]>,
    /// Of a walk: its horizontal length from stance to stance, m.
    pub path_length_m: Option<f64>,
}

/// A sender.
#[derive(Debug)]
pub(super) struct Device {
    sorter: Sorter,
    feed: Feed,
    /// None of a sender that does not say who it is.
    numbers: Option<Numbers>,
    row: Row,
    twice: u64,
    /// Without figures, of one that is not shown in detail.
    brief: Option<Box<State>>,
    /// Whether anything came since it was shown.
    pub(super) is_news: bool,
}

impl Device {
    /// With a fresh estimator.
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

    /// Takes a frame in; `shown` is what is shown in detail.
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
                        // Its first frames may have been overtaken, too.
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

    /// Nothing comes for now.
    pub(super) fn pause(&mut self, shown: &mut State) -> Result<(), Error> {
        // What waited may go on now, and what takes long has time.
        self.is_news = true;
        let state = self.brief.as_deref_mut().unwrap_or(shown);
        self.sorter.release_all(|message| self.feed.take(message, state))
    }

    /// Nothing more will come.
    pub(super) fn finish(&mut self, shown: &mut State) -> Result<(), Error> {
        self.is_news = true;
        let state = self.brief.as_deref_mut().unwrap_or(shown);
        self.sorter.finish(|message| self.feed.take(message, state))
    }

    /// The estimator ends.
    ///
    /// # Errors
    /// As [`Feed::finish`].
    pub(super) fn end(&mut self) -> Result<(), Error> {
        self.feed.finish()
    }

    /// Time for what takes long.
    pub(super) fn settle(&mut self) {
        self.feed.settle();
    }

    /// How it is doing.
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
            ..self.row
        }
    }

    /// Frames that were left out.
    pub(super) fn left_out(&self) -> u64 {
        self.sorter.left_out() + self.twice + u64::from(self.row.another)
    }

    /// Numbers that are missing, of a sender that says who it is.
    pub(super) const fn lost(&self) -> u32 {
        self.row.lost
    }
}

/// Where a frame stands; the first begins.
fn place(numbers: &mut Option<Numbers>, origin: Origin, frame: &Frame) -> Place {
    if let Some(numbers) = numbers {
        return numbers.take(origin, frame);
    }
    *numbers = Some(Numbers::from(origin, frame));
    Place::Newest { missing: 0 }
}
