//! Ranges to an anchor that jump as no tag moves: another tag's ranges among them, or noise of metres.

use std::collections::BTreeMap;

use kestirim_health::Reason;

use crate::Finding;
use crate::robot::Range;

/// The largest assumed speed of a tag, m/s.
const SPEED: f64 = 3.0;
/// The largest jump that radios and walls cause most of the time, m.
const JUMP_M: f64 = 1.0;
/// The time between ranges beyond which they are not compared, s.
const APART_S: f64 = 2.0;
/// The fewest jumps that are reported, and their smallest share (`SHARE`): one in seventeen outdoors among people is
/// the most that was recorded, and with one wild range in ten, which a tracker leaves out, two in ten jump.
const FEWEST: usize = 20;
const SHARE: f64 = 0.3;

/// Anchors whose ranges jump, if there are any.
pub(super) fn find<'a>(parts: &[Vec<Range>], name: &impl Fn(usize) -> &'a str) -> Option<Finding> {
    let mut counts: BTreeMap<usize, Count> = BTreeMap::new();
    for ranges in parts {
        let mut before: BTreeMap<usize, Before> = BTreeMap::new();
        for range in ranges.iter().filter(|it| it.metres.is_finite() && it.metres > 0.0) {
            let step = before.get(&range.anchor).and_then(|before| before.step_to(range));
            if let Some(is_jump) = step.and_then(|step| step.is_jump) {
                counts.entry(range.anchor).or_default().add(is_jump);
            }
            let rate = step.map(|step| step.rate);
            before.insert(range.anchor, Before { range: *range, rate });
        }
    }
    let jumping: Vec<(usize, f64)> =
        counts.iter().filter_map(|(anchor, count)| Some((*anchor, count.share()?))).collect();
    let &(worst, most) = jumping.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (who, reason) = match (jumping.len() - 1, 2 * jumping.len() > counts.len()) {
        (0, _) => (format!("to {}", name(worst)), Reason::Anchor),
        (more, false) => (format!("to {}, and {more} other anchors,", name(worst)), Reason::Anchor),
        (_, true) => ("to most anchors".to_owned(), Reason::Innovations),
    };
    Some(Finding::fault(
        "jumps",
        reason,
        format!(
            "of the ranges {who} up to {:.0} % jump by a metre more than a tag moves",
            100.0 * most
        ),
        "the standard deviations do not hold",
        "look whether they are of one tag, and at what the radio measures",
    ))
}

/// The last range to an anchor, and its rate of change, m/s, if known.
#[derive(Clone, Copy)]
struct Before {
    range: Range,
    rate: Option<f64>,
}

/// The step from one range to the next: its rate of change, m/s, and whether it is a jump, if the previous rate is
/// known.
#[derive(Clone, Copy)]
struct Step {
    rate: f64,
    is_jump: Option<bool>,
}

impl Before {
    /// The step to the next range. A jump is larger than a tag moves, and differs from its previous motion.
    fn step_to(&self, next: &Range) -> Option<Step> {
        let seconds = (next.time_us - self.range.time_us) as f64 * 1e-6;
        let most = JUMP_M + SPEED * seconds;
        let metres = next.metres - self.range.metres;
        let is_jump =
            self.rate.map(|rate| metres.abs() > most && (metres - rate * seconds).abs() > most);
        (seconds > 0.0 && seconds < APART_S).then_some(Step { rate: metres / seconds, is_jump })
    }
}

/// The number of an anchor's ranges that jump.
#[derive(Default)]
struct Count {
    jumps: usize,
    all: usize,
}

impl Count {
    fn add(&mut self, is_jump: bool) {
        self.jumps += usize::from(is_jump);
        self.all += 1;
    }

    /// The share of jumps, if it is too large.
    fn share(&self) -> Option<f64> {
        let share = self.jumps as f64 / self.all as f64;
        (self.jumps >= FEWEST && share > SHARE).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The finding for ranges to three anchors, 10 Hz each without every third, of a tag that passes at this speed,
    /// m/s; those to one anchor, or to all, are changed.
    fn found(speed: f64, of_all: bool, change: impl Fn(i64, f64) -> f64) -> Option<Finding> {
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
            if of_all || it.anchor == 1 { Range { metres, ..it } } else { it }
        };
        let moments = (0..300).filter(|k| k % 3 != 1 && !(120..150).contains(k));
        find(&[moments.flat_map(ranges).map(change).collect()], &|anchor| ["A", "B", "C"][anchor])
    }

    #[test]
    fn another_tags_ranges_are_told_and_a_fast_tag_is_not() {
        assert_eq!(found(1.0, false, |_, metres| metres), None);
        assert_eq!(found(30.0, false, |_, metres| metres), None, "a car");
        let later = |k, metres| if k > 100 { metres + 2.0 } else { metres };
        assert_eq!(found(1.0, false, later), None);
        let mix = |k, metres| if k % 2 == 0 { 20.0 } else { metres };
        let mixed = found(1.0, false, mix).expect("every second jumps");
        assert_eq!(mixed.reason, Some(Reason::Anchor));
        assert!(mixed.found.contains("to B up to"), "{mixed:?}");
        let all = found(1.0, true, mix).expect("all of them");
        assert_eq!(all.reason, Some(Reason::Innovations));
    }
}
