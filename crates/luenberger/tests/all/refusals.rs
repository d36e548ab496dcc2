//! Refusals of observers: nothing that is not finite is accepted or returned, and nothing is
//! changed then.

use kestirim_luenberger::{
    CurrentGains, CurrentObserver, DisturbanceGains, DisturbanceObserver, Error, Plant, Predictor,
    PredictorGains, ReducedGains, ReducedObserver, Saturation,
};
use kestirim_scalar::{Q8_24, Q12_20, Q16_16, Scalar};
use nalgebra::{Matrix1, Matrix1x2, Matrix2, Matrix3x2, SMatrix, SVector, Vector1, Vector2};
use proptest::prelude::*;

use crate::plant::{GAIN, GAINS, PLANT, START};

const CART: Plant<2, 1, 1> = Plant {
    a: Matrix2::new(1.0, 0.01, 0.0, 1.0),
    b: Vector2::new(0.000_05, 0.01),
    c: Matrix1x2::new(1.0, 0.0),
};

#[test]
fn wrong_states_are_refused() {
    let l = SMatrix::<f64, 1, 2>::zeros();
    for measured in [[0, 3], [1, 1], [usize::MAX, 0]] {
        let gains = ReducedGains::<3, 1, 2, 1>::new(&PLANT.a, &PLANT.b, &measured, &l);
        assert_eq!(gains.unwrap_err(), Error::WrongState);
    }
}

#[test]
fn limits_are_checked() {
    let new = |low, high| Saturation::new(&Vector1::new(low), &Vector1::new(high));
    assert_eq!(new(1.0, 0.0).unwrap_err(), Error::WrongLimits);
    assert_eq!(new(f64::NAN, 0.0).unwrap_err(), Error::WrongLimits);
    let limits = new(f64::MIN, 1.0).unwrap();
    assert_eq!(limits.applied(&Vector1::new(-1e300))[0], -1e300);
    assert_eq!(limits.applied(&Vector1::new(f64::INFINITY))[0], 1.0);
    assert!(limits.applied(&Vector1::new(f64::NAN))[0].is_nan());
}

/// In fixed point the innovation is summed in two steps: the first leaves the range, and the second comes back.
#[test]
fn a_difference_that_left_the_range_is_no_innovation() {
    let number = Q12_20::from_f64;
    let plant = Plant { a: Matrix1::new(1.0), b: Matrix1::new(0.0), c: Matrix1::new(1.0) };
    let one = Matrix1::new(1.0);
    let gains = DisturbanceGains::new(&plant, &one, &one, &Matrix1::new(0.1), &Matrix1::new(0.1));
    let (start, learnt) = (Vector1::new(number(-1500.0)), Vector1::new(number(5.0)));
    let mut observer =
        DisturbanceObserver::<Q12_20, 1, 1, 1, 1>::new(&gains, &start, &learnt).unwrap();
    let before = observer;
    let found = observer.step(&SVector::zeros(), &Vector1::new(number(1500.0)));
    assert_eq!((found, observer), (Err(Error::NotFinite), before));
}

fn refuses<T: Scalar>(bad: T) {
    let start = START.map(T::from_f64);
    let (u, y) = (SVector::from([T::ONE]), SVector::from([T::ONE, T::TWO]));
    let bad_u = SVector::from([bad]);
    let bad_y = [SVector::from([bad, T::ONE]), SVector::from([T::ONE, bad])];
    let bad_start = SVector::from([T::ONE, bad, T::ONE]);
    let zero = SVector::<T, 1>::zeros();

    let mut predictor = Predictor::<T, 3, 1, 2>::new(&GAINS, &start).unwrap();
    predictor.step(&u, &y).unwrap();
    let before = predictor;
    assert_eq!(predictor.step(&bad_u, &y), Err(Error::NotFinite));
    assert_eq!(predictor.coast(&bad_u), Err(Error::NotFinite));
    assert_eq!(predictor.reset(&bad_start), Err(Error::NotFinite));
    assert!(bad_y.iter().all(|y| predictor.step(&u, y) == Err(Error::NotFinite)));
    assert_eq!(predictor, before);
    assert!(Predictor::<T, 3, 1, 2>::new(&GAINS, &bad_start).is_err());

    let gains = CurrentGains::new(&PLANT, &GAIN);
    let mut current = CurrentObserver::<T, 3, 1, 2>::new(&gains, &start).unwrap();
    current.step(&u, &y).unwrap();
    let before = current;
    assert_eq!(current.predict(&bad_u), Err(Error::NotFinite));
    assert_eq!(current.step(&bad_u, &y), Err(Error::NotFinite));
    assert!(bad_y.iter().all(|y| current.correct(y) == Err(Error::NotFinite)));
    assert!(bad_y.iter().all(|y| current.step(&u, y) == Err(Error::NotFinite)));
    assert_eq!(current, before);

    let l = SMatrix::<f64, 1, 2>::new(3.0, 0.5);
    let gains = ReducedGains::<3, 1, 2, 1>::new(&PLANT.a, &PLANT.b, &[0, 2], &l).unwrap();
    let mut reduced = ReducedObserver::<T, 3, 1, 2, 1>::new(&gains, &zero, &y).unwrap();
    let before = reduced;
    assert_eq!(reduced.step(&bad_u, &y), Err(Error::NotFinite));
    assert!(bad_y.iter().all(|y| reduced.step(&u, y) == Err(Error::NotFinite)));
    assert!(bad_y.iter().all(|y| reduced.reset(&zero, y) == Err(Error::NotFinite)));
    assert_eq!(reduced, before);

    let (s, ld) = (SMatrix::<f64, 2, 1>::zeros(), SMatrix::<f64, 1, 2>::new(0.1, 0.1));
    let gains = DisturbanceGains::new(&PLANT, &PLANT.b, &s, &GAIN, &ld);
    let mut disturbance = DisturbanceObserver::<T, 3, 1, 2, 1>::new(&gains, &start, &zero).unwrap();
    let before = disturbance;
    assert_eq!(disturbance.step(&bad_u, &y), Err(Error::NotFinite));
    assert!(bad_y.iter().all(|y| disturbance.step(&u, y) == Err(Error::NotFinite)));
    assert_eq!(disturbance.reset(&start, &bad_u), Err(Error::NotFinite));
    assert_eq!(disturbance, before);
}

