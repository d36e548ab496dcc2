//! Each observer compared with its own definition.

use kestirim_kalman::{Covariance, steady_state};
use kestirim_luenberger::{
    CurrentGains, CurrentObserver, DisturbanceGains, DisturbanceObserver, Plant, Predictor,
    PredictorGains, ReducedGains, ReducedObserver, Saturation,
};
use kestirim_scalar::{Q16_16, Scalar};
use nalgebra::{
    Matrix1, Matrix1x2, Matrix2, Matrix2x1, SMatrix, SVector, Vector1, Vector2, Vector3,
};
use proptest::prelude::*;

use crate::plant::{GAIN, GAINS, PLANT, START};

/// Inputs and outputs without a pattern.
fn signals(k: u32) -> (Vector1<f64>, Vector2<f64>) {
    let t = f64::from(k);
    (Vector1::new((0.3 * t).sin()), Vector2::new((1.7 * t).cos(), 3.0 + (0.9 * t * t).sin()))
}

fn assert_close<const N: usize>(a: &SVector<f64, N>, b: &SVector<f64, N>, most: f64) {
    assert!((a - b).amax() < most, "{a} or {b}");
}

#[test]
fn a_predictor_is_its_equation() {
    let mut observer = Predictor::<f64, 3, 1, 2>::new(&GAINS, &START).unwrap();
    let mut expected = START;
    for k in 0..500 {
        let (u, y) = signals(k);
        let innovation = y - PLANT.c * expected;
        assert_close(&observer.innovation(&y), &innovation, 1e-13);
        expected = PLANT.a * expected + PLANT.b * u + GAIN * innovation;
        observer.step(&u, &y).unwrap();
        assert_close(observer.estimate(), &expected, 1e-13);
    }
    observer.coast(&Vector1::new(0.5)).unwrap();
    assert_close(observer.estimate(), &(PLANT.a * expected + PLANT.b * 0.5), 1e-13);
    observer.reset(&START).unwrap();
    assert_eq!(*observer.estimate(), START);
}

#[test]
fn a_current_observer_is_its_equations() {
    let gains = CurrentGains::new(&PLANT, &GAIN);
    let mut observer = CurrentObserver::<f64, 3, 1, 2>::new(&gains, &START).unwrap();
    let mut halves = observer;
    let mut expected = START;
    for k in 0..500 {
        let (u, y) = signals(k);
        let prior = PLANT.a * expected + PLANT.b * u;
        expected = prior + GAIN * (y - PLANT.c * prior);
        assert_close(&observer.step(&u, &y).unwrap(), &(y - PLANT.c * prior), 1e-13);
        assert_close(observer.estimate(), &expected, 1e-13);
        halves.predict(&u).unwrap();
        assert_close(halves.estimate(), &prior, 1e-13);
        halves.correct(&y).unwrap();
        assert_eq!(halves, observer);
    }
}

/// With K = A⁻¹ L, the prediction of the current form is the estimate of the predictor.
#[test]
fn both_forms_agree() {
    let k = PLANT.a.try_inverse().unwrap() * GAIN;
    let gains = CurrentGains::new(&PLANT, &k);
    let mut predictor = Predictor::<f64, 3, 1, 2>::new(&GAINS, &START).unwrap();
    let mut current = CurrentObserver::<f64, 3, 1, 2>::new(&gains, &START).unwrap();
    for k in 0..500 {
        let (u, y) = signals(k);
        assert_close(predictor.estimate(), current.estimate(), 1e-12);
        current.correct(&y).unwrap();
        current.predict(&u).unwrap();
        predictor.step(&u, &y).unwrap();
    }
}

/// The gain of a settled filter, in either form, gives the estimates of the filter itself once that has settled.
#[test]
fn a_settled_kalman_filter_is_an_observer() {
    let q = Covariance::from_variances(&[0.01, 0.02, 0.005]);
    let r = Covariance::from_variances(&[0.1, 0.3]);
    let settled = steady_state(&PLANT.a, &q, &PLANT.c, &r).unwrap();
    let mut filter = kestirim_kalman::Gaussian::new(START, settled.prior);
    let gains = CurrentGains::new(&PLANT, &settled.gain);
    let mut current = CurrentObserver::<f64, 3, 1, 2>::new(&gains, &START).unwrap();
    let gains = PredictorGains::new(&PLANT, &(PLANT.a * settled.gain));
    let mut predictor = Predictor::<f64, 3, 1, 2>::new(&gains, &START).unwrap();
    for k in 0..500 {
        let (u, y) = signals(k);
        filter.update_block(&PLANT.c, &(y - PLANT.c * filter.mean), &r).unwrap();
        current.correct(&y).unwrap();
        assert_close(current.estimate(), &filter.mean, 1e-9);
        filter.predict(&PLANT.a, &q).unwrap();
        filter.mean += PLANT.b * u;
        current.predict(&u).unwrap();
        predictor.step(&u, &y).unwrap();
        assert_close(predictor.estimate(), &filter.mean, 1e-9);
    }
}

