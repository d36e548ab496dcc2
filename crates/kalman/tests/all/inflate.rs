//! Inflating a block of the state leaves its covariances with the others.

use kestirim_kalman::{Covariance, Error};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SMatrix, matrix};
use proptest::prelude::*;

fn check<T: Scalar>(tolerance: f64) {
    let p = matrix![2.0, 0.5, 0.1; 0.5, 1.0, -0.3; 0.1, -0.3, 0.7].map(T::from_f64);
    let mut inflated = Covariance::<T, 3>::from_lower_triangle(&p);
    inflated.inflate(1, 2, T::from_f64(4.0)).expect("a factor");
    let expected = matrix![2.0, 0.5, 0.1; 0.5, 4.0, -1.2; 0.1, -1.2, 2.8];
    let found: SMatrix<f64, 3, 3> = inflated.to_matrix().map(T::to_f64);
    assert!((found - expected).abs().max() < tolerance, "{found}");
}

#[test]
fn the_block_grows_by_the_factor_and_nothing_else() {
    check::<f64>(1e-15);
    check::<f32>(1e-6);
    check::<Q12_20>(1e-5);
}

#[test]
fn what_makes_no_sense_changes_nothing() {
    let before = Covariance::from_variances(&[1.0, 2.0_f64]);
    let mut covariance = before;
    assert_eq!(covariance.inflate(1, 2, 2.0), Err(Error::IndexOutOfRange));
    assert_eq!(covariance.inflate(usize::MAX, 2, 2.0), Err(Error::IndexOutOfRange));
    assert_eq!(covariance.inflate(0, 1, 0.5), Err(Error::NotPositive));
    assert_eq!(covariance.inflate(0, 1, f64::NAN), Err(Error::NotFinite));
    assert_eq!(covariance.inflate(0, 2, f64::INFINITY), Err(Error::NotFinite));
    assert_eq!(covariance.inflate(1, 1, f64::MAX), Err(Error::NotFinite));
    assert_eq!(covariance, before);
}

proptest! {
    #[test]
    fn what_was_positive_stays_so(first in 0..3_usize, factor in 1.0..1e6_f64) {
        let p = matrix![1.0, 0.99, 0.5; 0.99, 1.0, 0.5; 0.5, 0.5, 1.0];
        let mut covariance = Covariance::from_lower_triangle(&p);
        covariance.inflate(first, 3 - first, factor).expect("a factor");
        prop_assert!(covariance.to_matrix().cholesky().is_some());
    }
}
