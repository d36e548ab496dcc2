//! Feeds a tracker, and keeps the outcome of every range.

use kestirim_health::{Health, Reason};

use super::{Difference, Error, Event, Follow, FoundHeight, Range, Reception, Setup, build};

/// The result of tracking one part of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// The epochs, one for each time with ranges, in order.
    pub epochs: Vec<Epoch>,
    /// Every range that was measured, and its outcome. A difference is listed with its second anchor.
    pub ranges: Vec<(Range, Reception)>,
}

/// The estimate at one epoch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Epoch {
    /// Time of the log's clock, µs.
    pub time_us: i64,
    /// The position, m; `None` while the tracker does not know it.
    pub position: Option<[f64; 3]>,
    /// Variance of x, covariance and variance of y, m², if the tracker knows them.
    pub spread: Option<[f64; 3]>,
    /// Variance of z, m², if the tracker estimates it, or that of the height that was found.
    pub height_variance: Option<f64>,
    /// The vector from the position to the other place that the ranges so far allow, m, if they allow two: the
    /// variances then cover both, also those that a smoother gives.
    pub mirror: Option<[f64; 3]>,
    /// How far the estimate can be relied upon.
    pub health: Health,
}

/// The standard deviation beyond which a position is too vague to be of use, m.
const VAGUE_M: f64 = 1.0;

impl Epoch {
    /// The standard deviations of x, y and z, m, as far as they are known.
    pub fn sigmas_m(&self) -> [Option<f64>; 3] {
        let of = |variance: f64| variance.max(0.0).sqrt();
        let [x, y] = self.spread.map_or([None; 2], |[xx, _, yy]| [xx, yy].map(|it| Some(of(it))));
        [x, y, self.height_variance.map(of)]
    }

    /// Whether the standard deviation of the position is above a metre; false if it is unknown.
    pub fn is_vague(&self) -> bool {
        self.sigma_m().is_some_and(|sigma| sigma > VAGUE_M)
    }

    /// Adds the uncertainty due to a height that was found: that of the height itself, and a root mean square distance
    /// in the plane, equal in all directions.
    pub(super) fn widen(&mut self, found: &FoundHeight) {
        let half = 0.5 * found.position_sigma_m * found.position_sigma_m;
        self.height_variance = Some(found.sigma_m * found.sigma_m);
        if let Some([xx, _, yy]) = self.spread.as_mut() {
            *xx += half;
            *yy += half;
        }
    }

    /// Adds the possibility that the tag is at the other place, with equal probability, if the ranges allow one.
    pub(super) fn doubt_side(&mut self) {
        let Some([x, y, z]) = self.mirror else { return };
        if let Some([xx, xy, yy]) = self.spread.as_mut() {
            *xx += 0.5 * x * x;
            *xy += 0.5 * x * y;
            *yy += 0.5 * y * y;
        }
        if let Some(variance) = self.height_variance.as_mut() {
            *variance += 0.5 * z * z;
        }
    }

    /// The standard deviation of the position in the plane, the root of the sum of its variances, m.
    pub fn sigma_m(&self) -> Option<f64> {
        self.spread.map(|[xx, _, yy]| (xx + yy).max(0.0).sqrt())
    }
}

impl Trace {
    /// Runs a given tracker over events, with the uncertainty of a height that was found.
    pub fn by(tracker: &mut dyn Follow, setup: &Setup, events: &[Event]) -> Self {
        let mut trace = follow(tracker, events);
        if let Some(found) = &setup.found {
            trace.widen(found);
        }
        trace
    }

    /// The number of ranges that were accepted.
    pub fn taken(&self) -> usize {
        self.ranges.iter().filter(|(_, reception)| reception.taken).count()
    }

    /// The number of ranges that were left out or rejected.
    pub fn rejected(&self) -> usize {
        self.ranges.len() - self.taken()
    }

    /// Adds the uncertainty of a height that was found to every epoch.
    fn widen(&mut self, found: &FoundHeight) {
        for epoch in &mut self.epochs {
            epoch.widen(found);
            epoch.health = epoch.health.with(Reason::NotObservable, epoch.is_vague());
        }
    }

    /// The times, µs, and positions, m, of all epochs with a position.
    pub fn known(&self) -> impl Iterator<Item = (i64, [f64; 3])> {
        self.epochs.iter().filter_map(|epoch| Some((epoch.time_us, epoch.position?)))
    }

    /// The position at the last epoch, if known.
    pub fn last(&self) -> Option<[f64; 3]> {
        self.epochs.last().and_then(|epoch| epoch.position)
    }

    /// Whether there is no position for more than a tenth of the time.
    pub fn is_interrupted(&self) -> bool {
        let ends = self.epochs.first().zip(self.epochs.last());
        let seconds = ends.map(|(first, last)| (last.time_us - first.time_us) as f64 * 1e-6);
        self.lost_s() > 0.1 * seconds.unwrap_or_default()
    }

