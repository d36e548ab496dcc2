//! More than the track: what became of every range, and how sure the tracker was.

use super::feed::{self, Company, Epoch, Followed, Witness};
use super::follow::{Follow, Reception};
use super::options::Setup;
use super::ranges::RangeRow;
use super::recording::Recording;
use crate::Error;

/// What came out of one part of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// As [`feed::follow`] gives it.
    pub followed: Followed,
    /// Every range that was one, and what became of it.
    pub heard: Vec<(RangeRow, Reception)>,
    /// For each epoch: variance of x, covariance and variance of y, m², from a tracker that knows them.
    pub spreads: Vec<Option<[f64; 3]>>,
}

/// Tracks every part of a recording by itself and keeps what the tracker said.
///
/// # Errors
/// As [`super::follow::build`].
pub fn trace(
    recording: &Recording,
    setup: &Setup,
    build: impl Fn(&Setup) -> Result<Box<dyn Follow>, Error>,
) -> Result<Vec<Trace>, Error> {
    let mut traces = Vec::with_capacity(recording.parts.len());
    for part in &recording.parts {
        let height_m = part.height_m.unwrap_or(setup.height_m);
        let mut tracker = build(&Setup { height_m, ..setup.clone() })?;
        traces.push(of_ranges(tracker.as_mut(), &part.rows, &recording.company));
    }
    Ok(traces)
}

fn of_ranges(tracker: &mut dyn Follow, rows: &[RangeRow], company: &Company) -> Trace {
    let mut seen = Seen::default();
    let followed = feed::witnessed(tracker, rows, company, &mut seen);
    Trace { followed, heard: seen.heard, spreads: seen.spreads }
}

#[derive(Default)]
struct Seen {
    heard: Vec<(RangeRow, Reception)>,
    spreads: Vec<Option<[f64; 3]>>,
}

impl Witness for Seen {
    fn heard(&mut self, row: &RangeRow, reception: Reception) {
        self.heard.push((*row, reception));
    }

    fn ended(&mut self, tracker: &dyn Follow) {
        self.spreads.push(tracker.spread());
    }
}

impl Trace {
    /// Every epoch and how sure the tracker was.
    pub fn epochs(&self) -> impl Iterator<Item = (&Epoch, Option<[f64; 3]>)> {
        self.followed.epochs.iter().zip(self.spreads.iter().copied())
    }
}

/// Standard deviation of a position in the plane, root of its variances' sum, m.
pub fn sigma_m([xx, _, yy]: [f64; 3]) -> f64 {
    (xx + yy).max(0.0).sqrt()
}
