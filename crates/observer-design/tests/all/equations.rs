//! Discretisation, Riccati and Lyapunov equations, responses.

use kestirim_observer_design::{
    Complex, Error, Mode, StateSpace, controllability, discrete_noise, error_covariance, lyapunov,
    riccati, singular_values, tustin, zero_order_hold,
};
use nalgebra::{Matrix1, Matrix2, RowVector2, SMatrix, Vector1, Vector2, matrix};
use proptest::prelude::*;

fn close<const R: usize, const C: usize>(
    found: &SMatrix<f64, R, C>,
    expected: &SMatrix<f64, R, C>,
    tolerance: f64,
) {
    for (found, expected) in found.iter().zip(expected.iter()) {
        assert!(
            (found - expected).abs() <= tolerance * expected.abs(),
            "{found} instead of {expected}"
        );
    }
}

#[test]
fn an_integrator_is_discretised_although_it_is_singular() {
    let (a, b) = (matrix![0.0, 1.0; 0.0, 0.0], Vector2::new(0.0, 1.0));
    let step = zero_order_hold(&a, &b, 0.25).unwrap();
    assert_eq!((step.a, step.b), (matrix![1.0, 0.25; 0.0, 1.0], Vector2::new(0.03125, 0.25)));
    let trapezoid = tustin(&a, &b, 0.25).unwrap();
    assert_eq!((trapezoid.a, trapezoid.b), (step.a, step.b));
    // ∫ [s; 1][s 1] ds
    let noise = discrete_noise(&a, &(b * b.transpose()), 0.25).unwrap();
    close(&noise, &matrix![0.25 / 48.0, 0.03125; 0.03125, 0.25], 1e-16);
}

#[test]
fn a_decay_is_discretised_over_any_interval() {
    for interval in [1e-9, 1e-3, 1.0, 40.0] {
        let step = zero_order_hold(&Matrix1::new(-2.0), &Vector1::new(3.0), interval).unwrap();
        close(&step.a, &Matrix1::new((-2.0 * interval).exp()), 1e-15);
        close(&step.b, &Vector1::new(-1.5 * (-2.0 * interval).exp_m1()), 4e-16);
        let noise = discrete_noise(&Matrix1::new(-2.0), &Matrix1::new(1.0), interval).unwrap();
        close(&noise, &Matrix1::new(-0.25 * (-4.0 * interval).exp_m1()), 4e-16);
    }
}

#[test]
fn what_cannot_be_discretised_is_refused() {
    let (a, b) = (Matrix1::new(-2.0), Vector1::new(3.0));
    assert_eq!(zero_order_hold(&a, &b, 0.0), Err(Error::Interval));
    assert_eq!(zero_order_hold(&a, &b, -1.0), Err(Error::Interval));
    assert_eq!(zero_order_hold(&a, &b, f64::NAN), Err(Error::NotFinite));
    assert_eq!(zero_order_hold(&Matrix1::new(1e3), &b, 1.0), Err(Error::NotFinite), "e^1000");
    assert_eq!(zero_order_hold(&Matrix1::new(1e300), &b, 1e9), Err(Error::NotFinite));
    assert_eq!(tustin(&Matrix1::new(2.0), &b, 1.0), Err(Error::Singular), "its pole is at 2/h");
}

fn scalar(a: f64, c: f64, q: f64, r: f64) -> Result<f64, Error> {
    let one = Matrix1::new;
    riccati(&one(a), &one(c), &one(q), &one(r)).map(|settled| settled.prior[(0, 0)])
}

#[test]
fn the_riccati_equation_has_its_stabilising_solution() {
    let golden = 0.5_f64.mul_add(5.0_f64.sqrt(), 0.5);
    assert!((scalar(1.0, 1.0, 1.0, 1.0).unwrap() - golden).abs() < 1e-15);
    // Nothing drives a growing mode, but it must be followed all the same.
    assert!((scalar(2.0, 1.0, 0.0, 1.0).unwrap() - 3.0).abs() < 1e-14);
    // Nothing drives a decaying mode, so in the end it is known.
    assert_eq!(scalar(0.5, 1.0, 0.0, 1.0), Ok(0.0));
    // No inverse of A is needed.
    let delays = riccati(
        &matrix![0.0, 1.0; 0.0, 0.0],
        &matrix![1.0, 0.0],
        &matrix![0.0, 0.0; 0.0, 1.0],
        &Matrix1::new(1.0),
    );
    assert_eq!(delays.unwrap().prior, Matrix2::identity());
}

