//! What is learnt, which guarantees hold, and how the published form fails, in every scalar.

use kestirim_adaptive_kalman::{
    AdaptiveKalman, Error, Learning, ProcessNoise, PublishedAdaptiveKalman,
};
use kestirim_kalman::{Covariance, Error as Refusal, Gaussian, Process, SparseRow};
use kestirim_scalar::{Components, Q12_20, Scalar};
use nalgebra::{SMatrix, SVector, matrix, vector};
use proptest::prelude::*;

/// A process of two coordinates that do not move.
struct Still;

impl<T: Scalar> Process<T, 2> for Still {
    fn advance(&self, _: &mut Gaussian<T, 2>) {}
}

/// Four measurements of two states, in directions all around.
const ROWS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [0.6, 0.8], [-0.8, 0.6]];

fn row<T: Scalar>(index: usize) -> SparseRow<T, 2> {
    SparseRow::new([(0, T::from_f64(ROWS[index][0])), (1, T::from_f64(ROWS[index][1]))])
}

fn adaptive<T: Scalar>() -> AdaptiveKalman<T, 2, 4> {
    let n = T::from_f64;
    let learning = Learning::new(n(0.95), n(0.0025), n(4.0)).unwrap();
    let process =
        ProcessNoise::new([n(1e-4); 2], [Learning::new(n(0.95), n(1e-5), n(0.01)).unwrap(); 2]);
    let start = Gaussian::new(SVector::zeros(), Covariance::from_variances(&[n(1.0), n(1.0)]));
    AdaptiveKalman::new(start, process, [n(0.01); 4], [learning; 4])
}

/// Feeds 400 epochs in which measurement 3 reads 1 m too long, and returns the filter and its final
/// error.
fn blocked<T: Scalar>(learn: bool) -> (AdaptiveKalman<T, 2, 4>, f64) {
    let mut filter = adaptive::<T>();
    for k in 0..400 {
        filter.predict(&Still).unwrap();
        for index in 0..4 {
            let ripple = [0.1, -0.1, 0.1, -0.1, -0.1, 0.1, -0.1, 0.1][(k + 3 * index) % 8];
            let truth = ROWS[index][0] * 2.0 - ROWS[index][1];
            let measured = truth + ripple + if index == 3 { 1.0 } else { 0.0 };
            let row = row::<T>(index);
            let innovation = T::from_f64(measured) - row.dot(&filter.estimate().mean).unwrap();
            if learn {
                filter.update(index, &row, innovation).unwrap();
            } else {
                filter.update_without_learning(index, &row, innovation).unwrap();
            }
        }
    }
    let [x, y] = *filter.estimate().mean.map(T::to_f64).as_array();
    (filter, (x - 2.0).hypot(y + 1.0))
}

fn check_blocked<T: Scalar>() {
    let (_, fixed) = blocked::<T>(false);
    let (filter, adapted) = blocked::<T>(true);
    assert!(fixed > 0.3, "{fixed}");
    assert!(adapted < 0.12, "{adapted}");
    let variances = filter.measurement_noise().map(|noise| noise.variance().to_f64());
    assert!(variances[3] > 0.5, "{variances:?}");
    assert!(variances[..3].iter().all(|variance| *variance < 0.1), "{variances:?}");
}

#[test]
fn a_measurement_that_contradicts_the_others_is_learnt_to_be_bad() {
    check_blocked::<f64>();
    check_blocked::<f32>();
    check_blocked::<Q12_20>();
}

#[test]
fn epochs_without_a_measurement_teach_nothing() {
    let (filter, _) = blocked::<f64>(true);
    let learnt = *filter.process_noise();
    let mut waiting = filter;
    waiting.predict(&Still).unwrap();
    let after_one = *waiting.process_noise();
    for _ in 0..100 {
        waiting.predict(&Still).unwrap();
    }
    assert_ne!(after_one, learnt, "the last epoch has taught");
    assert_eq!(*waiting.process_noise(), after_one);
}

#[test]
fn learning_must_make_sense() {
    for (forgetting, least, most) in [
        (1.1, 0.0, 1.0),
        (-0.1, 0.0, 1.0),
        (f32::NAN, 0.0, 1.0),
        (0.9, -1.0, 1.0),
        (0.9, 2.0, 1.0),
        (0.9, 0.0, f32::INFINITY),
        (0.9, f32::NAN, 1.0),
    ] {
        assert_eq!(Learning::new(forgetting, least, most), Err(Error::InvalidLearning));
    }
}

#[test]
fn an_unknown_measurement_is_refused() {
    let mut filter = adaptive::<f32>();
    assert_eq!(filter.update(4, &row(0), 0.0), Err(Error::NoSuchMeasurement));
    assert_eq!(filter.update_without_learning(4, &row(0), 0.0), Err(Error::NoSuchMeasurement));
}

