//! Knots: the times of a tag's positions, and the measurements at them.

use super::super::{Dimensions, Epoch, Event, Range, Reception, Setup};
use super::Tracked;

/// A time at which a position is estimated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Knot {
    /// The index of the part of the recording.
    pub(super) part: usize,
    /// The initial position, m; in the plane the height is known.
    pub(super) begin: [f64; 3],
    /// The tracker's estimate.
    pub(super) epoch: Epoch,
}

/// A range without the known bias of its anchor.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measured {
    /// The index of the knot.
    pub(super) knot: usize,
    /// The index of the anchor in the list.
    pub(super) anchor: usize,
    /// The range, m.
    pub(super) metres: f64,
}

/// All knots and ranges, in the order of time, part by part.
#[derive(Debug, Clone, Default)]
pub(super) struct Knots {
    pub(super) points: Vec<Knot>,
    pub(super) measured: Vec<Measured>,
    /// The number of parts.
    pub(super) parts: usize,
    /// Whether the tag was put down, and did not move.
    pub(super) is_static: bool,
}

/// The lower limit of the share of errors left in the residuals: with as many anchors as dimensions nothing would be
/// left.
const LEAST_LEFT_OVER: f64 = 0.25;

impl Knots {
    /// Collects the knots: one per epoch for a tag that moves, one per part for a tag that was put down. `None` if the
    /// tracker never found it.
    pub(super) fn new(setup: &Setup, parts: &[Tracked<'_>], is_static: bool) -> Option<Self> {
        let mut all = Self { parts: parts.len(), is_static, ..Self::default() };
        for (part, Tracked { events, trace }) in parts.iter().enumerate() {
            let mut found = trace.epochs.iter().filter_map(|epoch| epoch.position);
            let begin = if is_static { found.next_back() } else { found.next() };
            let Some(mut begin) = begin else { continue };
            // The outcome of every range, in order, and of every end of an epoch.
            let (mut ranges, mut epochs) = (trace.ranges.iter(), trace.epochs.iter());
            for event in *events {
                match event {
                    Event::Range(_) => all.take(setup, ranges.next()),
                    Event::Height { metres, .. } if setup.dimensions == Dimensions::Two => {
                        begin[2] = *metres;
                    }
                    Event::EpochEnd { .. } if !is_static => {
                        let Some(&epoch) = epochs.next() else { continue };
                        if let Some([x, y, z]) = epoch.position {
                            begin = [x, y, z];
                        }
                        all.points.push(Knot { part, begin, epoch });
                    }
                    _ => {}
                }
            }
            if let (true, Some(&epoch)) = (is_static, trace.epochs.last()) {
                all.points.push(Knot { part, begin, epoch });
            }
            // Ranges after the last epoch.
            let end = all.points.len();
            all.measured.retain(|measured| measured.knot < end);
        }
        (!all.points.is_empty()).then_some(all)
    }

    /// The share of lasting errors that remains in the residuals of ranges with positions in this many dimensions. A
    /// place is found from as many errors as anchors are heard there, and adapts to as many as it has dimensions. A tag
    /// that moves cannot follow them: nearly all remain.
    pub(super) fn left_over(&self, dimensions: usize) -> f64 {
        if !self.is_static {
            return 1.0;
        }
        let mut heard: Vec<_> = self.measured.iter().map(|it| (it.knot, it.anchor)).collect();
        heard.sort_unstable();
        heard.dedup();
        let at_a_place = heard.len() as f64 / self.points.len() as f64;
        (1.0 - dimensions as f64 / at_a_place).max(LEAST_LEFT_OVER)
    }

    /// Keeps a range for the next knot, unless the tracker rejected it as invalid, as late, or as a repetition. One
    /// that it weighed and left out may be of use.
    fn take(&mut self, setup: &Setup, range: Option<&(Range, Reception)>) {
        let Some((range, reception)) = range else { return };
        if reception.taken || reception.innovation.is_some() {
            let metres = range.metres - setup.bias(range.anchor);
            self.measured.push(Measured { knot: self.points.len(), anchor: range.anchor, metres });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{RangeRow, Sensors, Trace, build_changed};
    use super::*;

    const ANCHORS: [[f64; 3]; 3] = [[0.0, 0.0, 1.0], [6.0, 0.0, 1.0], [0.0, 6.0, 1.0]];

    fn tracked(setup: &Setup) -> (Vec<Event>, Trace) {
        let rows = (0..60).map(|index: i64| {
            let anchor = (index % 3) as usize;
            let metres = (ANCHORS[anchor][0] - 2.0).hypot(ANCHORS[anchor][1] - 1.0);
            // One is `NaN`, and one comes more than a second late.
            let range = Some(if index == 30 { f64::NAN } else { metres });
            let time_us = if index == 40 { 0 } else { index / 3 * 100_000 };
            RangeRow { time_us, anchor, range }
        });
        let events = Sensors::ranges(rows.collect()).events();
        // The tracker for a setup of any kind is avoided here: all trackers would be compiled for this test.
        let mut tracker = build_changed(setup, |_| {}).unwrap();
        let trace = Trace::by(tracker.as_mut(), setup, &events);
        (events, trace)
    }

    #[test]
    fn every_range_stands_at_an_epoch() {
        let setup = Setup::new(&ANCHORS, 1.0);
        let (events, trace) = tracked(&setup);
        let part = Tracked { events: &events, trace: &trace };
        for (is_static, expected) in [(false, trace.epochs.len()), (true, 1)] {
            let knots = Knots::new(&setup, &[part], is_static).unwrap();
            assert_eq!((knots.points.len(), knots.measured.len()), (expected, 58));
            assert!(knots.measured.iter().all(|it| it.knot < expected && it.metres > 0.0));
        }
        let nothing = Trace::default();
        let part = Tracked { events: &events, trace: &nothing };
        assert!(Knots::new(&setup, &[part], false).is_none());
    }

    #[test]
    fn three_anchors_leave_a_third_of_what_lasts() {
        let setup = Setup::new(&ANCHORS, 1.0);
        let (events, trace) = tracked(&setup);
        let part = Tracked { events: &events, trace: &trace };
        let of = |is_static| Knots::new(&setup, &[part], is_static).unwrap().left_over(2);
        assert!((of(true) - 1.0 / 3.0).abs() < 1e-9);
        assert_eq!(of(false), 1.0);
    }
}
