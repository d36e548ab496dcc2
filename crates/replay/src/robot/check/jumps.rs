//! Ranges to an anchor that jump from one to the next as no tag does: another tag's among them, or noise of metres.

use std::collections::BTreeMap;

use kestirim_health::Reason;

use crate::Finding;
use crate::robot::Range;

/// A tag is taken to move by no more than this, m/s …
const SPEED: f64 = 3.0;
/// … and what radios and walls do to ranges is to jump by less, m, most of the time.
const JUMP_M: f64 = 1.0;
/// Ranges that are farther apart tell nothing, s.
const APART_S: f64 = 2.0;
/// So many must have jumped, and so large a share: one in seventeen outdoors among people is the most that was recorded.
const FEWEST: usize = 20;
const SHARE: f64 = 0.2;

/// Anchors whose ranges jump, if there are any.
pub(super) fn find<'a>(parts: &[Vec<Range>], name: &impl Fn(usize) -> &'a str) -> Option<Finding> {
    let mut counts: BTreeMap<usize, Count> = BTreeMap::new();
    for ranges in parts {
        let mut before: BTreeMap<usize, Before> = BTreeMap::new();
        for range in ranges.iter().filter(|it| it.metres.is_finite() && it.metres > 0.0) {
            let step = before.get(&range.anchor).and_then(|before| before.step_to(range));
            if let Some(step) = step {
                counts.entry(range.anchor).or_default().add(&step);
            }
            let step = step.map_or(0.0, |step| step.metres);
            before.insert(range.anchor, Before { range: *range, step });
        }
    }
    let jumping: Vec<(usize, f64)> =
        counts.iter().filter_map(|(anchor, count)| Some((*anchor, count.share()?))).collect();
    let most = jumping.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    let (&(first, _), others) = jumping.split_first()?;
    let (who, reason) = match (others.len(), 2 * jumping.len() > counts.len()) {
        (0, _) => (format!("to {}", name(first)), Reason::Anchor),
        (more, false) => (format!("to {} and {more} more", name(first)), Reason::Anchor),
        (_, true) => ("to most anchors".to_owned(), Reason::Innovations),
    };
    Some(Finding::fault(
        "jumps",
        reason,
        format!("of the ranges {who} {:.0} % jump by more than a metre", 100.0 * most),
        "the standard deviations do not hold",
        "look whether they are of one tag, and at what the radio measures",
    ))
}

/// The last range to an anchor, and how far it was from the one before, m.
#[derive(Clone, Copy)]
struct Before {
    range: Range,
    step: f64,
}

/// From one range to the next.
#[derive(Clone, Copy)]
struct Step {
    metres: f64,
    is_jump: bool,
}

impl Before {
    /// A jump is more than a tag moves, and other than it moved before.
    fn step_to(&self, next: &Range) -> Option<Step> {
        let seconds = (next.time_us - self.range.time_us) as f64 * 1e-6;
        let most = JUMP_M + SPEED * seconds;
        let metres = next.metres - self.range.metres;
        let is_jump = metres.abs() > most && (metres - self.step).abs() > most;
        (seconds > 0.0 && seconds < APART_S).then_some(Step { metres, is_jump })
    }
}

/// How many of an anchor's ranges jump.
#[derive(Default)]
struct Count {
    jumps: usize,
    all: usize,
}

impl Count {
    fn add(&mut self, step: &Step) {
        self.jumps += usize::from(step.is_jump);
        self.all += 1;
    }

    /// Their share, if it is too large.
    fn share(&self) -> Option<f64> {
        let share = self.jumps as f64 / self.all as f64;
        (self.jumps >= FEWEST && share > SHARE).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranges to three anchors, 10 Hz each, of a tag that goes by at this speed, m/s; those to one of them are changed.
    fn found(speed: f64, change: impl Fn(i64, f64) -> f64) -> Option<Finding> {
        let ranges = |k: i64| {
            let x = 0.1 * speed * (k - 100) as f64;
            [3.0, 4.0, 5.0].into_iter().enumerate().map(move |(anchor, y)| Range {
                time_us: 100_000 * k,
                anchor,
                metres: x.hypot(y),
            })
        };
        let change = |it: Range| {
            let metres = change(it.time_us / 100_000, it.metres);
            if it.anchor == 1 { Range { metres, ..it } } else { it }
        };
        find(&[(0..200).flat_map(ranges).map(change).collect()], &|anchor| ["A", "B", "C"][anchor])
    }

    #[test]
    fn another_tags_ranges_are_told_and_a_fast_tag_is_not() {
        assert_eq!(found(1.0, |_, metres| metres), None);
        assert_eq!(found(30.0, |_, metres| metres), None, "a car");
        assert_eq!(found(1.0, |k, metres| if k > 100 { metres + 2.0 } else { metres }), None);
        let mixed = found(1.0, |k, metres| if k % 3 == 0 { 20.0 } else { metres });
        let mixed = mixed.expect("two in three jump");
        assert_eq!(mixed.reason, Some(Reason::Anchor));
        assert!(mixed.found.contains("to B 6"), "{mixed:?}");
    }
}
