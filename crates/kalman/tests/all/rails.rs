//! What leaves the range of fixed point, or of variances, is refused, and the estimate stays.

use kestirim_kalman::{
    ConstantVelocity, Covariance, Error, Gaussian, LinearObservation, SparseRow,
};
use kestirim_scalar::{Q8_24, Q12_20, Q16_16, Scalar};
use nalgebra::{Matrix2, SMatrix, SVector, Vector2, matrix};
use proptest::prelude::*;

fn estimate<T: Scalar>(mean: [f64; 2], p: &Matrix2<f64>) -> Gaussian<T, 2> {
    let mean = SVector::from(mean.map(T::from_f64));
    Gaussian::new(mean, Covariance::from_lower_triangle(&p.map(T::from_f64)))
}

#[test]
fn a_steep_measurement_leaves_no_negative_variance() {
    let number = Q12_20::from_f64;
    let covariance = Covariance::from_variances(&[number(2.0)]);
    let mut estimate = Gaussian::<Q12_20, 1>::new(SVector::zeros(), covariance);
    for _ in 0..1000 {
        let innovation = number(26.0) * (Q12_20::ONE - estimate.mean[0]);
        estimate.update(&SparseRow::new([(0, number(26.0))]), innovation, number(0.01)).unwrap();
        assert!(estimate.covariance.variances()[0] >= Q12_20::ZERO);
    }
    assert!((estimate.mean[0].to_f64() - 1.0).abs() < 0.01, "{}", estimate.mean[0]);
}

/// Updates by all rows, and returns how many of them were refused.
fn check_positive<T: Scalar>(p: &Matrix2<f64>, rows: &[[f64; 2]]) -> usize {
    let mut ours = estimate::<T>([0.0; 2], p);
    let mut refused = 0;
    for row in rows {
        let row = SparseRow::new([(0, T::from_f64(row[0])), (1, T::from_f64(row[1]))]);
        let before = ours;
        if ours.update(&row, T::from_f64(0.1), T::from_f64(0.01)).is_ok() {
            let p = ours.covariance.to_matrix().map(T::to_f64);
            assert!(p[(0, 0)] >= 0.0 && p[(1, 1)] >= 0.0 && p.determinant() >= -1e-3, "{p}");
        } else {
            assert_eq!(ours, before);
            refused += 1;
        }
    }
    refused
}

proptest! {
    #[test]
    fn no_variance_becomes_negative(
        (large, small, correlation) in (0.1..8.0_f64, 0.001..5.0_f64, -0.999..0.999_f64),
        // Steeper rows make an innovation's variance that does not fit into Q12.20.
        rows in prop::collection::vec([-8.0..8.0_f64, -8.0..8.0_f64], 1..30),
    ) {
        let both = correlation * (large * small).sqrt();
        let p = matrix![large, both; both, small];
        let refused = [
            check_positive::<Q12_20>(&p, &rows),
            check_positive::<Q16_16>(&p, &rows),
            check_positive::<f32>(&p, &rows),
        ];
        prop_assert_eq!(refused, [0; 3]);
    }
}

#[test]
fn a_variance_on_a_rail_is_not_taken_off_it() {
    let number = Q12_20::from_f64;
    // Widened by a factor of 20, the second variance does not fit.
    let before = estimate::<Q12_20>([0.0; 2], &matrix![1.0, 30.0; 30.0, 1500.0]);
    let mut widened = before;
    let row = SparseRow::new([(0, Q12_20::ONE)]);
    let weighed = widened.weigh(&row, number(22.4), number(0.01)).unwrap();
    assert_eq!(widened.correct_widened(&weighed, number(25.0)), Err(Error::NotFinite));
    assert_eq!(widened, before);
    // Nor does the first one after a shear, which cannot fail itself.
    let mut sheared = estimate::<Q12_20>([0.0; 2], &matrix![100.0, 0.0; 0.0, 100.0]);
    sheared.covariance.shear::<0, 1>(number(5.0));
    let before = sheared;
    let row = SparseRow::new([(1, Q12_20::ONE)]);
    assert_eq!(sheared.update(&row, Q12_20::ONE, number(0.01)), Err(Error::NotFinite));
    let found = sheared.update_component::<1>(Q12_20::ONE, number(0.01));
    assert_eq!((found, sheared), (Err(Error::NotFinite), before));
}

