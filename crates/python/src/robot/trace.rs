//! Feeds a tracker, and keeps what became of every range.

use kestirim_health::{Health, Reason, State};

use super::events::{Motion, Rows};
use super::height::Found;
use super::tag::Tag;
use crate::arrays::code;

/// A position of a larger standard deviation is not what anybody ranges for, m.
const VAGUE_M: f64 = 1.0;

/// Where the tag was found at one time at which there are ranges.
struct Epoch {
    time_us: i64,
    position: Option<[f64; 3]>,
    spread: Option<[f64; 3]>,
    height_variance: Option<f64>,
    health: State,
}

impl Epoch {
    fn is_vague(&self) -> bool {
        self.spread.is_some_and(|[xx, _, yy]| (xx + yy).max(0.0).sqrt() > VAGUE_M)
    }
}

/// What a tracker made of a recording.
#[derive(Default)]
pub(super) struct Trace {
    epochs: Vec<Epoch>,
    /// Of each row: whether its range was taken in, …
    pub(super) taken: Vec<bool>,
    /// … its normalised innovation squared, …
    pub(super) nis: Vec<f64>,
    /// … and, of those that were ranges, when and whether they were taken in.
    ranges: Vec<(i64, bool)>,
}

/// Feeds a tracker in the order of times: at one time motion, height, ranges.
pub(super) fn follow(tag: &mut dyn Tag, rows: &Rows<'_>, motion: &Motion) -> Trace {
    let times_us = rows.times_us();
    let moved_us = motion.samples.iter().map(|(us, _)| *us);
    let earliest = times_us.iter().map(|(us, _)| *us).chain(moved_us).min();
    let start_us = earliest.unwrap_or_default();
    let since = |time_us: i64| time_us.saturating_sub(start_us).max(0) as u64;
    let mut moved = motion.samples.iter().peekable();
    let (mut trace, mut recent, mut latest_us) = (Trace::default(), Recent::default(), i64::MIN);
    (trace.taken, trace.nis) = (vec![false; rows.t.len()], vec![f64::NAN; rows.t.len()]);
    for epoch in times_us.chunk_by(|a, b| a.0 == b.0) {
        let time_us = epoch[0].0;
        while let Some((us, moved)) = moved.next_if(|(us, _)| *us <= time_us) {
            tag.moved(since(*us), *moved);
        }
        if let Some(metres) = rows.height_at(time_us) {
            tag.set_height(since(time_us), metres);
        }
        for &(_, row) in epoch {
            let (anchor, range) = (rows.anchor[row] as usize, rows.range[row]);
            if !range.is_nan() {
                (trace.taken[row], trace.nis[row]) = tag.range(since(time_us), anchor, range);
                trace.ranges.push((time_us, trace.taken[row]));
            }
        }
        // Ranges that come late end no epoch.
        if time_us > latest_us {
            latest_us = time_us;
            tag.end_epoch(since(time_us));
            trace.end_epoch(tag, time_us, &mut recent);
        }
    }
    for (us, moved) in moved {
        tag.moved(since(*us), *moved);
    }
    trace
}

impl Trace {
    fn end_epoch(&mut self, tag: &dyn Tag, time_us: i64, recent: &mut Recent) {
        let (position, spread) = (tag.position(), tag.spread());
        let health = recent.health(time_us, &self.ranges);
        let height_variance = tag.height_variance();
        let mut epoch = Epoch { time_us, position, spread, height_variance, health };
        if epoch.is_vague() && epoch.health == State::Good {
            epoch.health = Reason::NotObservable.state();
        }
        self.epochs.push(epoch);
    }

    /// Adds what a height that was found leaves uncertain.
    pub(super) fn widen(&mut self, found: &Found) {
        let half = 0.5 * found.position_sigma * found.position_sigma;
        for epoch in &mut self.epochs {
            epoch.height_variance = Some(found.sigma * found.sigma);
            if let Some([xx, _, yy]) = epoch.spread.as_mut() {
                *xx += half;
                *yy += half;
            }
        }
    }

    pub(super) fn seconds(&self) -> Vec<f64> {
        self.epochs.iter().map(|epoch| epoch.time_us as f64 / 1e6).collect()
    }

    /// Not a number while the tracker does not know.
    pub(super) fn positions(&self) -> Vec<[f64; 3]> {
        self.epochs.iter().map(|epoch| epoch.position.unwrap_or([f64::NAN; 3])).collect()
    }

    pub(super) fn sigmas(&self) -> Vec<[f64; 3]> {
        let of = |variance: Option<f64>| variance.map_or(f64::NAN, |it| it.max(0.0).sqrt());
        let sigmas = |epoch: &Epoch| {
            let [x, y] = epoch.spread.map_or([None; 2], |[xx, _, yy]| [Some(xx), Some(yy)]);
            [x, y, epoch.height_variance].map(of)
        };
        self.epochs.iter().map(sigmas).collect()
    }

    pub(super) fn healths(&self) -> Vec<u8> {
        self.epochs.iter().map(|epoch| code(epoch.health)).collect()
    }

    /// How long the tag was not known after the first range, s.
    pub(super) fn lost_s(&self) -> f64 {
        let lost = self.epochs.windows(2).filter(|pair| pair[0].position.is_none());
        lost.map(|pair| (pair[1].time_us - pair[0].time_us) as f64 * 1e-6).fold(0.0, |a, b| a + b)
    }

    /// Why the whole track is not good.
    pub(super) fn doubts(&self) -> Health {
        let taken = self.ranges.iter().filter(|(_, taken)| *taken).count();
        let known = self.epochs.iter().filter(|epoch| epoch.position.is_some()).count();
        let vague = self.epochs.iter().filter(|epoch| epoch.is_vague()).count();
        let ends = self.epochs.first().zip(self.epochs.last());
        let span = ends.map_or(0.0, |(first, last)| (last.time_us - first.time_us) as f64 * 1e-6);
        let is_lost = self.epochs.last().is_none_or(|epoch| epoch.position.is_none());
        Health::GOOD
            .with(Reason::Rejected, self.ranges.len() - taken > taken)
            .with(Reason::NotObservable, is_lost || 10 * vague > known)
            .with(Reason::Dropout, self.lost_s() > 0.1 * span)
    }
}

/// The ranges of the last seconds.
#[derive(Default)]
struct Recent {
    /// The first of them.
    first: usize,
    rejected: usize,
    /// Beyond the last of them.
    end: usize,
}

impl Recent {
    /// As far back as is looked, µs.
    const SPAN_US: i64 = 10_000_000;
    /// Of fewer ranges no share is taken.
    const FEWEST: usize = 20;

    /// Less than good while more ranges are left out than taken in.
    fn health(&mut self, now_us: i64, ranges: &[(i64, bool)]) -> State {
        self.rejected += ranges[self.end..].iter().filter(|(_, taken)| !taken).count();
        self.end = ranges.len();
        while let Some((time_us, taken)) = ranges[self.first..].first() {
            if *time_us >= now_us - Self::SPAN_US {
                break;
            }
            self.rejected -= usize::from(!taken);
            self.first += 1;
        }
        let count = self.end - self.first;
        if count >= Self::FEWEST && 2 * self.rejected > count {
            Reason::Rejected.state()
        } else {
            State::Good
        }
    }
}
