//! Tests with a magnetometer whose hard and soft iron are known.

use crate::common::{Noise, cast};
use kestirim_imu_calibration::{Error, Magnetometer, MagnetometerFit};
use kestirim_scalar::Scalar;
use nalgebra::{Matrix3, Vector3};

/// The strength of the field, µT.
const FIELD: f64 = 48.0;

fn hard() -> Vector3<f64> {
    Vector3::new(31.0, -12.0, 20.0)
}

/// The soft iron matrix, symmetric, of determinant 1.
fn soft() -> Matrix3<f64> {
    let matrix: Matrix3<f64> = Matrix3::new(1.1, 0.05, -0.03, 0.05, 0.92, 0.04, -0.03, 0.04, 1.0);
    matrix / matrix.determinant().cbrt()
}

fn fit<T: Scalar>(
    samples: usize,
    noise: f64,
    seed: u64,
    accept: impl Fn(&Vector3<f64>) -> bool,
) -> Result<MagnetometerFit<T>, Error> {
    let mut random = Noise(seed);
    // An initial guess that is off by half the field.
    let mut magnetometer =
        Magnetometer::new(cast(&Vector3::new(10.0, 0.0, 10.0)), T::from_f64(50.0))?;
    let mut taken = 0;
    while taken < samples {
        let direction = random.direction().into_inner();
        if accept(&direction) {
            let seen = soft().try_inverse().unwrap() * direction * FIELD + hard();
            magnetometer.add(&cast(&(seen + random.vector(noise))))?;
            taken += 1;
        }
    }
    magnetometer.solve()
}

fn iron_is_found<T: Scalar>() {
    let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
    for seed in 0..20 {
        let found = fit::<T>(500, 0.3, seed, |_| true).unwrap();
        for i in 0..3 {
            let off = (found.triad.offset[i].to_f64() - hard()[i]) / found.offset_sigma[i].to_f64();
            worst = worst.max(off.abs());
            sum += off * off;
            count += 1.0;
            assert!(found.offset_sigma[i].to_f64() < 0.1);
            for j in 0..3 {
                let off = found.triad.matrix[(i, j)].to_f64() - soft()[(i, j)];
                worst = worst.max(off.abs() / found.matrix_sigma[j][i].to_f64());
            }
        }
        assert!((found.field.to_f64() - FIELD).abs() < 0.1, "{}", found.field.to_f64());
    }
    assert!(worst < 4.5, "{worst} σ");
    // The standard deviations are neither too small nor too large.
    let spread: f64 = sum / count;
    assert!((0.4..2.0).contains(&spread), "{spread}");
}

#[test]
fn hard_and_soft_iron_are_found_within_their_sigma() {
    iron_is_found::<f64>();
    iron_is_found::<f32>();
}

#[test]
fn without_noise_they_are_found_exactly() {
    let found = fit::<f64>(100, 0.0, 1, |_| true).unwrap();
    assert!((found.triad.offset - hard()).amax() < 1e-8);
    assert!((found.triad.matrix - soft()).amax() < 1e-10);
    let found = fit::<f32>(100, 0.0, 1, |_| true).unwrap();
    assert!((found.triad.offset.map(f64::from) - hard()).amax() < 0.02);
}

#[test]
fn directions_that_do_not_tell_are_refused() {
    assert_eq!(fit::<f32>(11, 0.3, 1, |_| true), Err(Error::TooFew { found: 11, needed: 12 }));
    // Turned only about the vertical, as on a table: a ring.
    for noise in [0.0, 0.3] {
        let ring = |d: &Vector3<f64>| (d.z - 0.4).abs() < 0.01;
        assert_eq!(fit::<f32>(500, noise, 1, ring), Err(Error::NotObservable));
        assert_eq!(fit::<f64>(500, noise, 1, ring), Err(Error::NotObservable));
        let cap = |d: &Vector3<f64>| d.z > 0.95;
        assert_eq!(fit::<f32>(500, noise, 1, cap), Err(Error::NotObservable));
    }
    // Only one direction.
    let mut still = Magnetometer::<f32>::new(Vector3::zeros(), 50.0).unwrap();
    for _ in 0..100 {
        still.add(&Vector3::new(20.0, 5.0, -40.0)).unwrap();
    }
    assert_eq!(still.solve(), Err(Error::NotObservable));
    assert_eq!(Magnetometer::<f32>::new(Vector3::zeros(), 0.0), Err(Error::NotPositive));
    assert_eq!(
        Magnetometer::<f32>::new(Vector3::new(f32::NAN, 0.0, 0.0), 1.0),
        Err(Error::NotFinite)
    );
    let before = still;
    assert_eq!(still.add(&Vector3::new(f32::INFINITY, 0.0, 0.0)), Err(Error::NotFinite));
    assert_eq!(still, before);
}