#[test]
fn gains_and_covariances_fit_together() {
    let a = matrix![1.0, 0.1; 0.0, 1.0];
    let c = RowVector2::new(1.0, 0.0);
    let settled = riccati(&a, &c, &matrix![2.5e-5, 5e-4; 5e-4, 1e-2], &Matrix1::new(0.04)).unwrap();
    close(&settled.predictor_gain, &(a * settled.filter_gain), 1e-15);
    close(
        &settled.posterior,
        &((Matrix2::identity() - settled.filter_gain * c) * settled.prior),
        1e-13,
    );
    // The error covariance of the observer with this gain is the prior: two equations, one answer.
    let process = (&Matrix2::identity(), &matrix![2.5e-5, 5e-4; 5e-4, 1e-2]);
    let covariance =
        error_covariance((&a, &c), &settled.predictor_gain, process, &Matrix1::new(0.04)).unwrap();
    close(&covariance, &settled.prior, 1e-14);
}

#[test]
fn equations_without_a_steady_state_are_refused() {
    let lasting = |result: Result<f64, Error>| match result {
        Err(Error::Undetectable(mode) | Error::Undriven(mode)) => mode,
        other => panic!("expected a lasting mode, found {other:?}"),
    };
    assert_eq!(lasting(scalar(1.0, 0.0, 1.0, 1.0)), Mode { re: 1.0, im: 0.0, state: 0 });
    assert_eq!(lasting(scalar(1.0, 1.0, 0.0, 1.0)), Mode { re: 1.0, im: 0.0, state: 0 });
    assert_eq!(scalar(1.0, 1.0, 1.0, 0.0), Err(Error::NotPositive));
    assert_eq!(scalar(1.0, 1.0, -1.0, 1.0), Err(Error::NotPositive));
    assert_eq!(scalar(f64::NAN, 1.0, 1.0, 1.0), Err(Error::NotFinite));
    let skew = matrix![0.1, 0.05; 0.0, 0.1];
    let refused =
        riccati(&matrix![1.0, 0.1; 0.0, 1.0], &matrix![1.0, 0.0], &skew, &Matrix1::new(1.0));
    assert_eq!(refused, Err(Error::NotSymmetric));
    assert!(matches!(lyapunov(&Matrix1::new(1.0), &Matrix1::new(1.0)), Err(Error::Unstable(_))));
    let unmoved = controllability(&matrix![1.0, 0.0; 0.0, 0.5], &Vector2::new(1.0, 0.0));
    assert_eq!(unmoved, Err(Error::Uncontrollable(Mode { re: 0.5, im: 0.0, state: 1 })));
}

proptest! {
    /// P − F P Fᵀ = Q for any F and Q.
    #[test]
    fn the_lyapunov_equation_holds(f in prop::array::uniform4(-0.5_f64..0.5), q in prop::array::uniform4(-1.0_f64..1.0)) {
        let f = Matrix2::from_row_slice(&f);
        let factor = Matrix2::from_row_slice(&q);
        let q = factor * factor.transpose();
        let p = lyapunov(&f, &q).unwrap();
        let rest = p - f * p * f.transpose() - q;
        prop_assert!(rest.iter().all(|rest| rest.abs() <= 1e-15 * (1.0 + p.norm())));
    }

    #[test]
    fn anything_is_answered(
        a in prop::array::uniform4(prop::num::f64::ANY),
        c in prop::array::uniform2(prop::num::f64::ANY),
        q in prop::array::uniform4(prop::num::f64::ANY),
        r in prop::num::f64::ANY,
    ) {
        let (a, q) = (Matrix2::from_row_slice(&a), Matrix2::from_row_slice(&q));
        let c = RowVector2::from_row_slice(&c);
        if let Ok(settled) = riccati(&a, &c, &q, &Matrix1::new(r)) {
            prop_assert!(settled.prior.iter().all(|value| value.is_finite()));
        }
        let _ = lyapunov(&a, &q);
        let _ = zero_order_hold(&a, &c.transpose(), r);
    }
}

