//! Feeds a recording to a tracker, in the order of its clock.

use super::follow::{Follow, Reception};
use super::motion::{Inertial, Wheels};
use super::points::Course;
use super::ranges::RangeRow;

/// Beside the ranges, what a recording may hold.
#[derive(Debug, Clone, Default)]
pub struct Company {
    /// Samples of the IMU; times do not decrease.
    pub inertial: Vec<Inertial>,
    /// Samples of the wheels; times do not decrease.
    pub wheels: Vec<Wheels>,
    /// Height of the tag over time, m.
    pub height: Option<Course<1>>,
}

/// Where the tag was found at one epoch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Epoch {
    /// Time of the log's clock, µs.
    pub time_us: i64,
    /// Where, m; none while the tracker does not know.
    pub position: Option<[f64; 3]>,
}

/// What a tracker made of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Followed {
    /// One entry for each time at which there are ranges, in order.
    pub epochs: Vec<Epoch>,
    /// Ranges taken in.
    pub updates: usize,
    /// Ranges left out or refused.
    pub rejected: usize,
}

impl Followed {
    /// Times, µs, and where the tag was then, m, wherever it was found.
    pub fn known(&self) -> impl Iterator<Item = (i64, [f64; 3])> {
        self.epochs.iter().filter_map(|epoch| Some((epoch.time_us, epoch.position?)))
    }

    /// Where it was at the last epoch, if that is known.
    pub fn last(&self) -> Option<[f64; 3]> {
        self.epochs.last().and_then(|epoch| epoch.position)
    }

    /// How long the tag was not known after the first range, s.
    pub fn lost_s(&self) -> f64 {
        let lost = self.epochs.windows(2).filter(|pair| pair[0].position.is_none());
        lost.map(|pair| (pair[1].time_us - pair[0].time_us) as f64 * 1e-6).fold(0.0, |a, b| a + b)
    }
}

/// Looks on while a recording is fed.
pub trait Witness {
    /// A range was given to the tracker.
    fn heard(&mut self, row: &RangeRow, reception: Reception);
    /// All ranges of a time were given.
    fn ended(&mut self, tracker: &dyn Follow);
}

/// Nobody.
impl Witness for () {
    fn heard(&mut self, _: &RangeRow, _: Reception) {}
    fn ended(&mut self, _: &dyn Follow) {}
}

/// Feeds ranges and their company; nothing is reordered, and times that go backwards are the tracker's to
/// refuse.
pub fn follow(tracker: &mut dyn Follow, rows: &[RangeRow], company: &Company) -> Followed {
    witnessed(tracker, rows, company, &mut ())
}

/// The same while somebody looks on; [`Witness::ended`] is called once for every epoch of what is returned.
pub fn witnessed(
    tracker: &mut dyn Follow,
    rows: &[RangeRow],
    company: &Company,
    witness: &mut impl Witness,
) -> Followed {
    let firsts = [
        rows.iter().map(|row| row.time_us).min(),
        company.inertial.first().map(|sample| sample.time_us),
        company.wheels.first().map(|sample| sample.time_us),
    ];
    let start_us = firsts.into_iter().flatten().min().unwrap_or_default();
    let since = |time_us: i64| time_us.saturating_sub(start_us).max(0) as u64;
    let (mut inertial, mut wheels) =
        (company.inertial.iter().peekable(), company.wheels.iter().peekable());
    let mut followed = Followed::default();
    let mut latest_us = i64::MIN;
    for epoch in rows.chunk_by(|a, b| a.time_us == b.time_us) {
        let time_us = epoch[0].time_us;
        while let Some(sample) = inertial.next_if(|sample| sample.time_us <= time_us) {
            tracker.inertial(since(sample.time_us), sample);
        }
        while let Some(sample) = wheels.next_if(|sample| sample.time_us <= time_us) {
            tracker.wheels(since(sample.time_us), sample);
        }
        if let Some([height]) = company.height.as_ref().and_then(|course| course.held(time_us)) {
            tracker.set_height(height);
        }
        for row in epoch {
            let Some(range) = row.range else { continue };
            let reception = tracker.range(since(time_us), row.anchor, range);
            witness.heard(row, reception);
            if reception.taken {
                followed.updates += 1;
            } else {
                followed.rejected += 1;
            }
        }
        // What comes late changes the present, not the past.
        if time_us > latest_us {
            latest_us = time_us;
            tracker.end_epoch(since(time_us));
            followed.epochs.push(Epoch { time_us, position: tracker.position() });
            witness.ended(tracker);
        }
    }
    followed
}
