//! Shears, sparse rows and component updates against the dense textbook formulas, in every scalar.

use kestirim_kalman::{Covariance, Error, Gaussian, SparseRow};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SMatrix, SVector};
use proptest::prelude::*;

type Matrix4 = SMatrix<f64, 4, 4>;
type Vector4 = SVector<f64, 4>;

/// A positive definite P whose variances span a few orders of magnitude.
fn covariance() -> impl Strategy<Value = Matrix4> {
    proptest::array::uniform16(-1.0..1.0f64).prop_map(|entries| {
        let root = Matrix4::from_row_slice(&entries);
        root * root.transpose() + Matrix4::identity() * 0.05
    })
}

fn vector() -> impl Strategy<Value = Vector4> {
    proptest::array::uniform4(-5.0..5.0f64).prop_map(Vector4::from)
}

fn cast<T: Scalar, const R: usize, const C: usize>(m: &SMatrix<f64, R, C>) -> SMatrix<T, R, C> {
    m.map(T::from_f64)
}

fn gaussian<T: Scalar>(mean: &Vector4, covariance: &Matrix4) -> Gaussian<T, 4> {
    Gaussian::new(cast(mean), Covariance::from_lower_triangle(&cast(covariance)))
}

fn assert_close<T: Scalar>(
    ours: &Gaussian<T, 4>,
    mean: &Vector4,
    covariance: &Matrix4,
    tolerance: f64,
) {
    let mean_error = (ours.mean.map(T::to_f64) - mean).abs().max();
    let covariance_error = (ours.covariance.to_matrix().map(T::to_f64) - covariance).abs().max();
    assert!(mean_error <= tolerance, "mean off by {mean_error}");
    assert!(covariance_error <= tolerance, "covariance off by {covariance_error}");
}

/// Runs one check in the three scalars, each with its own tolerance.
macro_rules! in_every_scalar {
    ($check:ident($($argument:expr),*)) => {
        $check::<f64>($($argument,)* 1e-11);
        $check::<f32>($($argument,)* 3e-5);
        $check::<Q12_20>($($argument,)* 5e-5);
    };
}

fn check_shear<T: Scalar>(p: &Matrix4, a: f64, tolerance: f64) {
    let mut ours = gaussian::<T>(&Vector4::zeros(), p);
    ours.covariance.shear::<0, 2>(T::from_f64(a));
    ours.covariance.shear::<3, 1>(T::from_f64(a));
    let mut first = Matrix4::identity();
    first[(0, 2)] = a;
    let mut second = Matrix4::identity();
    second[(3, 1)] = a;
    let f = second * first;
    assert_close(&ours, &Vector4::zeros(), &(f * p * f.transpose()), tolerance);
}

fn check_outer<T: Scalar>(p: &Matrix4, v: &Vector4, tolerance: f64) {
    let mut ours = gaussian::<T>(&Vector4::zeros(), p);
    ours.covariance.add_outer(&v.map(T::from_f64));
    assert_close(&ours, &Vector4::zeros(), &(p + v * v.transpose()), tolerance);
}

fn check_predict<T: Scalar>(x: &Vector4, p: &Matrix4, f: &Matrix4, tolerance: f64) {
    let mut ours = gaussian::<T>(x, p);
    let q = Covariance::from_variances(&[T::from_f64(0.1); 4]);
    ours.predict(&cast(f), &q).unwrap();
    let expected = f * p * f.transpose() + Matrix4::identity() * 0.1;
    assert_close(&ours, &(f * x), &expected, tolerance);
}

fn check_update<T: Scalar>(x: &Vector4, p: &Matrix4, (a, b): (f64, f64), z: f64, tolerance: f64) {
    let r = 0.2;
    let mut ours = gaussian::<T>(x, p);
    let row = SparseRow::new([(3, T::from_f64(a)), (1, T::from_f64(b))]);
    let innovation = T::from_f64(z) - row.dot(&ours.mean).unwrap();
    let report = ours.update(&row, innovation, T::from_f64(r)).unwrap();

    let h = SMatrix::<f64, 1, 4>::new(0.0, b, 0.0, a);
    let s = (h * p * h.transpose())[(0, 0)] + r;
    let k = p * h.transpose() / s;
    let nu = z - (h * x)[(0, 0)];
    assert_close(&ours, &(x + k * nu), &(p - k * h * p), tolerance);
    assert!((report.nis.to_f64() - nu * nu / s).abs() < tolerance * (10.0 + nu * nu / s));
}

