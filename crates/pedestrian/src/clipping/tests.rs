//! Tests with plateaus that are ends of a range, and with others that are not.

extern crate std;

use super::*;
use nalgebra::Vector3;
use std::vec::Vec;

/// A swing as measured by a clipped gyroscope: it rises evenly from sample to sample, stays, and falls.
#[derive(Clone, Copy)]
struct Swing {
    axis: usize,
    sign: f64,
    level: f64,
    rising: f64,
    falling: f64,
    plateau: usize,
    /// The sampling interval (s).
    interval: f64,
}

const SHARP: Swing = Swing {
    axis: 1,
    sign: 1.0,
    level: 10.0,
    rising: 4.0,
    falling: 4.0,
    plateau: 4,
    interval: 0.005,
};

impl Swing {
    fn rates(self) -> impl Iterator<Item = f64> {
        let side = |by: f64| [2.5, 1.5, 0.5].map(|steps| self.level - by * steps);
        let fall = side(self.falling).into_iter().rev();
        let plateau = core::iter::repeat_n(self.level, self.plateau);
        side(self.rising).into_iter().chain(plateau).chain(fall).chain([0.0; 3])
    }

    /// The area under the cubic that begins and ends with these slopes.
    fn angle(self) -> f64 {
        let duration = self.plateau as f64 * self.interval;
        (self.rising + self.falling) / self.interval * duration * duration / 12.0
    }
}

struct Stream {
    clipping: Clipping<f64>,
    missed: Vec<MissedTurn<f64>>,
}

impl Stream {
    fn new() -> Self {
        Self { clipping: Clipping::new(), missed: Vec::new() }
    }

    fn step(&mut self, rate: Vector3<f64>, interval: f64, pushed: Vector3<f64>) {
        let large = rate.amax() >= ImuSample::<f64>::LARGE_RATE;
        if self.clipping.concerns(&rate, large) {
            let step = Turned { rate: &rate, interval, pushed };
            self.clipping.show(&step, |missed| self.missed.push(*missed));
        }
        self.clipping.remember(&rate);
    }

    /// The number of missed turns that were found in a swing.
    fn swing(&mut self, swing: Swing) -> usize {
        let before = self.missed.len();
        for rate in swing.rates() {
            let mut vector = Vector3::new(0.1, 0.1, 0.1);
            vector[swing.axis] = rate * swing.sign;
            self.step(vector, swing.interval, Vector3::zeros());
        }
        self.missed.len() - before
    }

    fn swings<const K: usize>(&mut self, swing: Swing) -> [usize; K] {
        core::array::from_fn(|_| self.swing(swing))
    }
}

/// The first of six swings in which a missed turn is found.
fn told_from(swing: Swing) -> Option<usize> {
    let missed = Stream::new().swings::<6>(swing);
    let first = missed.iter().position(|&missed| missed > 0);
    assert!(missed.iter().skip(first.unwrap_or(6)).all(|&missed| missed == 1), "{missed:?}");
    first
}

#[test]
fn sharp_plateaus_are_told_from_the_second_on_and_others_from_the_fourth() {
    assert_eq!(told_from(SHARP), Some(1));
    for weaker in [
        // Samples farther apart.
        Swing { interval: 0.01, ..SHARP },
        // Longer than the time within which a foot's swing bends.
        Swing { plateau: 14, ..SHARP },
        // It would have risen by a tenth of its level.
        Swing { rising: 0.9, falling: 0.9, ..SHARP },
    ] {
        assert_eq!(told_from(weaker), Some(3));
    }
    assert_eq!(told_from(Swing { plateau: 12, interval: 0.0049, ..SHARP }), Some(1));
    // The first swing counts less, while the level is still learnt.
    assert_eq!(told_from(Swing { rising: 1.1, falling: 1.1, ..SHARP }), Some(2));
    // Two samples are a sharp plateau if they are close together; a round or slow one is none.
    assert_eq!(told_from(Swing { plateau: 2, ..SHARP }), Some(2));
    assert_eq!(told_from(Swing { plateau: 2, interval: 0.01, ..SHARP }), None);
    assert_eq!(told_from(Swing { rising: 0.49, falling: 0.49, ..SHARP }), None);
    assert_eq!(told_from(Swing { level: 4.0, ..SHARP }), None);
}

#[test]
fn what_was_missed_is_a_cubic_about_its_axis() {
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let swing = Swing { axis, sign, ..SHARP };
            let mut stream = Stream::new();
            stream.swings::<3>(swing);
            let turn = stream.missed.last().expect("it is told").turn;
            assert!((turn[axis] / sign - swing.angle()).abs() < 0.01 * swing.angle(), "{turn}");
            assert!((turn.norm() - swing.angle()).abs() < 1e-9, "{turn}");
        }
    }
}

#[test]
fn what_is_entered_or_left_more_than_twice_as_steeply_was_hit() {
    for (rising, falling) in [(9.0, 3.0), (3.0, 9.0)] {
        let mut stream = Stream::new();
        stream.swings::<3>(Swing { level: 20.0, rising, falling, ..SHARP });
        let found = stream.missed.last().expect("it is told").turn.norm();
        let expected = Swing { rising: 6.0, falling: 3.0, ..SHARP }.angle();
        assert!((found - expected).abs() < 1e-9, "{rising} {falling}: {found}");
    }
}

