//! Times that step back: of a clock that was set while the log was written, of a line with a wrong time, or of a log that is not in
//! the order of time.

use kestirim_health::Reason;

use crate::Finding;
use crate::robot::Event;

/// The step back that counts, µs: radios report some ranges late, by less. What is ten seconds off has been left out before, and
/// told.
const STEPS_US: std::ops::Range<i64> = 1_000_001..9_900_000;

/// The first step back of the ranges' times.
pub(super) fn find(parts: &[&[Event]]) -> Option<Finding> {
    parts.iter().find_map(|events| {
        let ranges = events.iter().filter(|event| matches!(event, Event::Range(_)));
        let times: Vec<i64> = ranges.map(Event::time_us).collect();
        let is_step =
            |pair: &&[i64]| STEPS_US.contains(&pair[0].saturating_sub(pair[1]));
        let step = times.windows(2).find(is_step)?;
        let seconds = |us: i64| us as f64 * 1e-6;
        let (from, back) = (seconds(step[0]), seconds(step[0].saturating_sub(step[1])));
        Some(Finding::fault(
            "times",
            Reason::Time,
            format!("times of ranges step back by {back:.1} s after {from:.1} s"),
            "until they reach that time again, ranges are rejected or mixed with earlier ones",
            "if the clock was set, split the log there; if a line has a wrong time, remove it; else sort by time",
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::Range;

    #[test]
    fn a_clock_that_was_set_back_is_told() {
        for (back, is_told) in [(0, false), (9, false), (20, true), (100, false)] {
            let event = |k: i64| {
                let time_us = (if k < 50 { k } else { k - back }) * 100_000;
                Event::Range(Range { time_us, anchor: 0, metres: 3.0 })
            };
            let events: Vec<_> = (0..100).map(event).collect();
            assert_eq!(find(&[&events]).is_some(), is_told, "{back}");
        }
    }
}
