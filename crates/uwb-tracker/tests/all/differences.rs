//! A tag that only listens: pairs of anchors in any order, obstacles, and refused input.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{
    Anchor, Config, DifferenceSample, DifferenceTracker, Error, Outcome, State,
};
use nalgebra::SVector;
use proptest::prelude::*;

const CORNERS: [[f64; 3]; 6] = [
    [0.0, 0.0, 2.0],
    [8.0, 0.0, 2.5],
    [8.0, 6.0, 2.0],
    [0.0, 6.0, 2.5],
    [4.0, 6.5, 2.0],
    [4.0, -0.5, 2.5],
];

type Listener<T> = DifferenceTracker<T, 2, 5, 8>;

fn listener<T: Scalar>(bias: f64) -> Listener<T> {
    let anchors = CORNERS.map(|place| Anchor {
        position: SVector::from(place.map(T::from_f64)),
        bias: T::from_f64(bias * place[0]),
    });
    DifferenceTracker::new(Config::calibrated(T::ONE), &anchors).unwrap()
}

fn distance(anchor: usize, [x, y]: [f64; 2]) -> f64 {
    let [ax, ay, az] = CORNERS[anchor];
    (x - ax).hypot(y - ay).hypot(1.0 - az)
}

/// Position of the tag at a time, s.
fn place(seconds: f64) -> [f64; 2] {
    [4.0 + 2.0 * (0.2 * seconds).sin(), 3.0 + 1.5 * (0.2 * seconds).cos()]
}

/// Pairs of anchors: each after the one before, all against the first, or at random.
fn pairs(form: &str, k: usize) -> [usize; 2] {
    match form {
        "ring" => [k % 6, (k + 1) % 6],
        "star" => [0, 1 + k % 5],
        _ => [(k * 7) % 6, (k * 7 + 1 + (k * 11 / 3) % 5) % 6],
    }
}

/// Uncorrelated errors of up to ± 7 cm.
fn noise(k: usize) -> f64 {
    ((k * 7919) % 101) as f64 / 100.0 * 0.14 - 0.07
}

/// Tracks the tag for 20 s at 100 differences per second; returns the largest error after five, m.
fn followed<T: Scalar>(form: &str, excess: impl Fn(usize, usize) -> f64) -> f64 {
    let mut tracker = listener::<T>(0.0);
    let mut worst = 0.0_f64;
    for k in 0..2000 {
        let seconds = k as f64 * 0.01;
        let anchors = pairs(form, k);
        let tag = place(seconds);
        let [one, other] = anchors.map(|anchor| distance(anchor, tag) + excess(anchor, k));
        let difference = T::from_f64(other - one + noise(k + 1) - noise(k));
        let time_us = k as u64 * 10_000;
        tracker.difference(&DifferenceSample { time_us, anchors, difference }).unwrap();
        if seconds > 5.0 {
            let found = tracker.position().expect("a position");
            let error = (found[0].to_f64() - tag[0]).hypot(found[1].to_f64() - tag[1]);
            worst = worst.max(error);
        }
    }
    assert_eq!(tracker.health(20_000_000).state, State::Tracking);
    worst
}

#[test]
fn pairs_of_any_order_are_followed() {
    for form in ["ring", "star", "any"] {
        for (name, worst) in [
            ("f64", followed::<f64>(form, |_, _| 0.0)),
            ("f32", followed::<f32>(form, |_, _| 0.0)),
            ("Q12.20", followed::<Q12_20>(form, |_, _| 0.0)),
        ] {
            println!("{form} {name}: {worst:.3} m");
            assert!(worst < 0.15, "{form} {name}: {worst} m");
        }
    }
}

#[test]
fn an_obstacle_before_one_anchor_moves_the_position_little() {
    // From the eighth to the twelfth second anchor 2 is received by way of a wall, 3 m late.
    let late = |anchor: usize, k: usize| {
        if anchor == 2 && (800..1200).contains(&k) { 3.0 } else { 0.0 }
    };
    let worst = followed::<f32>("ring", late);
    assert!(worst < 0.2, "{worst} m");
}

#[test]
fn biases_of_anchors_come_off() {
    let mut tracker = listener::<f64>(0.05);
    for k in 0..600 {
        let anchors = pairs("ring", k);
        let [one, other] =
            anchors.map(|anchor| distance(anchor, [3.0, 2.0]) + 0.05 * CORNERS[anchor][0]);
        let difference = other - one;
        let time_us = k as u64 * 10_000;
        tracker.difference(&DifferenceSample { time_us, anchors, difference }).unwrap();
    }
    let found = tracker.position().unwrap();
    assert!((found[0] - 3.0).hypot(found[1] - 2.0) < 0.01, "{found}");
}

