//! Moments: ranges to several anchors at the same time.

use std::collections::BTreeMap;

use crate::robot::Range;

/// The number of moments that are used, spread over the recording.
const MOMENTS: usize = 80;
/// The time within which ranges form a moment, µs: a robot moves 10 cm meanwhile.
const WINDOW_US: i64 = 200_000;
/// The longest gap over which ranges are interpolated, µs, for radios that are slower or take turns.
const GAP_US: i64 = 1_500_000;

/// The ranges of a moment: one per anchor.
pub(super) type Moment = Vec<(usize, f64)>;

/// Moments at which several anchors were heard, spread over the recording.
pub(super) fn at_once(parts: &[Vec<Range>]) -> Vec<Moment> {
    let mut all = Vec::new();
    for ranges in parts {
        let mut begin = 0;
        for i in 1..=ranges.len() {
            let is_over =
                i == ranges.len() || ranges[i].time_us - ranges[begin].time_us > WINDOW_US;
            if is_over {
                all.push(moment(&ranges[begin..i]));
                begin = i;
            }
        }
    }
    spread(all)
}

/// Ranges of all anchors at the times at which one is measured, interpolated linearly between those before and after.
pub(super) fn interpolated(parts: &[Vec<Range>]) -> Vec<Moment> {
    let mut all = Vec::new();
    for ranges in parts {
        let mut of_anchors: BTreeMap<usize, Vec<Range>> = BTreeMap::new();
        for range in ranges.iter().filter(|it| it.metres.is_finite() && it.metres > 0.0) {
            of_anchors.entry(range.anchor).or_default().push(*range);
        }
        // More moments than are needed, as some will not be usable.
        let every = (ranges.len() / (8 * MOMENTS)).max(1);
        all.extend(ranges.iter().step_by(every).map(|now| {
            let at = |ranges: &Vec<Range>| between(ranges, now.time_us);
            of_anchors.iter().filter_map(|(anchor, ranges)| Some((*anchor, at(ranges)?))).collect()
        }));
    }
    spread(all)
}

/// The range of one anchor, interpolated at a time.
fn between(ranges: &[Range], time_us: i64) -> Option<f64> {
    let after = ranges.partition_point(|range| range.time_us < time_us);
    let next = ranges.get(after)?;
    if next.time_us == time_us {
        return Some(next.metres);
    }
    let before = ranges.get(after.checked_sub(1)?)?;
    let gap_us = next.time_us - before.time_us;
    if gap_us > GAP_US {
        return None;
    }
    let share = (time_us - before.time_us) as f64 / gap_us as f64;
    Some(before.metres + (next.metres - before.metres) * share)
}

/// The moments that can contradict themselves, thinned to the number that is needed.
fn spread(mut all: Vec<Moment>) -> Vec<Moment> {
    all.retain(|moment| moment.len() >= 3);
    let every = (all.len() / MOMENTS).max(1);
    all.into_iter().step_by(every).collect()
}

/// The last range of each anchor.
fn moment(ranges: &[Range]) -> Moment {
    let mut moment: Moment = Vec::new();
    for range in ranges.iter().rev() {
        let is_new = moment.iter().all(|(anchor, _)| *anchor != range.anchor);
        if is_new && range.metres.is_finite() && range.metres > 0.0 {
            moment.push((range.anchor, range.metres));
        }
    }
    moment
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radios_that_take_turns_are_interpolated() {
        // Four anchors, one after the other every 0.3 s; the ranges to all grow by a metre a second.
        let range = |k: i64| Range {
            time_us: 300_000 * k,
            anchor: (k % 4) as usize,
            metres: 3.0 + 0.3 * k as f64,
        };
        let part = [(0..40).map(range).collect()];
        assert!(at_once(&part).is_empty());
        let moments = interpolated(&part);
        assert!(moments.len() > 30 && moments.iter().any(|moment| moment.len() == 4));
        for moment in moments {
            let (_, first) = moment[0];
            assert!(moment.iter().all(|(_, metres)| (metres - first).abs() < 1e-9), "{moment:?}");
        }
    }

    #[test]
    fn a_gap_is_not_bridged() {
        let ranges = [0, 2_000_000].map(|time_us| Range { time_us, anchor: 0, metres: 1.0 });
        assert_eq!(between(&ranges, 1_000_000), None);
        assert_eq!(between(&ranges, 2_000_000), Some(1.0));
    }
}
