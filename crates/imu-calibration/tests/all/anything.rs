//! Property tests: whatever the input, nothing panics, and the result is finite or an error.

use kestirim_imu_calibration::{Calibration, Gyroscope, Magnetometer, Pose, Poses, Triad, Turn};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::SVector;
use proptest::prelude::*;

/// Ordinary values mixed with extreme ones.
fn component() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -12.0..12.0f64,
        1 => -1e-6..1e-6f64,
        1 => prop_oneof![Just(0.0), Just(9.80665), Just(1e30), Just(f64::NAN), Just(f64::INFINITY)],
        1 => any::<f64>(),
    ]
}

fn vectors() -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec(prop::array::uniform3(component()), 0..40)
}

fn cast<T: Scalar>(v: &[f64; 3]) -> SVector<T, 3> {
    SVector::from(v.map(T::from_f64))
}

fn is_finite<T: Scalar>(triad: &Triad<T>) -> bool {
    triad.offset.iter().chain(triad.matrix.iter()).all(|x| x.is_finite())
}

fn check<T: Scalar>(vectors: &[[f64; 3]], gravity: f64, noise: f64) {
    let (gravity, noise) = (T::from_f64(gravity), T::from_f64(noise));
    let mut poses = Poses::<T, 16>::new();
    for pair in vectors.windows(2) {
        let mut pose = Pose::new();
        let before = pose;
        if pose.push(&cast(&pair[0]), &cast(&pair[1])).is_err() {
            assert_eq!(pose.samples, before.samples);
        }
        let count = poses.count();
        let added = poses.add(pose);
        assert_eq!(poses.count(), count + usize::from(added.is_ok()));
    }
    assert!(poses.missing().count() <= 6);
    if let Ok(fit) = poses.accelerometer(gravity, noise) {
        assert!(is_finite(&fit.triad) && fit.residual.is_finite());
        assert!(fit.offset_sigma.iter().all(|sigma| sigma.is_finite() && *sigma >= T::ZERO));
    }
    if let Ok(bias) = poses.gyroscope_bias(noise) {
        assert!(bias.bias.iter().chain(&bias.sigma).all(|x| x.is_finite()));
    }
    let mut gyroscope = Gyroscope::new(Triad::identity()).unwrap();
    let mut magnetometer = Magnetometer::new(SVector::zeros(), T::ONE).unwrap();
    for three in vectors.windows(3) {
        let mut turn = Turn::new(Triad::identity()).unwrap();
        for _ in 0..3 {
            let _ = turn.push(&cast(&three[0]), T::from_f64(0.1));
        }
        let _ = gyroscope.add(&turn, &cast(&three[1]), &cast(&three[2]));
        // A direction that fits, too.
        let after = turn.to_beginning(&cast(&three[1]));
        let _ = gyroscope.add(&turn, &after, &cast(&three[1]));
        let _ = magnetometer.add(&cast(&three[0]));
    }
    if let Ok(fit) = gyroscope.solve(noise) {
        assert!(is_finite(&fit.triad) && fit.residual.is_finite());
        assert!(fit.matrix_sigma.iter().flatten().flatten().all(|sigma| sigma.is_finite()));
    }
    if let Ok(fit) = magnetometer.solve() {
        assert!(is_finite(&fit.triad) && fit.field.is_finite() && fit.field > T::ZERO);
        assert!(
            fit.offset_sigma.iter().chain(fit.matrix_sigma.iter().flatten()).all(|x| x.is_finite())
        );
    }
    for pair in vectors.windows(2) {
        let _ = Calibration::identity().apply(&cast::<T>(&pair[0]), &cast(&pair[1]));
    }
}

proptest! {
    #[test]
    fn nothing_panics_and_nothing_is_nan(vectors in vectors(), gravity in component(), noise in component()) {
        check::<f32>(&vectors, gravity, noise);
        check::<f64>(&vectors, gravity, noise);
        check::<Q12_20>(&vectors, gravity, noise);
    }

    #[test]
    fn tame_vectors_are_no_worse(vectors in prop::collection::vec(prop::array::uniform3(-10.0..10.0f64), 12..40)) {
        check::<f32>(&vectors, 9.80665, 0.01);
        check::<f64>(&vectors, 9.80665, 0.01);
        check::<Q12_20>(&vectors, 9.80665, 0.01);
    }
}