#[test]
fn too_few_anchors_make_no_position() {
    // Three anchors in the plane: two differences, which allow two positions.
    let mut tracker = listener::<f64>(0.0);
    for k in 0..500 {
        let anchors = [k % 3, (k + 1) % 3];
        let [one, other] = anchors.map(|anchor| distance(anchor, [3.0, 2.0]));
        let time_us = k as u64 * 10_000;
        let sample = DifferenceSample { time_us, anchors, difference: other - one };
        assert_eq!(tracker.difference(&sample).unwrap().outcome, Outcome::Collected);
    }
    assert!(tracker.position().is_none());
}

#[test]
fn arrivals_before_a_new_clock_belong_to_none() {
    let mut tracker = listener::<f64>(0.0);
    let mut take = |time_us, anchors: [usize; 2]| {
        let [one, other] = anchors.map(|anchor| distance(anchor, [3.0, 2.0]));
        // The clocks differ by more with each message.
        let sample = DifferenceSample { time_us, anchors, difference: other - one + 0.005 };
        tracker.difference(&sample).unwrap().outcome
    };
    for k in 0..1000 {
        take(k as u64 * 10_000, pairs("ring", k));
    }
    // Anchor 4 was the last, and is 5 m late by the first clock; the next difference begins with another one.
    for (time_us, anchors) in [(9_995_000, [1, 2]), (10_000_000, [4, 3]), (10_005_000, [3, 5])] {
        assert_ne!(take(time_us, anchors), Outcome::Rejected, "{anchors:?}");
    }
}

#[test]
fn a_batch_may_name_its_reference_last() {
    let track = |is_last: bool| {
        let mut tracker = listener::<f64>(0.0);
        for k in 0..100 {
            let of = |other: usize| {
                let difference = distance(other, [3.0, 2.0]) - distance(0, [3.0, 2.0]);
                if is_last { ([other, 0], -difference) } else { ([0, other], difference) }
            };
            for (anchors, difference) in [1, 2, 3, 4].map(of) {
                let sample = DifferenceSample { time_us: 100_000 * k, anchors, difference };
                tracker.difference(&sample).unwrap();
            }
        }
        tracker.position().unwrap()
    };
    let (first, last) = (track(false), track(true));
    assert!((first[0] - 3.0).hypot(first[1] - 2.0) < 0.05, "{first}");
    assert!((last[0] - 3.0).hypot(last[1] - 2.0) < 0.05, "{last}");
}

#[test]
fn a_repeated_batch_counts_once() {
    let mut tracker = listener::<f64>(0.0);
    let batch = [1, 2, 3].map(|other| DifferenceSample {
        time_us: 1_000_000,
        anchors: [0, other],
        difference: distance(other, [3.0, 2.0]) - distance(0, [3.0, 2.0]),
    });
    for sample in &batch {
        tracker.difference(sample).unwrap();
    }
    for sample in &batch {
        assert_eq!(tracker.difference(sample), Err(Error::Duplicate));
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let mut tracker = listener::<f64>(0.0);
    let sample = |time_us, anchors, difference| DifferenceSample { time_us, anchors, difference };
    tracker.difference(&sample(1_000_000, [0, 1], 0.5)).unwrap();
    for (wrong, error) in [
        (sample(1_000_000, [0, 1], 0.5), Error::Duplicate),
        (sample(1_000_000, [1, 1], 0.5), Error::NoSuchAnchor),
        (sample(1_000_000, [0, 6], 0.5), Error::NoSuchAnchor),
        (sample(1_010_000, [1, 2], f64::NAN), Error::NotFinite),
        (sample(1_010_000, [1, 2], 300.0), Error::ImplausibleRange),
        (sample(800_000, [1, 2], 0.5), Error::OutOfOrder),
    ] {
        assert_eq!(tracker.difference(&wrong), Err(error), "{wrong:?}");
    }
}

proptest! {
    #[test]
    fn anything_leaves_a_tracker_that_goes_on(
        samples in prop::collection::vec((0_u64..3_000_000, 0_usize..7, 0_usize..7, -300.0..300.0), 0..60),
    ) {
        let mut tracker = listener::<f32>(0.0);
        let mut now_us = 0;
        for (step_us, one, other, difference) in samples {
            now_us += step_us;
            let anchors = [one, other];
            let sample = DifferenceSample { time_us: now_us, anchors, difference: difference as f32 };
            let before = format!("{tracker:?}");
            if tracker.difference(&sample).is_err() {
                prop_assert_eq!(before, format!("{tracker:?}"));
            }
        }
        // After a second of true ones it is located.
        for k in 0..3000 {
            let anchors = pairs("ring", k);
            let [one, other] = anchors.map(|anchor| distance(anchor, [3.0, 2.0]));
            let time_us = now_us + 200_000 + k as u64 * 10_000;
            let sample = DifferenceSample { time_us, anchors, difference: (other - one) as f32 };
            let _ = tracker.difference(&sample);
        }
        let found = tracker.position();
        prop_assert!(found.is_some_and(|at| (at[0] - 3.0).hypot(at[1] - 2.0) < 0.3), "{found:?}");
    }
}