#[test]
fn a_step_too_long_for_the_format_is_refused() {
    let before = estimate::<Q12_20>([0.0; 2], &matrix![1.0, 0.0; 0.0, 0.1]);
    for (interval, density, decay) in
        [(20.0, 1.0, None), (60.0, 0.1, None), (60.0, 50.0, Some(1.0)), (300.0, 10.0, Some(20.0))]
    {
        let decay_time = decay.map(Q12_20::from_f64);
        let mut ours = before;
        let motion = ConstantVelocity::<Q12_20, 1>::new(
            Q12_20::from_f64(interval),
            Q12_20::from_f64(density),
        );
        let found = ours.advance(&ConstantVelocity { decay_time, ..motion });
        assert_eq!((found, ours), (Err(Error::NotFinite), before), "{interval} s");
    }
    // So is a speed that does not fit, with an acceleration that would take it back.
    let fast = estimate::<Q12_20>([0.0, -1500.0], &matrix![1.0, 0.0; 0.0, 0.1]);
    for (interval, acceleration) in [(1.2, 2000.0), (20.0, 10.0)] {
        let mut ours = fast;
        let acceleration = Some([Q12_20::from_f64(acceleration)]);
        let motion = ConstantVelocity::<Q12_20, 1>::new(Q12_20::from_f64(interval), Q12_20::ZERO);
        let found = ours.advance(&ConstantVelocity { acceleration, ..motion });
        assert_eq!((found, ours), (Err(Error::NotFinite), fast), "{interval} s");
    }
    // A known acceleration, 2000 m in twenty seconds, fits.
    let mut pushed = before;
    let acceleration = Some([Q12_20::from_f64(10.0)]);
    let motion = ConstantVelocity::<Q12_20, 1>::new(Q12_20::from_f64(20.0), Q12_20::ZERO);
    pushed.advance(&ConstantVelocity { acceleration, ..motion }).unwrap();
    assert!((pushed.mean[0].to_f64() - 2000.0).abs() < 0.01, "{}", pushed.mean[0]);
}

#[test]
fn no_number_is_no_measurement() {
    let identity = matrix![1.0, 0.0; 0.0, 1.0];
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for mean in [-3.0, 3.0] {
            let before = estimate::<Q12_20>([mean, mean], &identity);
            let mut ours = before;
            let row = SparseRow::new([(0, Q12_20::ONE)]);
            let measured = Q12_20::from_f32(wrong);
            let observation = LinearObservation { row, measured };
            let found = ours.observe(&observation, Q12_20::from_f64(0.01));
            assert_eq!((found, ours), (Err(Error::NotFinite), before));
            let rows = SMatrix::<Q12_20, 2, 2>::identity();
            let noise = Covariance::from_variances(&[Q12_20::ONE; 2]);
            let both = Vector2::new(Q12_20::ONE, measured);
            let found = ours.update_block(&rows, &both, &noise);
            assert_eq!((found.err(), ours), (Some(Error::NotFinite), before));
        }
    }
}

#[test]
fn a_gain_or_an_expectation_that_does_not_fit_is_refused() {
    let number = Q8_24::from_f64;
    let before = estimate::<Q8_24>([0.0; 2], &matrix![0.01, 0.8; 0.8, 100.0]);
    let mut ours = before;
    let row = SparseRow::new([(0, number(0.05))]);
    let found = ours.update(&row, number(0.001), number(1e-5));
    assert_eq!((found, ours), (Err(Error::NotFinite), before), "a gain of 229");
    let number = Q12_20::from_f64;
    let before = estimate::<Q12_20>([1500.0, 0.0], &matrix![1.0, 0.0; 0.0, 1.0]);
    let mut ours = before;
    let row = SparseRow::new([(0, number(2.0))]);
    let observation = LinearObservation { row, measured: number(2040.0) };
    let found = ours.observe(&observation, number(0.01));
    assert_eq!((found, ours), (Err(Error::NotFinite), before), "an expected 3000");
    let noise = Covariance::from_lower_triangle(&matrix![1.0, 0.0; 0.9, 1.0].map(number));
    let both = Vector2::new(number(1000.0), number(-1500.0));
    let found = ours.update_block(&SMatrix::<Q12_20, 2, 2>::identity(), &both, &noise);
    assert_eq!((found.err(), ours), (Some(Error::NotFinite), before), "a difference of -2400");
    // A step of 2673 from −100, which from the end of the range would lead to 1948.
    let before = estimate::<Q12_20>([0.0, -100.0], &matrix![1.0, 0.0; 9.0, 100.0]);
    let mut ours = before;
    let row = SparseRow::new([(0, Q12_20::ONE)]);
    let found = ours.update(&row, number(300.0), number(0.01));
    assert_eq!((found, ours), (Err(Error::NotFinite), before), "a step of 2673");
}

#[test]
fn a_process_noise_that_is_none_is_refused() {
    let before = estimate::<f64>([1.0, 2.0], &matrix![1.0, 0.0; 0.0, 1.0]);
    let one = Matrix2::identity();
    let noise = |matrix| Covariance::from_lower_triangle(&matrix);
    for (f, q, error) in [
        (one, noise(matrix![1.0, 0.0; f64::NAN, 1.0]), Error::NotFinite),
        (matrix![1.0, f64::NAN; 0.0, 1.0], noise(one), Error::NotFinite),
        (one, noise(matrix![1.0, 0.0; 0.0, -0.5]), Error::NotPositive),
    ] {
        let mut ours = before;
        assert_eq!((ours.predict(&f, &q), ours), (Err(error), before));
    }
}