fn reduced<T: Scalar>(most: f64) {
    // States 2 and 0 are measured, in this order.
    let l = SMatrix::<f64, 1, 2>::new(0.5, 3.0);
    let gains = ReducedGains::<3, 1, 2, 1>::new(&PLANT.a, &PLANT.b, &[2, 0], &l).unwrap();
    let pole = 0.9 - (0.5 * 0.0 + 3.0 * 0.1);
    let mut state = START;
    let seen = |state: &Vector3<f64>| SVector::from([state[2], state[0]].map(T::from_f64));
    let zero = SVector::<T, 1>::zeros();
    let mut observer = ReducedObserver::<T, 3, 1, 2, 1>::new(&gains, &zero, &seen(&state)).unwrap();
    assert!(observer.unmeasured(&seen(&state))[0].abs().to_f64() < most);
    let mut error = -2.0;
    for k in 0..50 {
        let (u, _) = signals(k);
        let estimate = observer.estimate(&seen(&state)).map(T::to_f64);
        assert_close(&(state - estimate), &Vector3::new(0.0, error, 0.0), most);
        observer.step(&u.map(T::from_f64), &seen(&state)).unwrap();
        state = PLANT.a * state + PLANT.b * u;
        error *= pole;
    }
    observer.reset(&SVector::from([T::TWO]), &seen(&state)).unwrap();
    assert!((observer.unmeasured(&seen(&state))[0] - T::TWO).abs().to_f64() < most);
}

#[test]
fn a_reduced_observer_finds_what_is_not_measured() {
    reduced::<f64>(1e-13);
    reduced::<f32>(1e-5);
    reduced::<Q16_16>(3e-4);
}

/// A cart whose actuator saturates and is subject to a constant offset.
const CART: Plant<2, 1, 1> = Plant {
    a: Matrix2::new(1.0, 0.01, 0.0, 1.0),
    b: Vector2::new(0.000_05, 0.01),
    c: Matrix1x2::new(1.0, 0.0),
};

fn pushed<T: Scalar>(most: f64) {
    // Three poles at 0.9, with the characteristic polynomial (z − 0.9)³.
    let (l, ld) = (Vector2::new(0.3, 2.95), Matrix1::new(10.0));
    let gains = DisturbanceGains::new(&CART, &CART.b, &Matrix1::zeros(), &l, &ld);
    let mut observer =
        DisturbanceObserver::<T, 2, 1, 1, 1>::new(&gains, &SVector::zeros(), &SVector::zeros())
            .unwrap();
    let limits =
        Saturation::new(&SVector::from([T::from_f64(-1.0)]), &SVector::from([T::from_f64(0.5)]))
            .unwrap();
    let mut state = Vector2::new(1.0, 0.5);
    for k in 0..1000 {
        let command = T::from_f64(2.0 * (f64::from(k) / 100.0).sin());
        let applied = limits.applied(&SVector::from([command]));
        let measured = SVector::from([T::from_f64(state[0])]);
        let innovation = observer.step(&applied, &measured).unwrap();
        let force = applied[0].to_f64();
        assert!(force == command.to_f64().clamp(-1.0, 0.5));
        state = CART.a * state + CART.b * (force + 0.3);
        assert!(k < 500 || innovation[0].abs().to_f64() < most);
    }
    assert!((observer.disturbance()[0].to_f64() - 0.3).abs() < 100.0 * most);
    assert!((observer.estimate()[1].to_f64() - state[1]).abs() < 10.0 * most);
    assert!((observer.estimate()[0].to_f64() - state[0]).abs() < most);
}

#[test]
fn a_constant_disturbance_is_learnt() {
    pushed::<f64>(1e-12);
    pushed::<f32>(3e-6);
    pushed::<Q16_16>(1e-4);
}

#[test]
fn the_bias_of_a_sensor_is_learnt() {
    // A stable lag measured by two sensors, the second of which has a bias.
    let plant = Plant { a: Matrix1::new(0.95), b: Matrix1::new(0.05), c: Matrix2x1::new(1.0, 1.0) };
    let (s, l, ld) =
        (Matrix2x1::new(0.0, 1.0), Matrix1x2::new(0.2, 0.0), Matrix1x2::new(-0.1, 0.1));
    let gains = DisturbanceGains::new(&plant, &Matrix1::zeros(), &s, &l, &ld);
    let mut observer =
        DisturbanceObserver::<f64, 1, 1, 2, 1>::new(&gains, &Vector1::zeros(), &Vector1::zeros())
            .unwrap();
    let mut state = 2.0;
    for _ in 0..1000 {
        observer.step(&Vector1::new(1.0), &Vector2::new(state, state + 0.7)).unwrap();
        state = 0.95 * state + 0.05;
    }
    assert!((observer.disturbance()[0] - 0.7).abs() < 1e-12);
    assert!((observer.estimate()[0] - state).abs() < 1e-12);
    assert!(observer.innovation(&Vector2::new(state, state + 0.7)).amax() < 1e-12);
}

proptest! {
    /// e⁺ = (A − L C) e: observers of two plants with different inputs and equal initial errors keep equal
    /// errors.
    #[test]
    fn the_error_does_not_depend_on_the_input(
        inputs in proptest::collection::vec((-9.0..9.0_f64, -9.0..9.0_f64), 1..200),
        offset in proptest::array::uniform3(-9.0..9.0_f64),
    ) {
        let offset = SVector::from(offset);
        let mut states = [START, -START];
        let mut observers =
            states.map(|state| Predictor::<f64, 3, 1, 2>::new(&GAINS, &(state + offset)).unwrap());
        for (first, second) in inputs {
            for (k, input) in [first, second].map(Vector1::new).into_iter().enumerate() {
                observers[k].step(&input, &(PLANT.c * states[k])).unwrap();
                states[k] = PLANT.a * states[k] + PLANT.b * input;
            }
            let errors = [0, 1].map(|k| observers[k].estimate() - states[k]);
            prop_assert!((errors[0] - errors[1]).amax() < 1e-11);
        }
    }
}