#[test]
fn what_is_not_finite_is_refused() {
    refuses(f64::NAN);
    refuses(f64::INFINITY);
    refuses(f32::NAN);
    refuses(f32::NEG_INFINITY);
    refuses(Q16_16::MAX);
    refuses(Q16_16::MIN);
    refuses(Q8_24::MAX);
}

#[test]
fn an_estimate_that_would_overflow_is_refused() {
    // The state doubles with every step.
    let plant = Plant { a: Matrix1::new(2.0), b: Matrix1::new(1.0), c: Matrix1::<f64>::new(1.0) };
    let gains = PredictorGains::new(&plant, &Matrix1::zeros());
    let start = SVector::from([Q16_16::from_f64(20_000.0)]);
    let mut observer = Predictor::<Q16_16, 1, 1, 1>::new(&gains, &start).unwrap();
    let zero = SVector::from([Q16_16::ZERO]);
    assert_eq!(observer.step(&zero, &zero), Err(Error::NotFinite));
    assert_eq!(*observer.estimate(), start);
}

#[test]
fn gains_must_fit() {
    let gains = |l| PredictorGains::new(&CART, &Vector2::new(l, 0.0));
    let fixed = |l| Predictor::<Q16_16, 2, 1, 1>::new(&gains(l), &SVector::zeros()).map(|_| ());
    assert_eq!(fixed(15_000.0), Ok(()));
    assert_eq!(fixed(40_000.0), Err(Error::TooLarge));
    assert_eq!(fixed(f64::NAN), Err(Error::NotFinite));
    assert_eq!(fixed(f64::INFINITY), Err(Error::NotFinite));
    let single = |l| Predictor::<f32, 2, 1, 1>::new(&gains(l), &SVector::zeros()).map(|_| ());
    assert_eq!(single(1e30), Ok(()));
    assert_eq!(single(1e60), Err(Error::TooLarge));
    let double = |l| Predictor::<f64, 2, 1, 1>::new(&gains(l), &SVector::zeros()).map(|_| ());
    assert_eq!(double(1e300), Err(Error::TooLarge));
    assert_eq!(double(f64::NAN), Err(Error::NotFinite));
}

proptest! {
    /// No gain and no sample makes an observer panic, or its state infinite.
    #[test]
    fn nothing_panics(
        gain in proptest::array::uniform6(any::<f64>()),
        samples in proptest::collection::vec(proptest::array::uniform3(any::<i32>()), 1..50),
    ) {
        let gain = Matrix3x2::from_column_slice(&gain);
        let small = gain.map(|gain| gain % 1e4);
        for gain in [gain, small] {
            let start = START.map(Q8_24::from_f64);
            let predictor = Predictor::new(&PredictorGains::new(&PLANT, &gain), &start);
            let current = CurrentObserver::new(&CurrentGains::new(&PLANT, &gain), &start);
            let (Ok(mut predictor), Ok(mut current)) = (predictor, current) else { continue };
            for sample in &samples {
                let [u, y0, y1] = sample.map(Q8_24::from_bits);
                let (u, y) = (SVector::from([u]), SVector::from([y0, y1]));
                let _ = (predictor.step(&u, &y), current.step(&u, &y));
                prop_assert!(Q8_24::all_finite(predictor.estimate().as_slice()));
                prop_assert!(Q8_24::all_finite(current.estimate().as_slice()));
            }
        }
    }
}
