//! A receiver that is said to rest, and is knocked.

use crate::filter::{SLOW, error, filter, run};
use crate::sky::{marker, observe};
use kestirim_ppp_filter::{Contradiction, Health, Motion};
use nalgebra::Vector3;

/// When it is knocked, s.
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
