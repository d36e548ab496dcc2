//! Common times and places, at their limits.

use super::*;

fn finder() -> HeightFinder<f64, 4> {
    let corners = [[0.0, 0.0, 2.0], [6.0, 0.0, 2.0], [6.0, 5.0, 2.0], [0.0, 5.0, 2.0]];
    let anchor = |place: [f64; 3]| Anchor { position: place.into(), bias: 0.5 };
    HeightFinder::uncalibrated(&corners.map(anchor)).expect("four anchors")
}

/// A finder that has heard anchors at these times (µs), with ranges that grow by one metre per second, different for
/// each.
fn heard<const K: usize>(heard_us: [(usize, u64); K]) -> HeightFinder<f64, 4> {
    let mut finder = finder();
    for (anchor, time_us) in heard_us {
        let range = range(anchor, time_us) + 0.5;
        finder.range(&RangeSample { time_us, anchor, range }).expect("a range");
    }
    finder
}

fn range(anchor: usize, time_us: u64) -> f64 {
    3.0 + anchor as f64 + 1e-6 * time_us as f64
}

/// Checks the time to which the ranges can be interpolated, and which of them are available and right at that time.
fn is_moment(mut finder: HeightFinder<f64, 4>, now_us: u64, at_us: u64, known: [bool; 4]) {
    // As if ranges arrived often: they are fresh for a second.
    (finder.moment_us, finder.pace) = (None, Pace::new(4));
    let found = finder.moment(now_us).expect("a moment");
    assert_eq!(finder.moment_us, Some(at_us));
    for (anchor, (found, known)) in found.into_iter().zip(known).enumerate() {
        assert_eq!(found.is_some(), known, "{anchor}");
        let error = found.map_or(0.0, |found| found - range(anchor, at_us));
        assert!(error.abs() < 1e-9, "{anchor}: {error}");
    }
}

#[test]
fn ranges_are_interpolated_to_the_newest_time_that_all_have_passed() {
    let heard_us = [(0, 0), (1, 100_000), (2, 200_000), (0, 400_000), (1, 500_000), (2, 600_000)];
    is_moment(heard(heard_us), 600_000, 400_000, [true, true, true, false]);
    // An anchor that is no longer heard does not delay the others.
    is_moment(heard(heard_us), 1_450_000, 500_000, [false, true, true, false]);
}

#[test]
fn ranges_that_are_too_far_apart_are_not_interpolated() {
    for (begin_us, known) in [(500_000, true), (499_999, false)] {
        let heard_us = [(1, begin_us), (0, 1_400_000), (1, 1_500_000)];
        is_moment(heard(heard_us), 1_500_000, 1_400_000, [true, known, false, false]);
    }
}

#[test]
fn a_moment_waits_for_all_of_its_ranges() {
    let mut finder = heard([(0, 0), (1, 0), (2, 0), (3, 0)]);
    assert!(finder.place.is_none());
    assert!(!finder.take_moment());
    let place = finder.place.expect("a place");
    assert_eq!((place.moments, place.first.iter().flatten().count()), (1, 4));
}

#[test]
fn a_tag_may_be_beside_an_anchor() {
    let mut finder = finder();
    for ranges in [[0.2, 4.0, 5.0, 6.0], [0.3, 4.0, 5.0, 6.0], [-0.1, 4.0, 5.0, 6.0]] {
        finder.take(&ranges.map(Some));
    }
    let median = finder.place.expect("a place").ranges[0].median().expect("three ranges");
    assert!((median - 0.2).abs() < 0.1, "{median}");
}

#[test]
fn a_place_is_left_when_two_ranges_differ_or_fewer_are_in_common() {
    let ranges = [Quartiles::within(0.0, 10.0); 4];
    let place = Place { first: [Some(3.0), Some(4.0), Some(5.0), None], ranges, moments: 1 };
    for (ranges, left) in [
        ([Some(3.0), Some(4.0), Some(5.0), Some(9.0)], false),
        ([Some(9.0), Some(4.0), Some(5.0), Some(9.0)], false),
        ([Some(3.6), Some(4.0), Some(4.4), None], true),
        ([Some(3.4), Some(4.0), Some(4.6), None], false),
        ([Some(3.0), Some(4.0), None, None], false),
        ([Some(3.0), None, None, Some(9.0)], true),
        ([None, None, None, Some(9.0)], true),
    ] {
        assert_eq!(place.is_left(&ranges), left, "{ranges:?}");
    }
}
