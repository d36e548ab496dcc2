//! The trackers for comparison: a position per epoch, and the paper's filter.

use crate::common::{CORNERS, anchors, distance, in_every_scalar, sample};
use kestirim_adaptive_kalman::Error as Refusal;
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{Error as NoPosition, Solver};
use kestirim_uwb_tracker::{
    EpochMethod, EpochSolver, Error, PublishedConfig, PublishedOutcome, PublishedTracker,
};
use nalgebra::Vector2;
use proptest::prelude::*;

const METHODS: [EpochMethod; 2] = [EpochMethod::Trilateration, EpochMethod::LeastSquares];

fn check_epoch<T: Scalar>(tolerance: f64) {
    let tag = [3.0, 2.0, 1.0];
    for method in METHODS {
        let anchors = anchors(&CORNERS, 0.15);
        let mut solver = EpochSolver::<T, 8>::new(method, Solver::new(T::ONE), &anchors).unwrap();
        assert_eq!(solver.position::<2>(0, None), Err(NoPosition::TooFewRanges));
        for (anchor, &place) in CORNERS.iter().enumerate() {
            solver.range(&sample(1000, anchor, distance(place, tag) + 0.15)).unwrap();
        }
        let position = solver.position::<2>(1_001_000, None).unwrap().map(T::to_f64);
        assert!((position - Vector2::new(3.0, 2.0)).norm() < tolerance, "{method:?} {position}");
        assert_eq!(solver.position::<2>(1_001_001, None), Err(NoPosition::TooFewRanges));
    }
}

#[test]
fn the_ranges_of_one_moment_make_a_position() {
    check_epoch::<f64>(2e-3);
    check_epoch::<f32>(2e-3);
    check_epoch::<Q12_20>(3e-3);
}

#[test]
fn each_bad_range_has_its_error() {
    let mut solver =
        EpochSolver::<f32, 4>::new(METHODS[0], Solver::new(1.0), &anchors(&CORNERS, 0.0)).unwrap();
    solver.range(&sample(1000, 0, 3.0)).unwrap();
    for (sample, error) in [
        (sample(2000, 0, f64::NAN), Error::NotFinite),
        (sample(2000, 0, 1000.0), Error::ImplausibleRange),
        (sample(2000, 4, 3.0), Error::NoSuchAnchor),
        (sample(1000, 0, 3.0), Error::Duplicate),
        (sample(999, 0, 3.0), Error::OutOfOrder),
    ] {
        let before = format!("{solver:?}");
        assert_eq!(solver.range(&sample), Err(error));
        assert_eq!(format!("{solver:?}"), before);
    }
    assert_eq!(solver.set_height(f32::NAN), Err(Error::NotFinite));
    let crowd = EpochSolver::<f32, 3>::new(METHODS[0], Solver::new(1.0), &anchors(&CORNERS, 0.0));
    assert_eq!(crowd.map(|_| ()), Err(Error::TooManyAnchors));
}

type Published<T> = PublishedTracker<T, 2, 4, 4>;

fn published<T: Scalar>(config: PublishedConfig<T, 2>) -> Published<T> {
    let anchors = <[_; 4]>::try_from(anchors(&CORNERS, 0.0)).expect("four corners");
    PublishedTracker::new(config, &anchors).unwrap()
}

/// One epoch of all anchors, for a stationary tag.
fn epoch<T: Scalar>(tracker: &mut Published<T>, time_us: u64) -> PublishedOutcome {
    for (anchor, &place) in CORNERS.iter().enumerate() {
        assert_eq!(tracker.end_epoch(time_us), PublishedOutcome::Incomplete);
        tracker.range(&sample(time_us, anchor, distance(place, [3.0, 2.0, 1.0]))).unwrap();
    }
    tracker.end_epoch(time_us)
}

fn check_published<T: Scalar>() {
    for config in [PublishedConfig::plain(T::ONE), PublishedConfig::adaptive(T::ONE)] {
        let mut honest = published(config);
        assert_eq!((honest.position(), honest.estimate()), (None, None));
        assert_eq!(epoch(&mut honest, 0), PublishedOutcome::Started);
        for k in 1..50 {
            assert_eq!(epoch(&mut honest, 100_000 * k), PublishedOutcome::Taken);
        }
        let position = honest.position().unwrap().map(T::to_f64);
        assert!((position - Vector2::new(3.0, 2.0)).norm() < 0.01, "{position}");
    }
}

#[test]
fn an_epoch_is_complete_when_every_anchor_was_heard() {
    in_every_scalar!(check_published);
}

#[test]
fn started_elsewhere_it_stays_beside_the_tag() {
    let start = Some(Vector2::new(3.5, 2.0));
    let mut tracker = published(PublishedConfig { start, ..PublishedConfig::adaptive(1.0_f64) });
    for k in 0..50 {
        epoch(&mut tracker, 100_000 * k);
    }
    let position = tracker.position().unwrap();
    assert!((position - Vector2::new(3.0, 2.0)).norm() > 0.1, "{position}");
}

#[test]
fn what_equation_18_makes_impossible_is_left_out() {
    let config = PublishedConfig {
        position_variance: 0.5,
        range_variance: 0.01,
        forgetting: 0.7,
        ..PublishedConfig::adaptive(1.0_f64)
    };
    let mut tracker = published(config);
    epoch(&mut tracker, 0);
    epoch(&mut tracker, 100_000);
    let refused = PublishedOutcome::Refused(kestirim_kalman::Error::NotPositive.into());
    assert_eq!(epoch(&mut tracker, 200_000), refused);
    let mut invalid = published(PublishedConfig { forgetting: 2.0, ..config });
    assert_eq!(epoch(&mut invalid, 0), PublishedOutcome::Refused(Refusal::InvalidLearning));
}

fn feed<T: Scalar>(ranges: &[(u64, usize, f64)]) -> Result<(), TestCaseError> {
    let mut tracker = published(PublishedConfig::<T, 2>::adaptive(T::ONE));
    let mut time_us = 0;
    for &(later_us, anchor, range) in ranges {
        time_us += later_us;
        let before = format!("{tracker:?}");
        if tracker.range(&sample(time_us, anchor, range)).is_err() {
            prop_assert_eq!(format!("{tracker:?}"), before);
        }
        tracker.end_epoch(time_us);
        if let Some(estimate) = tracker.estimate() {
            prop_assert!(estimate.mean.iter().all(|x| x.is_finite()));
            prop_assert!(estimate.covariance.is_finite());
        }
    }
    Ok(())
}

proptest! {
    #[test]
    fn nothing_that_is_fed_in_does_harm(ranges in proptest::collection::vec((
        prop_oneof![0..100_000_u64, Just(u64::MAX / 1000)],
        0_usize..5,
        prop_oneof![4 => 0.0..12.0f64, 1 => -300.0..1000.0f64, 1 => Just(f64::NAN)],
    ), 1..80)) {
        feed::<f64>(&ranges)?;
        feed::<f32>(&ranges)?;
        feed::<Q12_20>(&ranges)?;
    }
}