fn check_component<T: Scalar>(x: &Vector4, p: &Matrix4, z: f64, tolerance: f64) {
    let mut by_row = gaussian::<T>(x, p);
    let mut by_component = by_row;
    let innovation = T::from_f64(z) - by_row.mean[2];
    let r = T::from_f64(0.2);
    let row = SparseRow::new([(2, T::ONE)]);
    let first = by_row.update(&row, innovation, r).unwrap();
    let second = by_component.update_component::<2>(innovation, r).unwrap();
    assert_eq!(first, second);
    let p = by_row.covariance.to_matrix().map(T::to_f64);
    assert_close(&by_component, &by_row.mean.map(T::to_f64), &p, tolerance);
}

proptest! {
    #[test]
    fn a_shear_is_the_dense_product(p in covariance(), a in -2.0..2.0f64) {
        in_every_scalar!(check_shear(&p, a));
    }

    #[test]
    fn an_outer_product_is_the_dense_one(p in covariance(), v in vector()) {
        in_every_scalar!(check_outer(&p, &v));
    }

    #[test]
    fn a_prediction_is_the_dense_product(x in vector(), p in covariance(), f in covariance()) {
        in_every_scalar!(check_predict(&x, &p, &(f * 0.5)));
    }

    #[test]
    fn a_sparse_update_is_the_dense_one(
        x in vector(), p in covariance(), h in (-2.0..2.0f64, -2.0..2.0f64), z in -5.0..5.0f64,
    ) {
        in_every_scalar!(check_update(&x, &p, h, z));
    }

    #[test]
    fn a_component_update_is_one_with_a_unit_row(x in vector(), p in covariance(), z in -5.0..5.0f64) {
        in_every_scalar!(check_component(&x, &p, z));
    }

    #[test]
    fn whatever_is_fed_in_an_error_leaves_the_estimate_alone(
        innovation in any::<f32>(), variance in any::<f32>(), h in any::<f32>(), index in 0..6usize,
    ) {
        let before = gaussian::<f32>(&Vector4::zeros(), &Matrix4::identity());
        let mut after = before;
        let outcome = after.update(&SparseRow::new([(index, h)]), innovation, variance);
        prop_assert!(outcome.is_ok() || after == before);
        prop_assert!(after.mean.iter().all(|x| x.is_finite()) && after.covariance.is_finite());
    }
}

#[test]
fn each_error_has_its_cause() {
    let mut estimate = gaussian::<f32>(&Vector4::zeros(), &Matrix4::identity());
    let before = estimate;
    let row = SparseRow::new([(0, 1.0)]);
    assert_eq!(estimate.update(&row, f32::NAN, 1.0), Err(Error::NotFinite));
    for infinity in [f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(estimate.update(&row, infinity, 1.0), Err(Error::NotFinite));
        // An infinite innovation is refused even where nothing is to be learnt.
        let mut known = Gaussian::new(estimate.mean, Covariance::zero());
        let before = known;
        assert_eq!(known.update(&row, infinity, 1.0), Err(Error::NotFinite));
        assert_eq!(known, before);
    }
    assert_eq!(estimate.update(&row, 0.0, f32::INFINITY), Err(Error::NotFinite));
    assert_eq!(estimate.update(&row, 0.0, -0.5), Err(Error::NotPositive));
    assert_eq!(estimate.update(&SparseRow::new([(4, 1.0)]), 0.0, 1.0), Err(Error::IndexOutOfRange));
    assert_eq!(estimate.update_component::<1>(f32::NAN, 1.0), Err(Error::NotFinite));
    let huge = SMatrix::from_element(1e30);
    assert_eq!(estimate.predict(&huge, &Covariance::zero()), Err(Error::NotFinite));
    assert_eq!(estimate, before);
}

#[test]
fn a_perfectly_known_state_refuses_a_perfect_measurement() {
    let mut estimate = Gaussian::<f64, 1>::new(SVector::zeros(), Covariance::zero());
    assert_eq!(estimate.update_component::<0>(1.0, 0.0), Err(Error::NotPositive));
}

#[test]
fn resetting_a_component_forgets_its_past() {
    let mut covariance = Covariance::from_lower_triangle(&SMatrix::<f64, 3, 3>::from_element(2.0));
    covariance.reset_component::<1>(0.5);
    assert_eq!(
        covariance.to_matrix(),
        SMatrix::<f64, 3, 3>::new(2., 0., 2., 0., 0.5, 0., 2., 0., 2.)
    );
    assert_eq!(covariance.variances(), SVector::from([2.0, 0.5, 2.0]));
    assert_eq!(covariance.get(3, 0), None);
}