/// A mass on a spring: ẍ = −4 x − 0.4 ẋ + u.
fn spring() -> StateSpace<2, 1, 1> {
    StateSpace::new(
        matrix![0.0, 1.0; -4.0, -0.4],
        Vector2::new(0.0, 1.0),
        RowVector2::new(1.0, 0.0),
    )
}

#[test]
fn a_spring_answers_as_in_the_textbook() {
    let gain = |omega: f64| spring().frequency_response(omega).unwrap()[(0, 0)];
    assert_eq!(gain(0.0), Complex::from(0.25));
    assert_eq!(gain(2.0), Complex::new(0.0, -1.25));
    assert_eq!(spring().transfer(Complex::new(f64::NAN, 0.0)), Err(Error::NotFinite));
    let undamped = StateSpace { a: matrix![0.0, 1.0; -4.0, 0.0], ..spring() };
    assert_eq!(undamped.frequency_response(2.0), Err(Error::Singular));

    let time = 1.7_f64;
    let omega = (4.0_f64 - 0.04).sqrt();
    let impulse = (-0.2 * time).exp() * (omega * time).sin() / omega;
    let found = spring().impulse_response(&Vector1::new(1.0), 0.1).unwrap().nth(17).unwrap()[0];
    assert!((found - impulse).abs() < 1e-15, "{found} instead of {impulse}");
    let step = 0.25
        - 0.25 * (-0.2 * time).exp() * ((omega * time).cos() + 0.2 / omega * (omega * time).sin());
    let found = spring().step_response(&Vector1::new(1.0), 0.1).unwrap().nth(17).unwrap()[0];
    assert!((found - step).abs() < 1e-15, "{found} instead of {step}");
}

#[test]
fn singular_values_are_gains_in_the_best_and_the_worst_direction() {
    let i = Complex::new(0.0, 1.0);
    let one = Complex::from(1.0);
    // A rotation with different scales: 3 and 1e-9.
    let matrix = matrix![one * 3.0 * 0.6, i * 1e-9 * -0.8; i * 3.0 * 0.8, one * 1e-9 * -0.6];
    let [largest, least] = singular_values(&matrix);
    assert!(
        (largest - 3.0).abs() < 1e-15 && (least / 1e-9 - 1.0).abs() < 1e-15,
        "{largest} {least}"
    );
    assert_eq!(singular_values(&matrix![one, one])[1], 0.0);
}

#[test]
fn rounding_does_not_make_a_covariance_skew() {
    let settled = |q: Matrix2<f64>| {
        riccati(&(Matrix2::identity() * 0.5), &matrix![1.0, 0.0], &q, &Matrix1::new(1.0))
    };
    assert!(settled(matrix![1.0, 1e-18; -1e-18, 1.0]).is_ok());
    assert_eq!(settled(matrix![1.0, 1e-3; -1e-3, 1.0]), Err(Error::NotSymmetric));
    let noise = discrete_noise(&Matrix2::identity(), &matrix![1.0, 5.0; 0.0, -3.0], 0.1);
    assert_eq!(noise, Err(Error::NotSymmetric));
}

#[test]
fn a_mode_that_grows_is_told_from_one_beside_it_that_decays() {
    let a = matrix![1.0 - 3e-7, 0.0; 0.0, 1.0 + 3e-7];
    let refused = riccati(&a, &matrix![0.0, 0.0], &Matrix2::identity(), &Matrix1::new(1.0));
    assert!(matches!(refused, Err(Error::Undetectable(Mode { state: 1, .. }))), "{refused:?}");
    let refused = lyapunov(&matrix![0.5, 0.0; 0.0, 1.2], &Matrix2::identity());
    assert!(matches!(refused, Err(Error::Unstable(Mode { state: 1, .. }))), "{refused:?}");
}

#[test]
fn a_response_that_overflows_is_refused() {
    let huge = StateSpace::new(Matrix1::new(1e-300), Matrix1::new(1e300), Matrix1::new(1e300));
    assert_eq!(huge.frequency_response(0.0), Err(Error::NotFinite));
    let [value] = singular_values(&matrix![Complex::from(3e200); Complex::from(4e200)]);
    assert!((value / 5e200 - 1.0).abs() < 1e-15);
}
