//! The first position, compared with the least squares on which it is based.

use rand_distr::{Distribution, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

use super::*;
use crate::Anchor;

const CORNERS: [[f64; 3]; 5] =
    [[0.0, 0.0, 2.0], [8.0, 0.0, 0.3], [8.0, 6.0, 2.0], [0.0, 6.0, 0.3], [4.0, 0.0, 1.5]];
const TAG: [f64; 3] = [3.0, 2.0, 1.0];
const NOW_US: u64 = 20_000_000;
const FRESH_US: u64 = 8_000_000;
const SOON: u32 = 20;

/// Links in the corners, heard this long ago (µs), with ranges that are too long by `excess` (m).
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

/// The ranges of [`links`] as observations, with these standard deviations of the tag's motion (m).
fn observations<const A: usize>(moved: [f64; A], excess: [f64; A]) -> [Observation<f64>; A] {
    core::array::from_fn(|index| {
        let anchor = SVector::from(CORNERS[index]);
        let range = (anchor - SVector::from(TAG)).norm() + excess[index];
        Observation { anchor, range, variance: 0.1 * 0.1 + moved[index] * moved[index] }
    })
}

/// The estimate that is found within `ranges` identical rounds, and the number it takes.
fn begun_after<const D: usize, const N: usize, const A: usize>(
    config: &Config<f64>,
    links: &[Link<f64>; A],
    ranges: u32,
) -> Option<(u32, Gaussian<f64, N>)> {
    let mut start = Start::<f64, D, A>::new();
    (1..=ranges).find_map(|range| {
        let begun = start.go_on(config, links, (NOW_US, FRESH_US), 1, true)?;
        assert_eq!(begun.time_us, NOW_US);
        Some((range, begun.estimate))
    })
}

/// The estimate found soon: before contradictory ranges are accepted.
fn begun<const N: usize, const A: usize>(
    config: &Config<f64>,
    links: &[Link<f64>; A],
) -> Option<Gaussian<f64, N>> {
    Some(begun_after::<2, N, A>(config, links, SOON)?.1)
}

#[test]
fn a_start_is_the_fix_and_what_biases_and_rounding_add() {
    let config = Config::calibrated(1.0);
    let excess = [0.1, -0.05, 0.08, 0.02];
    // A range heard a second ago may be off by half a metre, and never by more than a metre.
    let (ages_us, moved) = ([0, 1_000_000, 2_000_000, 8_000_000], [0.0, 0.5, 1.0, 1.0]);
    let found = begun::<4, 4>(&config, &links(&config, ages_us, excess)).expect("a start");
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
    let found = begun::<5, 4>(&config, &links(&config, [0; 4], [0.4; 4])).expect("a start");
    let solver = Solver { huber: config.huber, common_bias: Some(0.3), ..Solver::new(1.0) };
    let fix = solver.solve::<2>(&observations([0.0; 4], [0.4; 4]), None).expect("a fix");
    assert!(fix.common_bias > 0.2, "{fix:?}");
    assert!((found.mean[4] - fix.common_bias).abs() < 1e-9);
    let variance = found.covariance.variances()[4];
    assert!((variance - fix.common_bias_variance).abs() < 1e-9, "{variance}, {fix:?}");
    // Three ranges do not determine it: its prior is unchanged.
    let found = begun::<5, 3>(&config, &links(&config, [0; 3], [0.0; 3])).expect("a start");
    assert!((found.covariance.variances()[4] - 0.3 * 0.3).abs() < 1e-9);
    assert_eq!(found.mean[4], 0.0);
}

#[test]
fn old_ranges_begin_nothing() {
    let config = Config::calibrated(1.0);
    let old = FRESH_US + 1;
    assert!(begun::<4, 4>(&config, &links(&config, [0, 0, FRESH_US, old], [0.0; 4])).is_some());
    assert!(begun::<4, 4>(&config, &links(&config, [0, 0, old, old], [0.0; 4])).is_none());
}

#[test]
fn ranges_that_agree_make_a_position_at_once() {
    let config = Config::calibrated(1.0);
    let links = links::<5>(&config, [0; 5], [0.05, -0.05, 0.0, 0.05, 0.0]);
    let (ranges, _) = begun_after::<2, 4, 5>(&config, &links, SOON).expect("a start");
    assert!(ranges <= 2, "{ranges}");
}

#[test]
fn ranges_that_contradict_each_other_are_taken_in_the_end() {
    let config = Config { huber: None, ..Config::calibrated(1.0) };
    let links = links(&config, [0; 4], [2.0, -2.0, 2.0, -2.0]);
    let (ranges, _) = begun_after::<2, 4, 4>(&config, &links, 100).expect("a start");
    assert!((SOON + 1..2 * SOON).contains(&ranges), "{ranges}");
}

#[test]
fn an_attempt_belongs_to_the_ranges_that_it_began_with() {
    let config = Config::calibrated(1.0);
    // They are contradictory, which takes a while to find out.
    let before = links::<5>(&config, [0; 5], [0.0, 3.0, 0.0, 0.0, 0.0]);
    let mut start = Start::<f64, 2, 5>::new();
    let mut go_on = |links: &[Link<f64>; 5], time_us| {
        start.go_on::<4>(&config, links, (time_us, FRESH_US), 1, true)
    };
    assert!(go_on(&before, NOW_US).is_none());
    // Later measurements are from another place.
    let mut after = before;
    for link in &mut after {
        link.hear(NOW_US + 1, 4.0);
    }
    let begun = (1..SOON).find_map(|later| go_on(&after, NOW_US + u64::from(later)));
    let begun = begun.expect("a start");
    assert_eq!(begun.time_us, NOW_US);
    let off = (begun.estimate.mean[0] - TAG[0]).hypot(begun.estimate.mean[1] - TAG[1]);
    assert!(off < 1e-3, "{off} m");
}

#[test]
fn an_attempt_of_ranges_that_are_old_by_now_is_given_up() {
    let config = Config::calibrated(1.0);
    let before = links::<5>(&config, [0; 5], [0.0, 3.0, 0.0, 0.0, 0.0]);
    let mut start = Start::<f64, 2, 5>::new();
    assert!(start.go_on::<4>(&config, &before, (NOW_US, FRESH_US), 1, true).is_none());
    assert!(start.is_on());
    let later_us = NOW_US + FRESH_US + 1;
    assert!(start.go_on::<4>(&config, &before, (later_us, FRESH_US), 1, true).is_none());
    assert!(!start.is_on(), "none is fresh");
    // Other ranges start an attempt.
    let mut fresh = links::<5>(&config, [0; 5], [0.0; 5]);
    for link in &mut fresh {
        let (range, _) = link.fresh(NOW_US, 0).expect("a range");
        link.hear(later_us, range);
    }
    let mut ranges =
        (0..SOON).filter_map(|_| start.go_on::<4>(&config, &fresh, (later_us, FRESH_US), 1, true));
    assert_eq!(ranges.next().expect("a start").time_us, later_us);
}

#[test]
fn the_one_that_is_too_long_is_left_out() {
    let config = Config::calibrated(1.0);
    for blocked in 0..5_usize {
        let excess = core::array::from_fn(|index| if index == blocked { 3.0 } else { 0.0 });
        let links = links::<5>(&config, [0; 5], excess);
        let found = begun::<4, 5>(&config, &links).expect("a start");
        let off = (found.mean[0] - TAG[0]).hypot(found.mean[1] - TAG[1]);
        assert!(off < 1e-3, "{blocked}: {off} m");
    }
    // Of four, three remain: one more than the unknowns.
    let four = links::<4>(&config, [0; 4], [0.0, 3.0, 0.0, 0.0]);
    assert!(begun::<4, 4>(&config, &four).is_some());
    // Nothing can make a range too short, and the remaining ranges must be redundant.
    let short = links::<5>(&config, [0; 5], [-3.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(begun::<4, 5>(&config, &short).is_none());
    let three = links::<3>(&config, [0; 3], [0.0; 3]);
    assert!(begun::<4, 3>(&config, &three).is_some());
    let three = links::<3>(&config, [0; 3], [3.0, 0.0, 0.0]);
    assert!(begun::<4, 3>(&config, &three).is_none());
}

#[test]
fn a_range_is_not_blocked_that_is_as_long_as_all() {
    let config = Config::uncalibrated(1.0);
    let links = links::<5>(&config, [0; 5], [0.5, 0.4, 0.4, 0.4, 0.4]);
    assert!(begun::<5, 5>(&config, &links).is_some());
    let solver = Solver { common_bias: Some(0.3), ..Solver::new(1.0) };
    let mut attempt = Start::<f64, 2, 5>::new();
    attempt.begin(&config, &links, (NOW_US, FRESH_US));
    let fix = solver.solve::<2>(&attempt.observations, None).expect("a fix");
    for last in 0..5 {
        attempt.observations.swap(last, 4);
        assert!(!attempt.is_blocked(&solver, &fix), "{fix:?}");
    }
}

#[test]
fn a_start_in_space_has_the_same_states() {
    let config = Config::uncalibrated(0.0);
    let links = links::<5>(&config, [0; 5], [0.2; 5]);
    let found = begun_after::<3, 7, 5>(&config, &links, SOON).expect("a start").1;
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
    // Without the fifth, the sixth state is the last.
    assert!(begun_after::<3, 6, 5>(&config, &links, SOON).is_some());
}

#[test]
fn in_space_one_range_to_spare_is_left_of_five() {
    let config = Config::calibrated(0.0);
    let blocked = [0.0, 3.0, 0.0, 0.0, 0.0];
    let links = links::<5>(&config, [0; 5], blocked);
    let (_, found) = begun_after::<3, 6, 5>(&config, &links, SOON).expect("a start");
    let off = (found.mean.fixed_rows::<3>(0) - SVector::from(TAG)).norm();
    assert!(off < 1e-2, "{off} m");
    let four = self::links::<4>(&config, [0; 4], [0.0, 3.0, 0.0, 0.0]);
    assert!(begun_after::<3, 6, 4>(&config, &four, SOON).is_none());
}

/// Starts in random rooms, where up to one range is too long by up to 5 m: the mean and the largest number of ranges
/// they take, and the share of them within 30 cm.
fn in_rooms<const A: usize>(is_blocked: bool) -> (f64, u32, f64) {
    const ROOMS: u32 = 1000;
    let (config, mut random) = (Config::calibrated(1.0), Xoshiro256PlusPlus::seed_from_u64(1));
    let mut uniform = || -> f64 { StandardUniform.sample(&mut random) };
    let (mut sum, mut most, mut right) = (0, 0, 0);
    for _ in 0..ROOMS {
        let tag = SVector::from([8.0 * uniform(), 6.0 * uniform(), 1.0]);
        let blocked = (uniform() * A as f64) as usize;
        let links: [Link<f64>; A] = core::array::from_fn(|index| {
            let angle = core::f64::consts::TAU * (index as f64 + 0.5 * uniform()) / A as f64;
            let height = 0.3 + 2.0 * uniform();
            let place = [4.0 + 4.0 * angle.cos(), 3.0 + 3.0 * angle.sin(), height];
            let position = SVector::from(place);
            let mut link = Link::new(Anchor { position, bias: 0.0 }, &config);
            let excess = if is_blocked && index == blocked { 0.5 + 4.5 * uniform() } else { 0.0 };
            let noise = 0.2 * uniform() - 0.1;
            link.hear(NOW_US, (position - tag).norm() + excess + noise);
            link
        });
        let Some((ranges, found)) = begun_after::<2, 4, A>(&config, &links, 60) else { continue };
        (sum, most) = (sum + ranges, most.max(ranges));
        right += u32::from((found.mean[0] - tag[0]).hypot(found.mean[1] - tag[1]) < 0.3);
    }
    (f64::from(sum) / f64::from(ROOMS), most, f64::from(right) / f64::from(ROOMS))
}

#[test]
fn a_position_takes_a_few_ranges() {
    extern crate std;
    let check = |anchors, [agree, blocked]: [(f64, u32, f64); 2]| {
        std::println!("{anchors} anchors that agree: {agree:?}; one of them blocked: {blocked:?}");
        assert!(agree.0 <= 5.5 && agree.1 <= 8 && agree.2 > 0.97, "{anchors}: {agree:?}");
        assert!(blocked.0 <= 18.0 && blocked.1 <= 60, "{anchors}: {blocked:?}");
        assert!(anchors < 5 || blocked.2 > 0.98, "{anchors}: {blocked:?}");
    };
    check(3, [in_rooms::<3>(false), in_rooms::<3>(true)]);
    check(4, [in_rooms::<4>(false), in_rooms::<4>(true)]);
    check(5, [in_rooms::<5>(false), in_rooms::<5>(true)]);
    check(6, [in_rooms::<6>(false), in_rooms::<6>(true)]);
    check(8, [in_rooms::<8>(false), in_rooms::<8>(true)]);
}
