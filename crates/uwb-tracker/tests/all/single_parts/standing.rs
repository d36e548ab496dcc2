//! A tag that is said to stand still.

use super::{NOW_US, Plane, following, hear, on_the_way, wheels};
use kestirim_uwb_tracker::Config;

#[test]
fn a_standstill_that_ranges_contradict_is_doubted_for_half_a_minute() {
    let mut tracker = following(Config::calibrated(1.0));
    let mut time_us = NOW_US;
    // It stands, …
    let place = on_the_way(NOW_US);
    let mut on = |tracker: &mut Plane, seconds: u64, tag: &dyn Fn(u64) -> [f64; 3]| {
        let begin_us = time_us;
        while time_us < begin_us + 1_000_000 * seconds {
            time_us += 100_000;
            tracker.odometry(&wheels(time_us, 0.0, 0.0)).expect("wheels");
            hear(tracker, time_us, tag(time_us - begin_us));
        }
        tracker.health(time_us).still
    };
    assert!(on(&mut tracker, 20, &|_| place));
    let sure = tracker.estimate().expect("a position").covariance.variances()[2];
    // … is pushed along with its wheels locked …
    assert!(!on(&mut tracker, 2, &|later_us| [place[0] + later_us as f64 * 5e-7, 2.0, 1.0]));
    let unsure = tracker.estimate().expect("a position").covariance.variances()[2];
    assert!(unsure > 10.0 * sure, "{unsure} {sure}");
    let error = tracker.position().expect("a position").x - (place[0] + 1.0);
    assert!(error.abs() < 0.2, "{error}");
    // … and stands again.
    let there = [place[0] + 1.0, 2.0, 1.0];
    assert!(!on(&mut tracker, 27, &|_| there));
    assert!(on(&mut tracker, 4, &|_| there));
}
