//! Tests with a receiver that is configured to be at rest, and is knocked.

use crate::filter::{SLOW, error, filter, run};
use crate::sky::{START, marker, observe};
use kestirim_gnss_ppp::Receiver;
use kestirim_ppp_filter::{Contradiction, Health, Motion};
use nalgebra::Vector3;

/// When the receiver is knocked, s.
const KNOCKED: f64 = 1800.0;

#[test]
fn it_is_found_where_it_is_then_and_that_is_told() {
    for knock in [[0.05, 0.0, 0.0], [0.0, -0.3, 0.2], [20.0, 30.0, -10.0]].map(Vector3::from) {
        let place = marker() + knock;
        let there = |seconds: f64| if seconds < KNOCKED { marker() } else { place };
        let solutions = run(&mut filter(Motion::Static), 3600.0, |seconds, observations| {
            *observations = observe(seconds, &there(seconds));
        });
        let (before, after) = solutions.split_at((KNOCKED / 30.0) as usize);
        assert!(before.iter().all(|it| !matches!(it.health, Health::Contradicted(_))));
        for solution in after {
            assert_eq!(solution.health, Health::Contradicted(Contradiction::Motion));
            let distance = (solution.position - place).norm();
            assert!(distance < 0.02, "{distance} m after {knock}");
        }
    }
}

#[test]
fn it_is_found_from_the_end_of_the_run_too() {
    let knock = Vector3::new(0.0, -0.3, 0.2);
    let mut filter = filter(Motion::Static);
    for k in (0..=120).rev() {
        let seconds = 30.0 * f64::from(k);
        let place = if seconds < KNOCKED { marker() } else { marker() + knock };
        let observations = observe(seconds, &place);
        let solution = filter
            .process_backwards(START.plus(seconds), &Receiver::default(), &observations)
            .expect("a solution");
        let told = solution.health == Health::Contradicted(Contradiction::Motion);
        assert_eq!(told, seconds < KNOCKED, "{seconds} s");
        if k < 100 {
            assert!((solution.position - place).norm() < 0.02, "{seconds} s");
        }
    }
}

/// Phases of four minutes ago show no motion: delays have changed.
#[test]
fn after_a_gap_changes_are_not_looked_at() {
    let mut filter = filter(Motion::Static);
    for k in (0..=120).filter(|k| !(60..67).contains(k)) {
        let seconds = 30.0 * f64::from(k);
        // In the gap all delays have changed as if the receiver had been knocked.
        let away = Vector3::new(0.0, 0.0, if k < 67 { 0.0 } else { 0.1 });
        let observations = observe(seconds, &(marker() + away));
        let solution = filter
            .process(START.plus(seconds), &Receiver::default(), &observations)
            .expect("a solution");
        let told = solution.health == Health::Contradicted(Contradiction::Motion);
        assert!(!told || k > 67, "{seconds} s");
    }
}

#[test]
fn one_that_may_move_is_not_told_of() {
    let away =
        |seconds: f64| marker() + Vector3::new(if seconds < KNOCKED { 0.0 } else { 0.3 }, 0.0, 0.0);
    let solutions = run(&mut filter(SLOW), 3600.0, |seconds, observations| {
        *observations = observe(seconds, &away(seconds));
    });
    assert!(solutions.iter().all(|it| !matches!(it.health, Health::Contradicted(_))));
    let last = solutions.last().expect("a solution");
    assert!((error(last) - 0.3).abs() < 0.01, "{}", error(last));
}

/// An epoch a millisecond after another is no change of rate, by which σ and the check of displacements go.
#[test]
fn an_epoch_between_others_changes_neither_sigma_nor_what_is_told() {
    let [usual, between] = [false, true].map(|is_between| {
        let mut filter = filter(Motion::Static);
        let mut last = None;
        for k in 0..=120 {
            let seconds = 30.0 * f64::from(k);
            let more = (is_between && k == 20).then_some(seconds + 0.001);
            for seconds in [Some(seconds), more].into_iter().flatten() {
                let place = marker() + Vector3::x() * if k < 110 { 0.0 } else { 0.3 };
                let observations = observe(seconds, &place);
                let at = START.plus(seconds);
                let solution = filter.process(at, &Receiver::default(), &observations);
                let solution = solution.expect("a solution");
                if k == 109 {
                    last = Some((solution.health, solution.covariance.trace().sqrt()));
                }
                if k == 110 {
                    assert_eq!(solution.health, Health::Contradicted(Contradiction::Motion));
                }
            }
        }
        last.expect("an epoch before the knock")
    });
    assert_eq!(usual.0, between.0);
    assert!((between.1 / usual.1 - 1.0).abs() < 0.05, "{} {}", between.1, usual.1);
}