    /// The time without a position after the first range, s.
    pub fn lost_s(&self) -> f64 {
        let lost = self.epochs.windows(2).filter(|pair| pair[0].position.is_none());
        lost.map(|pair| (pair[1].time_us - pair[0].time_us) as f64 * 1e-6).fold(0.0, |a, b| a + b)
    }
}

/// The ranges of the last seconds.
#[derive(Debug, Default)]
struct Recent {
    /// The index of the first of them.
    first: usize,
    rejected: usize,
    /// The index after the last of them.
    end: usize,
}

impl Recent {
    /// The time for which ranges count as recent, µs.
    const SPAN_US: i64 = 10_000_000;
    /// The fewest ranges from which a share is taken.
    const FEWEST: usize = 20;

    /// Whether more ranges are left out than accepted.
    fn are_rejected(&mut self, now_us: i64, ranges: &[(Range, Reception)]) -> bool {
        let is_rejected = |(_, reception): &(Range, Reception)| usize::from(!reception.taken);
        self.rejected += ranges[self.end..].iter().map(is_rejected).sum::<usize>();
        self.end = ranges.len();
        while let Some(old) = ranges[self.first..].first() {
            if old.0.time_us >= now_us - Self::SPAN_US {
                break;
            }
            self.rejected -= is_rejected(old);
            self.first += 1;
        }
        let count = self.end - self.first;
        count >= Self::FEWEST && 2 * self.rejected > count
    }
}

/// Feeds events to a tracker.
pub fn follow(tracker: &mut dyn Follow, events: &[Event]) -> Trace {
    let start_us = events.iter().map(Event::time_us).min().unwrap_or_default();
    let mut trace = Trace::default();
    let mut recent = Recent::default();
    for event in events {
        let time_us = event.time_us();
        let reception = tracker.take(time_us.saturating_sub(start_us).max(0) as u64, event);
        match event {
            Event::Range(range) => trace.ranges.push((*range, reception)),
            Event::Difference(Difference { time_us, anchors: [_, anchor], metres }) => {
                let (time_us, anchor, metres) = (*time_us, *anchor, *metres);
                trace.ranges.push((Range { time_us, anchor, metres }, reception));
            }
            Event::EpochEnd { .. } => {
                let (position, spread) = (tracker.position(), tracker.spread());
                let height_variance = tracker.height_variance();
                let are_rejected = recent.are_rejected(time_us, &trace.ranges);
                let health = tracker.health().with(Reason::Rejected, are_rejected);
                let mirror = tracker.mirror();
                let mut epoch =
                    Epoch { time_us, position, spread, height_variance, mirror, health };
                epoch.doubt_side();
                epoch.health = epoch.health.with(Reason::NotObservable, epoch.is_vague());
                trace.epochs.push(epoch);
            }
            _ => {}
        }
    }
    trace
}

/// Tracks a single part of a recording, with a tracker that is built for it.
///
/// # Errors
/// Those of [`build`].
pub fn track(setup: &Setup, events: &[Event]) -> Result<Trace, Error> {
    Ok(Trace::by(build(setup)?.as_mut(), setup, events))
}

/// The share of positions above which a property is reported for all.
const OFTEN: f64 = 0.1;

/// The share of positions with a property, if that is above `OFTEN`: of all positions of a tag that moves, or of the
/// last ones of a tag that was put down at as many points as there are traces.
fn often(traces: &[Trace], is_static: bool, is_so: impl Fn(&Epoch) -> bool) -> Option<f64> {
    let (mut count, mut all) = (0, 0);
    for trace in traces {
        let first = if is_static { trace.epochs.len().saturating_sub(1) } else { 0 };
        for epoch in trace.epochs[first..].iter().filter(|epoch| epoch.position.is_some()) {
            count += usize::from(is_so(epoch));
            all += 1;
        }
    }
    let share = f64::from(u32::try_from(count).ok()?) / f64::from(u32::try_from(all).ok()?);
    (share > OFTEN).then_some(share)
}

/// The share of positions at which the ranges allow two places, if that is above a tenth.
pub fn mirrored(traces: &[Trace], is_static: bool) -> Option<f64> {
    often(traces, is_static, |epoch| epoch.mirror.is_some())
}

/// The reasons to doubt positions: those of a tag that moves, or of one that was put down at as many points as there
/// are traces.
pub fn doubts(traces: &[Trace], is_static: bool) -> Health {
    let taken: usize = traces.iter().map(Trace::taken).sum();
    let rejected: usize = traces.iter().map(Trace::rejected).sum();
    let is_lost = traces.iter().all(|trace| trace.last().is_none());
    let is_often =
        |reason: &Reason| often(traces, is_static, |it| it.health.has(*reason)).is_some();
    let of_positions: Health = Reason::ALL.into_iter().filter(is_often).collect();
    of_positions
        .with(Reason::Rejected, rejected > taken)
        .with(Reason::NotObservable, is_lost)
        .with(Reason::Dropout, !is_static && traces.iter().any(Trace::is_interrupted))
}
