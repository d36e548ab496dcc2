//! Checks that IMU and wheels were read while ranges were measured.

use kestirim_health::Reason;

use crate::Finding;
use crate::robot::Event;

/// The share of the time with ranges below which a sensor that is read in it has another clock, or stopped.
const SHARE: f64 = 0.2;

/// The first sensor that has hardly any time in common with the ranges.
pub(super) fn find(parts: &[&[Event]]) -> Option<Finding> {
    parts.iter().find_map(|events| {
        let ranging = span(events, |event| matches!(event, Event::Range(_)))?;
        let of_sensor = |name: &'static str, is: fn(&Event) -> bool| {
            let [begin, end] = span(events, is)?;
            let common = end.min(ranging[1]).saturating_sub(begin.max(ranging[0])).max(0);
            let seconds = |us: i64| us as f64 * 1e-6;
            let all = ranging[1].saturating_sub(ranging[0]);
            ((common as f64) < SHARE * all as f64).then(|| {
                Finding::fault(
                    "times",
                    Reason::Time,
                    format!(
                        "{name} and ranges have {:.1} of {:.1} s in common",
                        seconds(common),
                        seconds(all)
                    ),
                    "for most of the track it tells nothing",
                    "look whether both logs have one clock, and whether one ends early",
                )
            })
        };
        of_sensor("the IMU", |event| matches!(event, Event::Inertial(_)))
            .or_else(|| of_sensor("the wheels", |event| matches!(event, Event::Wheels(_))))
    })
}

/// The first and the last time of some events, µs.
fn span(events: &[Event], is: impl Fn(&Event) -> bool) -> Option<[i64; 2]> {
    let times = || events.iter().filter(|event| is(event)).map(Event::time_us);
    Some([times().min()?, times().max()?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::{Range, Wheels};

    fn told(after_s: i64) -> bool {
        let range = |k: i64| Event::Range(Range { time_us: k * 100_000, anchor: 0, metres: 3.0 });
        let wheels = |k: i64| {
            let time_us = (k + 10 * after_s) * 100_000;
            Event::Wheels(Wheels { time_us, speed: 1.0, turn_rate: 0.0 })
        };
        let events: Vec<_> = (0..100).map(range).chain((0..100).map(wheels)).collect();
        find(&[&events]).is_some_and(|it| it.reason == Some(Reason::Time))
    }

    #[test]
    fn another_clock_is_told() {
        assert!(!told(0) && !told(7));
        assert!(told(9) && told(-1_000) && told(1_000_000));
    }
}
