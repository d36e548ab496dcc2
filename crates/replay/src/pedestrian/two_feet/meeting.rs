//! Meetings: times at which two sensors of one walk are at one place.

use super::super::{Stride, Walk, position_at};
use crate::metrics::distance;

/// The distance from its footprint within which a foot stands there, m.
const STANDING: f64 = 0.1;

/// A time at which both are at one place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    pub(super) time_us: u64,
    /// Twice the index of each foot's footprint, counted from the start, plus one for a foot that is half way to the
    /// next.
    pub(super) own: usize,
    pub(super) other: usize,
}

impl Meeting {
    /// Whether neither foot moves.
    pub(super) fn is_at_rest(&self) -> bool {
        self.own.is_multiple_of(2) && self.other.is_multiple_of(2)
    }

    /// All meetings in the order of time: of two feet that pass each other, or, if that is rare, of two sensors that
    /// stand at the same time.
    pub(super) fn all(own: &Walk, other: &Walk) -> Vec<Self> {
        let passes = passings(own, other).into_iter().map(|(time_us, moves, stands)| Self {
            time_us,
            own: 2 * moves + 1,
            other: 2 * stands,
        });
        let is_passed = passings(other, own).into_iter().map(|(time_us, moves, stands)| Self {
            time_us,
            own: 2 * stands,
            other: 2 * moves + 1,
        });
        let mut all: Vec<_> = passes.chain(is_passed).collect();
        // Two feet pass each other once for each stride of either.
        let common = own.strides.iter().filter(|stride| is_in(other, stride.time_us)).count();
        if all.len() < common {
            let stand = |(index, stride): (usize, &Stride)| {
                let other = 2 * footprint_at(other, stride.time_us)?;
                Some(Self { time_us: stride.time_us, own: 2 * (index + 1), other })
            };
            all = own.strides.iter().enumerate().filter_map(stand).collect();
        }
        all.sort_by_key(|meeting| meeting.time_us);
        all
    }
}

fn is_in(walk: &Walk, time_us: u64) -> bool {
    let ends = walk.track.first().zip(walk.track.last());
    ends.is_some_and(|(first, last)| (first.time_us..=last.time_us).contains(&time_us))
}

/// The position of a footprint in the plane, m.
fn footprint(walk: &Walk, index: usize) -> [f64; 2] {
    let before = index.checked_sub(1).and_then(|last| walk.strides.get(last));
    let [x, y, _] = before.map_or(walk.start(), |stride| stride.position);
    [x, y]
}

/// The footprint on which a foot stands at a time, if it does.
fn footprint_at(walk: &Walk, time_us: u64) -> Option<usize> {
    let [x, y, _] = position_at(&walk.track, time_us).filter(|_| is_in(walk, time_us))?;
    let left = walk.strides.partition_point(|stride| stride.time_us < time_us);
    let near = |it: &usize| distance([x, y], footprint(walk, *it)) < STANDING;
    [left, left + 1].into_iter().filter(|it| *it <= walk.strides.len()).find(near)
}

/// The times at which a foot passes the other, half way through a stride, with the indices of the footprint that it
/// leaves, and of the one on which the other stands.
fn passings(moving: &Walk, standing: &Walk) -> Vec<(u64, usize, usize)> {
    let mut found = Vec::new();
    let mut rest = moving.track.as_slice();
    for (index, stride) in moving.strides.iter().enumerate() {
        let (during, after) =
            rest.split_at(rest.partition_point(|point| point.time_us <= stride.time_us));
        rest = after;
        let from = footprint(moving, index);
        let half = 0.5 * distance(from, footprint(moving, index + 1));
        let passes = during.iter().find(|at| distance(from, at.horizontal()) >= half);
        found.extend(passes.and_then(|at| {
            let beside = footprint_at(standing, at.time_us)?;
            Some((at.time_us, index, beside))
        }));
    }
    found
}
