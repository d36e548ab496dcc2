//! Arbitrary input: each call returns a typed error and leaves the tracker unchanged, or a finite position and
//! covariance.

use crate::common::{CORNERS, anchors, distance, sample};
use kestirim_kalman::Gaussian;
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{Config, Error, InertialSample, OdometrySample, Tracker, WheelTracker};
use nalgebra::{SMatrix, Vector3};
use proptest::prelude::*;

/// A sensor event, good or bad, and the time since the last one.
#[derive(Clone, Copy, Debug)]
enum Event {
    Range { later_us: i64, anchor: usize, range: f64 },
    Inertial { later_us: i64, acceleration: f64, push: Option<f64> },
    Wheels { later_us: i64, speed: f64, turn_rate: f64 },
}

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => 0.0..12.0f64,
        1 => -300.0..1000.0f64,
        1 => prop_oneof![
            Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY), Just(1e30), Just(-1.0),
        ],
    ]
}

fn later() -> impl Strategy<Value = i64> {
    prop_oneof![
        4 => Just(0_i64),
        8 => 0..100_000_i64,
        1 => -2_000_000..20_000_000_i64,
        1 => Just(i64::MAX),
    ]
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        6 => (later(), 0_usize..5, number())
            .prop_map(|(later_us, anchor, range)| Event::Range { later_us, anchor, range }),
        1 => (later(), number(), proptest::option::of(number()))
            .prop_map(|(later_us, acceleration, push)| Event::Inertial { later_us, acceleration, push }),
        1 => (later(), number(), number())
            .prop_map(|(later_us, speed, turn_rate)| Event::Wheels { later_us, speed, turn_rate }),
    ]
}

fn feed<T: Scalar, const D: usize, const N: usize>(
    config: Config<T>,
    events: &[Event],
) -> Result<(), TestCaseError> {
    let mut tracker = Tracker::<T, D, N, 4>::new(config, &anchors(&CORNERS, 0.0)).unwrap();
    let (mut now_us, number) = (1_000_000_u64, T::from_f64);
    for event in events {
        let before = format!("{tracker:?}");
        let mut at = |later_us: i64| {
            now_us = now_us.saturating_add_signed(later_us);
            now_us
        };
        let refused = match *event {
            Event::Range { later_us, anchor, range } => {
                tracker.range(&sample(at(later_us), anchor, range)).is_err()
            }
            Event::Inertial { later_us, acceleration, push } => {
                let acceleration = Vector3::new(number(acceleration), T::ZERO, T::ONE);
                let push = push.map(|push| [number(push); D]);
                tracker
                    .inertial(&InertialSample { time_us: at(later_us), acceleration, push })
                    .is_err()
            }
            Event::Wheels { later_us, speed, turn_rate } => {
                let (speed, turn_rate) = (number(speed), number(turn_rate));
                tracker
                    .odometry(&OdometrySample { time_us: at(later_us), speed, turn_rate })
                    .is_err()
            }
        };
        if refused {
            prop_assert_eq!(format!("{tracker:?}"), before, "{:?}", event);
        }
        if let Some(estimate) = tracker.estimate() {
            is_an_estimate(estimate, event)?;
        }
        let health = tracker.health(now_us);
        prop_assert!(health.nis >= T::ZERO);
    }
    Ok(())
}

/// Checks that the estimate is finite, and its covariance valid.
fn is_an_estimate<T: Scalar, const N: usize>(
    estimate: &Gaussian<T, N>,
    event: &Event,
) -> Result<(), TestCaseError> {
    prop_assert!(estimate.mean.iter().all(|x| x.is_finite()), "{:?}", event);
    let p: SMatrix<f64, N, N> = estimate.covariance.to_matrix().map(T::to_f64);
    let deviations = p.diagonal().map(f64::sqrt);
    prop_assert!(deviations.iter().all(|deviation| *deviation > 0.0), "{:?} {}", event, p);
    let scale = SMatrix::<f64, N, N>::from_diagonal(&deviations.map(f64::recip));
    // With a tiny margin, every positive semidefinite matrix has a Cholesky factor.
    let correlations = scale * p * scale + SMatrix::<f64, N, N>::identity() * 1e-6;
    prop_assert!(correlations.cholesky().is_some(), "{:?} {}", event, p);
    Ok(())
}

