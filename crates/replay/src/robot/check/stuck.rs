//! Ranges that stay the same to the last digit: those of one anchor, or of a hub or a logger that repeats the last
//! ones.

use std::collections::{BTreeMap, BTreeSet};

use kestirim_health::Reason;

use crate::Finding;
use crate::metrics::standard_deviation;
use crate::robot::Range;

/// The time for which a stuck range stays the same to the last digit, s; it must also do so `STUCK` times.
const STUCK_S: f64 = 3.0;
const STUCK: usize = 15;
/// The standard deviation of the other ranges meanwhile above which the tag moves, m.
pub(super) const MOVING_M: f64 = 0.3;

/// A hub does not repeat if more than one in this many ranges equals the previous one at other times, too: centimetres
/// repeat in one of ten.
const COARSE: usize = 2;

/// A finding about an anchor whose range stays constant while those of others change.
pub(super) fn one<'a>(
    ranges: &[Range],
    cut_at: Option<f64>,
    name: &impl Fn(usize) -> &'a str,
) -> Option<Finding> {
    runs(ranges).into_iter().find_map(|run| {
        let Run { anchor, metres, count, first, last } = run;
        let seconds = (ranges[last].time_us - ranges[first].time_us) as f64 * 1e-6;
        if count < STUCK || seconds < STUCK_S || Some(metres) == cut_at {
            return None;
        }
        let mut others: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let during = ranges[first..=last].iter();
        for other in during.filter(|it| it.anchor != anchor && it.metres.is_finite()) {
            others.entry(other.anchor).or_default().push(other.metres);
        }
        let moving = others.values().filter(|its| standard_deviation(its) > MOVING_M).count();
        (moving >= 2).then(|| {
            let name = name(anchor);
            Finding::fault(
                "stuck",
                Reason::Stuck,
                format!(
                    "the range to {name} stays at {metres:.3} m for {seconds:.1} s while others change"
                ),
                "the position is drawn to a circle that is not there",
                "look at what the anchor or the logger repeats",
            )
        })
    })
}

/// A run of equal ranges to an anchor.
struct Run {
    anchor: usize,
    metres: f64,
    count: usize,
    /// The index of the first and of the last range in the log.
    first: usize,
    last: usize,
}

/// The runs of each anchor, in the order in which they end, found in one pass however long they are.
fn runs(ranges: &[Range]) -> Vec<Run> {
    let mut going: BTreeMap<usize, Run> = BTreeMap::new();
    let mut runs = Vec::new();
    for (i, range) in ranges.iter().enumerate() {
        let Range { anchor, metres, .. } = *range;
        match going.get_mut(&anchor) {
            Some(run) if run.metres == metres => (run.count, run.last) = (run.count + 1, i),
            _ => {
                let run = Run { anchor, metres, count: 1, first: i, last: i };
                runs.extend(going.insert(anchor, run));
            }
        }
    }
    runs.extend(going.into_values());
    runs
}

/// A finding if all ranges stay constant for longer than the noise of radios permits: what was measured meanwhile is
/// unknown.
pub(super) fn all(ranges: &[Range], cut_at: Option<f64>) -> Option<Finding> {
    let mut before = BTreeMap::new();
    let (mut begun_us, mut count, mut heard) = (0, 0, BTreeSet::new());
    let (mut longest_us, mut in_it, mut repeats, mut all) = (0, 0, 0, 0);
    for range in ranges.iter().filter(|it| it.metres.is_finite() && Some(it.metres) != cut_at) {
        all += 1;
        if before.insert(range.anchor, range.metres) != Some(range.metres) {
            (begun_us, count) = (range.time_us, 0);
            heard.clear();
            continue;
        }
        (count, repeats) = (count + 1, repeats + 1);
        heard.insert(range.anchor);
        if count >= STUCK && heard.len() >= 2 && range.time_us - begun_us > longest_us {
            (longest_us, in_it) = (range.time_us - begun_us, count);
        }
    }
    // If ranges repeat at other times, too, their last digit is coarser than their noise.
    if COARSE * (repeats - in_it) > all - in_it {
        return None;
    }
    let seconds = longest_us as f64 * 1e-6;
    (seconds >= STUCK_S).then(|| {
        Finding::fault(
            "stuck",
            Reason::Stuck,
            format!("all ranges that come stay the same to the last digit for {seconds:.1} s"),
            "the positions meanwhile are those of before",
            "look at what the hub or the logger repeats",
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranges to two anchors, 10 Hz each, which stay for a while.
    fn ranges(stays: std::ops::Range<i64>, step: f64) -> Vec<Range> {
        let range = |k: i64| {
            let moved = if stays.contains(&k) { stays.start } else { k };
            let metres = 3.0 + ((0.037 * moved as f64) / step).round() * step;
            [0, 1].map(|anchor| Range { time_us: 100_000 * k, anchor, metres })
        };
        (0..200).flat_map(range).collect()
    }

    #[test]
    fn a_hub_that_repeats_is_told_and_a_coarse_digit_is_not() {
        assert!(all(&ranges(100..125, 0.001), None).is_none(), "for two and a half seconds");
        let found = all(&ranges(100..140, 0.001), None).expect("a finding");
        assert!(found.found.contains("for 3.9 s"), "{found:?}");
        assert!(all(&ranges(100..140, 0.1), None).is_none(), "decimetres");
    }
}