#[test]
fn a_long_plateau_is_no_higher_than_one_of_a_twelfth_of_a_second() {
    let long = Swing { plateau: 40, ..SHARP };
    let mut stream = Stream::new();
    assert_eq!(stream.swings::<4>(long), [0, 0, 0, 1]);
    let found = stream.missed[0].turn.norm();
    let expected = long.angle() * 0.08 / (40.0 * 0.005);
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    // A third of a second indicates a stuck sensor.
    assert_eq!(told_from(Swing { plateau: 59, ..SHARP }), Some(3));
    assert_eq!(told_from(Swing { plateau: 61, ..SHARP }), None);
}

#[test]
fn each_end_of_each_axis_is_learnt_by_itself() {
    let mut stream = Stream::new();
    assert_eq!(stream.swings::<2>(SHARP), [0, 1]);
    for other in [
        Swing { sign: -1.0, ..SHARP },
        Swing { axis: 0, ..SHARP },
        Swing { axis: 2, sign: -1.0, level: 20.0, rising: 8.0, falling: 8.0, ..SHARP },
    ] {
        assert_eq!(stream.swings::<2>(other), [0, 1]);
    }
    assert_eq!(stream.swing(SHARP), 1);
}

#[test]
fn a_level_that_grows_by_more_than_a_fiftieth_was_none() {
    let grown = |factor: f64| {
        let mut stream = Stream::new();
        stream.swings::<2>(SHARP);
        stream.swings::<2>(Swing { level: SHARP.level * factor, ..SHARP })
    };
    assert_eq!(grown(1.019), [1, 1]);
    assert_eq!(grown(1.021), [0, 1]);
    // A rate slightly below the level is still near it.
    assert_eq!(grown(0.981), [1, 1]);
    assert_eq!(grown(0.979), [0, 0]);
}

#[test]
fn one_sample_at_a_level_says_nothing_and_one_beyond_is_none() {
    let mut stream = Stream::new();
    stream.swing(SHARP);
    assert_eq!(stream.swings::<5>(Swing { plateau: 1, ..SHARP }), [0; 5]);
    assert_eq!(stream.swing(SHARP), 1);
    let mut stream = Stream::new();
    stream.swings::<2>(SHARP);
    for rate in [0.0, 5.0, 30.0, 5.0, 0.0, 0.0, 0.0] {
        stream.step(Vector3::new(0.1, rate, 0.1), 0.005, Vector3::zeros());
    }
    assert_eq!(stream.swing(SHARP), 1);
}

#[test]
fn a_missed_turn_stands_as_the_body_does_now_and_comes_with_the_pushes_since() {
    let mut stream = Stream::new();
    stream.swings::<2>(SHARP);
    stream.missed.clear();
    let pushed = Vector3::new(0.1, 0.2, 0.3);
    let (mut turned, mut pushes) = (Vector3::zeros(), Vector3::zeros());
    let mut after = 0;
    for rate in SHARP.rates().take(3 + 4 + 2) {
        let rate = Vector3::new(0.0, rate, 3.0);
        stream.step(rate, 0.005, pushed);
        // From the middle on: half of the plateau, and the two samples after it that show how it falls.
        after += u32::from(rate.y == SHARP.level || after >= 4);
        let share = match after {
            0 => 0.0,
            1..=4 => 0.5,
            _ => 1.0,
        };
        turned += rate * (0.005 * share);
        pushes += pushed * share;
    }
    let [missed] = stream.missed[..] else { panic!("{:?}", stream.missed) };
    let expected = Orientation::identity().turned_in_body(&turned).to_body(&Vector3::new(
        0.0,
        SHARP.angle(),
        0.0,
    ));
    assert!((missed.turn - expected).norm() < 1e-9, "{} {expected}", missed.turn);
    assert!((missed.pushed - pushes).norm() < 1e-9, "{} {pushes}", missed.pushed);
}

#[test]
fn what_is_forgotten_is_not_judged_and_what_is_rewound_keeps_its_ends() {
    let half = |stream: &mut Stream| {
        for rate in SHARP.rates().take(5) {
            stream.step(Vector3::new(0.1, rate, 0.1), 0.005, Vector3::zeros());
        }
    };
    let mut stream = Stream::new();
    stream.swings::<2>(SHARP);
    half(&mut stream);
    stream.clipping.forget();
    assert!(!stream.clipping.concerns(&Vector3::zeros(), false), "nothing is open");
    let before = stream.missed.len();
    for rate in SHARP.rates().skip(7) {
        stream.step(Vector3::new(0.1, rate, 0.1), 0.005, Vector3::zeros());
    }
    assert_eq!(stream.missed.len(), before, "its beginning is not known");

    half(&mut stream);
    stream.clipping = stream.clipping.rewound();
    assert!(!stream.clipping.concerns(&Vector3::zeros(), false), "nothing is open");
    assert_eq!(stream.swing(SHARP), 1, "the end is known");
    // An uncertain end has to be found again.
    let mut unsure = Stream::new();
    unsure.swing(SHARP);
    unsure.clipping = unsure.clipping.rewound();
    assert_eq!(unsure.swings::<2>(SHARP), [0, 1]);
}

#[test]
fn only_large_rates_near_an_end_have_to_be_shown() {
    let clipping = Clipping::<f64>::new();
    let concerns = |y: f64| clipping.concerns(&Vector3::new(0.0, y, 0.0), true);
    assert!(concerns(4.12) && concerns(-4.12) && !concerns(4.11) && !concerns(-4.11));
    assert!(!clipping.concerns(&Vector3::new(0.0, 9.0, 0.0), false));
    let mut stream = Stream::new();
    stream.swing(SHARP);
    let concerns = |y: f64| stream.clipping.concerns(&Vector3::new(0.0, y, 0.0), true);
    assert!(concerns(9.81) && !concerns(9.79) && concerns(-4.2));
}
