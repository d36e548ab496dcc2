//! A first position, beside the least squares that it comes from.

use super::*;
use crate::Anchor;

const CORNERS: [[f64; 3]; 5] =
    [[0.0, 0.0, 2.0], [8.0, 0.0, 0.3], [8.0, 6.0, 2.0], [0.0, 6.0, 0.3], [4.0, 0.0, 1.5]];
const TAG: [f64; 3] = [3.0, 2.0, 1.0];
const NOW_US: u64 = 20_000_000;
const FRESH_US: u64 = 8_000_000;

/// Links in the corners, heard so long ago (µs), with ranges that are so much too long (m).
fn links<const A: usize>(
    config: &Config<f64>,
    ages_us: [u64; A],
    excess: [f64; A],
) -> [Link<f64>; A] {
    core::array::from_fn(|index| {
        let position = SVector::from(CORNERS[index]);
        let mut link = Link::new(Anchor { position, bias: 0.0 }, config);
        link.hear(NOW_US - ages_us[index], (position - SVector::from(TAG)).norm() + excess[index]);
        link
    })
}

/// The same as observations, with these standard deviations of what the tag may have moved.
fn observations<const A: usize>(moved: [f64; A], excess: [f64; A]) -> [Observation<f64>; A] {
    core::array::from_fn(|index| {
        let anchor = SVector::from(CORNERS[index]);
        let range = (anchor - SVector::from(TAG)).norm() + excess[index];
        Observation { anchor, range, variance: 0.1 * 0.1 + moved[index] * moved[index] }
    })
}

fn begun<const N: usize, const A: usize>(
    config: &Config<f64>,
    links: &[Link<f64>; A],
    tries: u8,
) -> Option<Gaussian<f64, N>> {
    start::<f64, 2, N, A>(config, links, NOW_US, FRESH_US, tries)
}

#[test]
fn a_start_is_the_fix_and_what_biases_and_rounding_add() {
    let config = Config::calibrated(1.0);
    let excess = [0.1, -0.05, 0.08, 0.02];
    // What was heard a second ago may be half a metre off, and never more than a metre.
    let (ages_us, moved) = ([0, 1_000_000, 2_000_000, 8_000_000], [0.0, 0.5, 1.0, 1.0]);
    let found = begun::<4, 4>(&config, &links(&config, ages_us, excess), 0).expect("a start");
    let solver = Solver { huber: config.huber, ..Solver::new(1.0) };
    let fix = solver.solve::<2>(&observations(moved, excess), None).expect("a fix");
    assert!((found.mean.fixed_rows::<2>(0) - fix.position).norm() < 1e-9, "{}", found.mean);
    assert_eq!(found.mean.fixed_rows::<2>(2), SVector::from([0.0, 0.0]));
    let p = found.covariance.to_matrix();
    for axis in 0..2 {
        let variance = fix.covariance[(axis, axis)] * 65.0 / 64.0 + 0.1 * 0.1;
        assert!((p[(axis, axis)] - variance).abs() < 1e-9, "{p} {}", fix.covariance);
        assert!((p[(2 + axis, 2 + axis)] - 0.5 * 0.5).abs() < 1e-9, "{p}");
    }
    assert!((p[(1, 0)] - fix.covariance[(1, 0)]).abs() < 1e-9, "{p}");
    assert_eq!((p[(2, 0)], p[(3, 1)], p[(3, 2)]), (0.0, 0.0, 0.0));
}

#[test]
fn a_common_bias_begins_as_the_fix_knows_it() {
    let config = Config::uncalibrated(1.0);
    let found = begun::<5, 4>(&config, &links(&config, [0; 4], [0.4; 4]), 0).expect("a start");
    let solver = Solver { huber: config.huber, common_bias: Some(0.3), ..Solver::new(1.0) };
    let fix = solver.solve::<2>(&observations([0.0; 4], [0.4; 4]), None).expect("a fix");
    assert!(fix.common_bias > 0.2, "{fix:?}");
    assert!((found.mean[4] - fix.common_bias).abs() < 1e-9);
    let variance = found.covariance.variances()[4];
    assert!((variance - fix.common_bias_variance).abs() < 1e-9, "{variance}, {fix:?}");
    // Three ranges do not tell it: it is what it was before.
    let found = begun::<5, 3>(&config, &links(&config, [0; 3], [0.0; 3]), 0).expect("a start");
    assert!((found.covariance.variances()[4] - 0.3 * 0.3).abs() < 1e-9);
    assert_eq!(found.mean[4], 0.0);
}

#[test]
fn old_ranges_begin_nothing() {
    let config = Config::calibrated(1.0);
    let old = FRESH_US + 1;
    assert!(begun::<4, 4>(&config, &links(&config, [0, 0, FRESH_US, old], [0.0; 4]), 0).is_some());
    assert!(begun::<4, 4>(&config, &links(&config, [0, 0, old, old], [0.0; 4]), 0).is_none());
}

