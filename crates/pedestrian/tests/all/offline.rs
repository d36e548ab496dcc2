//! Tests of what a recording shows that a stream does not show yet.

use crate::common::Foot;
use kestirim_pedestrian::{Config, Ekf, ImuSample, Lite, OfflineTracker};
use nalgebra::Vector3;

/// The stances found by the offline tracker for a sensor that turns about the vertical at each rate (rad/s) for a
/// duration (s).
fn stances_offline(turns: &[(f64, f64)]) -> Vec<(f64, bool)> {
    let mut samples = Vec::new();
    for &(rate, duration) in turns {
        for _ in 0..(duration / 0.011) as u64 {
            samples.push(ImuSample {
                time_us: 11_000 * samples.len() as u64,
                specific_force: Vector3::new(0.0, 0.0, 9.80665),
                angular_rate: Vector3::new(0.0, 0.0, rate),
            });
        }
    }
    let mut memory = vec![0.0; samples.len()];
    let tracker = OfflineTracker::<f64, Lite<f64>>::new(Config::default(), &samples, &mut memory);
    let seconds = |time_us: u64| time_us as f64 * 1e-6;
    tracker.unwrap().map(|estimate| (seconds(estimate.time_us), estimate.stance)).collect()
}

#[test]
fn looking_ahead_a_stance_is_what_is_calmest_within_more_than_half_a_second() {
    // Squared rates of 1, for 5 s, then of 1.4² and of 0.
    let stances = stances_offline(&[(1.0, 5.0), (1.4, 5.0), (0.0, 5.0)]);
    for (begin, end, stands) in [
        (0.1, 4.9, true),
        (5.1, 5.5, false),
        (5.8, 9.3, true),
        (9.5, 9.9, false),
        (10.1, 15.0, true),
    ] {
        let within = stances.iter().filter(|(time, _)| (begin..end).contains(time));
        for (time, stance) in within {
            assert_eq!(*stance, stands, "{time}");
        }
    }
}

#[test]
fn looking_ahead_warns_of_the_same() {
    let mut samples = Foot::default().samples::<f64>();
    samples.retain(|s| !(4_000_000..4_150_000).contains(&s.time_us));
    let mut memory = vec![0.0; samples.len()];
    let mut tracker =
        OfflineTracker::<f64, Ekf<f64>>::new(Config::default(), &samples, &mut memory).unwrap();
    assert!(!tracker.warnings().gaps, "not yet");
    tracker.by_ref().for_each(drop);
    assert!(tracker.warnings().gaps);
}