/// Feeds the events to a tracker on wheels.
fn drive<T: Scalar>(config: Config<T>, events: &[Event]) -> Result<(), TestCaseError> {
    let mut tracker = WheelTracker::<T, 4>::new(config, &anchors(&CORNERS, 0.0)).unwrap();
    let (mut now_us, number) = (1_000_000_u64, T::from_f64);
    for event in events {
        let before = format!("{tracker:?}");
        let mut at = |later_us: i64| {
            now_us = now_us.saturating_add_signed(later_us);
            now_us
        };
        let refused = match *event {
            Event::Range { later_us, anchor, range } => {
                tracker.range(&sample(at(later_us), anchor, range)).is_err()
            }
            Event::Inertial { .. } => false,
            Event::Wheels { later_us, speed, turn_rate } => {
                let (speed, turn_rate) = (number(speed), number(turn_rate));
                let time_us = at(later_us);
                tracker.odometry(&OdometrySample { time_us, speed, turn_rate }).is_err()
            }
        };
        if refused {
            prop_assert_eq!(format!("{tracker:?}"), before, "{:?}", event);
        }
        if let Some(estimate) = tracker.estimate() {
            is_an_estimate(estimate, event)?;
        }
        prop_assert!(tracker.health(now_us).nis >= T::ZERO);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]
    #[test]
    fn nothing_that_is_fed_in_does_harm(events in proptest::collection::vec(event(), 1..80)) {
        feed::<f64, 2, 4>(Config::calibrated(1.0), &events)?;
        feed::<f32, 2, 4>(Config::calibrated(1.0), &events)?;
        feed::<f32, 2, 5>(Config::uncalibrated(1.0), &events)?;
        feed::<f32, 3, 6>(Config::calibrated(1.0), &events)?;
        feed::<f32, 2, 4>(Config::plain(1.0), &events)?;
        feed::<Q12_20, 2, 4>(Config::calibrated(Q12_20::ONE), &events)?;
        feed::<Q12_20, 2, 5>(Config::uncalibrated(Q12_20::ONE), &events)?;
        drive::<f64>(Config::uncalibrated(1.0), &events)?;
        drive::<f32>(Config::calibrated(1.0), &events)?;
        drive::<Q12_20>(Config::uncalibrated(Q12_20::ONE), &events)?;
    }
}

#[test]
fn each_bad_range_has_its_error() {
    let mut tracker =
        Tracker::<f32, 2, 4, 4>::new(Config::calibrated(1.0), &anchors(&CORNERS, 0.0)).unwrap();
    for k in 0..20_u64 {
        for (anchor, &place) in CORNERS.iter().enumerate() {
            tracker.range(&sample(100_000 * k, anchor, distance(place, [3.0, 2.0, 1.0]))).unwrap();
        }
    }
    let now_us = 2_000_000;
    for (sample, error) in [
        (sample(now_us, 0, f64::NAN), Error::NotFinite),
        (sample(now_us, 0, f64::INFINITY), Error::NotFinite),
        (sample(now_us, 0, -143.0), Error::ImplausibleRange),
        (sample(now_us, 0, 1000.0), Error::ImplausibleRange),
        (sample(now_us, 4, 3.0), Error::NoSuchAnchor),
        (sample(1_900_000, 0, 3.0), Error::Duplicate),
        (sample(1_500_000, 0, 3.0), Error::OutOfOrder),
    ] {
        let before = format!("{tracker:?}");
        assert_eq!(tracker.range(&sample), Err(error));
        assert_eq!(format!("{tracker:?}"), before);
    }
}