#[test]
fn ranges_that_contradict_each_other_are_taken_in_the_end() {
    let config = Config { huber: None, ..Config::calibrated(1.0) };
    let links = links(&config, [0; 4], [2.0, -2.0, 2.0, -2.0]);
    for tries in 0..=25 {
        assert_eq!(begun::<4, 4>(&config, &links, tries).is_some(), tries >= 20, "{tries}");
    }
}

#[test]
fn each_second_time_another_anchor_is_left_out() {
    let config = Config::calibrated(1.0);
    for blocked in 0..5_u8 {
        let excess =
            core::array::from_fn(|index| if index == usize::from(blocked) { 3.0 } else { 0.0 });
        let links = links::<5>(&config, [0; 5], excess);
        for tries in 0..10 {
            let found = begun::<4, 5>(&config, &links, tries);
            assert_eq!(found.is_some(), tries == 2 * blocked + 1, "{blocked}, {tries}");
            let off = found.map(|found| (found.mean[0] - TAG[0]).hypot(found.mean[1] - TAG[1]));
            assert!(off.is_none_or(|off| off < 1e-3), "{off:?}");
        }
    }
    // Of four, three are left: one to spare.
    let four = links::<4>(&config, [0; 4], [0.0, 3.0, 0.0, 0.0]);
    assert!(begun::<4, 4>(&config, &four, 3).is_some());
    // What is too short is in nobody's way, and what is left must have a range to spare.
    let short = links::<5>(&config, [0; 5], [-3.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(begun::<4, 5>(&config, &short, 1).is_none());
    let three = links::<3>(&config, [0; 3], [0.0; 3]);
    assert!(begun::<4, 3>(&config, &three, 0).is_some());
    assert!(begun::<4, 3>(&config, &three, 1).is_none());
    let three = links::<3>(&config, [0; 3], [3.0, 0.0, 0.0]);
    assert!((1..9).all(|tries| begun::<4, 3>(&config, &three, tries).is_none()));
    // A little too long is what the others make up for: left out it would not be wrong enough.
    let near = links::<5>(&config, [0; 5], [0.2, 0.0, 0.0, 0.0, 0.0]);
    assert!(begun::<4, 5>(&config, &near, 1).is_none());
}

#[test]
fn a_range_is_not_blocked_that_is_as_long_as_all() {
    let config = Config::uncalibrated(1.0);
    let links = links::<5>(&config, [0; 5], [0.5, 0.4, 0.4, 0.4, 0.4]);
    assert!(begun::<5, 5>(&config, &links, 1).is_none());
}

#[test]
fn a_start_in_space_has_the_same_states() {
    let config = Config::uncalibrated(0.0);
    let links = links::<5>(&config, [0; 5], [0.2; 5]);
    let found = start::<f64, 3, 7, 5>(&config, &links, NOW_US, FRESH_US, 0).expect("a start");
    let p = found.covariance.to_matrix();
    for state in 3..6 {
        assert!((p[(state, state)] - 0.5 * 0.5).abs() < 1e-9, "{p}");
        assert_eq!(found.mean[state], 0.0);
    }
    let solver = Solver { huber: config.huber, common_bias: Some(0.3), ..Solver::new(0.0) };
    let fix = solver.solve::<3>(&observations([0.0; 5], [0.2; 5]), None).expect("a fix");
    assert!((found.mean[6] - fix.common_bias).abs() < 1e-9, "{fix:?} {}", found.mean);
    let known = if fix.common_bias_variance > 0.0 { fix.common_bias_variance } else { 0.09 };
    assert!((p[(6, 6)] - known).abs() < 1e-9, "{fix:?} {p}");
    // Without the fifth, a sixth state is the last.
    assert!(start::<f64, 3, 6, 5>(&config, &links, NOW_US, FRESH_US, 0).is_some());
}

#[test]
fn in_space_one_range_to_spare_is_left_of_five() {
    let config = Config::calibrated(0.0);
    let blocked = [0.0, 3.0, 0.0, 0.0, 0.0];
    let found = |tries| {
        let links = links::<5>(&config, [0; 5], blocked);
        start::<f64, 3, 6, 5>(&config, &links, NOW_US, FRESH_US, tries)
    };
    assert!(found(3).is_some() && found(5).is_none());
    let four = links::<4>(&config, [0; 4], [0.0, 3.0, 0.0, 0.0]);
    let found = |tries| start::<f64, 3, 6, 4>(&config, &four, NOW_US, FRESH_US, tries);
    assert!((1..9).step_by(2).all(|tries| found(tries).is_none()));
}