fn check_anything<T: Scalar>(offered: &[(usize, f64)]) -> Result<(), TestCaseError> {
    let mut filter = adaptive::<T>();
    for &(index, innovation) in offered {
        let before = filter;
        let innovation = T::from_f64(innovation);
        if filter.update(index, &row(index.min(3)), innovation).is_err() {
            prop_assert_eq!(filter, before);
        }
        for noise in filter.measurement_noise() {
            let variance = noise.variance().to_f64();
            prop_assert!((0.002..=4.01).contains(&variance), "{}", variance);
        }
        filter.predict(&Still).unwrap();
        let p = filter.estimate().covariance.to_matrix().map(T::to_f64);
        prop_assert!(p[(0, 0)] > 0.0 && p.determinant() > 0.0);
        prop_assert!(filter.estimate().mean.iter().all(|x| x.is_finite()));
    }
    Ok(())
}

proptest! {
    #[test]
    fn whatever_is_measured_noise_stays_within_its_limits(
        offered in proptest::collection::vec((0_usize..5, prop_oneof![
            -10.0..10.0f64, -400.0..400.0f64, Just(f64::NAN), Just(f64::INFINITY), Just(-1e30),
        ]), 1..60)
    ) {
        check_anything::<f64>(&offered)?;
        check_anything::<f32>(&offered)?;
        check_anything::<Q12_20>(&offered)?;
    }
}

fn published<T: Scalar>(
    p0: f64,
    q0: f64,
    r0: f64,
    alpha_r: f64,
) -> PublishedAdaptiveKalman<T, 2, 4> {
    let n = T::from_f64;
    let start = Gaussian::new(SVector::zeros(), Covariance::from_variances(&[n(p0); 2]));
    let (q, r) = (Covariance::from_variances(&[n(q0); 2]), Covariance::from_variances(&[n(r0); 4]));
    PublishedAdaptiveKalman::new(start, q, r, n(0.95), n(alpha_r)).unwrap()
}

fn rows<T: Scalar>() -> SMatrix<T, 4, 2> {
    SMatrix::from_fn(|i, j| T::from_f64(ROWS[i][j]))
}

#[test]
fn one_published_step_is_the_papers_equations() {
    let mut filter = published::<f64>(0.5, 0.01, 0.2, 0.7);
    let innovation = vector![0.3, -0.2, 0.5, 0.1];
    let (p, r) = (matrix![0.5, 0.0; 0.0, 0.5], SMatrix::<f64, 4, 4>::identity() * 0.2);
    filter.update(&rows(), &innovation).unwrap();
    let h = rows::<f64>();
    let s = h * p * h.transpose() + r;
    let gain = p * h.transpose() * s.try_inverse().unwrap();
    let eq_18 = r * 0.7 + (innovation * innovation.transpose() - h * p * h.transpose()) * 0.3;
    assert!((filter.measurement_noise().to_matrix() - eq_18).abs().max() < 1e-12);
    assert!((filter.estimate().mean - gain * innovation).abs().max() < 1e-12);
    // The adapted Q takes effect in the next prediction.
    let posterior = filter.estimate().covariance.to_matrix();
    filter.predict(&Still).unwrap();
    let moved = gain * innovation;
    let eq_19 = SMatrix::<f64, 2, 2>::identity() * 0.01 * 0.95 + moved * moved.transpose() * 0.05;
    let q = filter.estimate().covariance.to_matrix() - posterior;
    assert!((q - eq_19).abs().max() < 1e-12, "{q} {eq_19}");
}

#[test]
fn the_published_form_is_refused_when_it_turns_indefinite() {
    let mut filter = published::<f32>(0.5, 0.01, 0.01, 0.7);
    filter.update(&rows(), &SVector::zeros()).unwrap();
    let before = filter;
    let refused = filter.update(&rows(), &SVector::zeros());
    assert_eq!(refused, Err(Error::Estimate(Refusal::NotPositive)));
    assert_eq!(filter, before);
}

fn check_frozen<T: Scalar>() {
    // The true position is 0.5 m from the start, and every measurement says so, for 50 epochs.
    let (mut filter, h) = (published::<T>(1e-4, 3e-5, 0.1, 0.95), rows::<T>());
    let truth = vector![0.3, -0.4].map(T::from_f64);
    for _ in 0..50 {
        filter.predict(&Still).unwrap();
        let innovation = h * (truth - filter.estimate().mean);
        let report = filter.update(&h, &innovation).unwrap();
        assert!(report.nis.to_f64() < 9.5, "within 95 % of four degrees of freedom");
    }
    let left = (truth - filter.estimate().mean).map(T::to_f64).norm();
    assert!(left > 0.35, "{left}");
}

#[test]
fn the_published_form_stays_where_it_was_started_and_feels_well() {
    check_frozen::<f64>();
    check_frozen::<f32>();
}
