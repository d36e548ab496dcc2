//! Orientations compared with Rodrigues' formula (f64), in every scalar.

use kestirim_attitude::Orientation;
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SVector, Vector3};
use proptest::prelude::*;

fn cast<T: Scalar>(v: [f64; 3]) -> SVector<T, 3> {
    SVector::from(v.map(T::from_f64))
}

/// Rodrigues' formula: `v` rotated about the axis of `rotation` by its length.
fn rodrigues(rotation: Vector3<f64>, v: Vector3<f64>) -> Vector3<f64> {
    let angle = rotation.norm();
    if angle < 1e-12 {
        return v;
    }
    let k = rotation / angle;
    v * angle.cos() + k.cross(&v) * angle.sin() + k * k.dot(&v) * (1.0 - angle.cos())
}

fn distance<T: Scalar>(ours: &SVector<T, 3>, expected: Vector3<f64>) -> f64 {
    (ours.map(T::to_f64) - expected).norm()
}

fn check_turns<T: Scalar>(first: [f64; 3], second: [f64; 3], v: [f64; 3], tolerance: f64) {
    let v64 = Vector3::from(v);
    let expected = rodrigues(first.into(), rodrigues(second.into(), v64));

    let body_order =
        Orientation::<T>::identity().turned_in_body(&cast(first)).turned_in_body(&cast(second));
    let earth_order =
        Orientation::<T>::identity().turned_in_earth(&cast(second)).turned_in_earth(&cast(first));
    for orientation in [body_order, earth_order] {
        let earth = orientation.to_earth(&cast(v));
        assert!(distance(&earth, expected) < tolerance, "{earth:?} is not {expected:?}");
        assert!(distance(&orientation.to_body(&earth), v64) < 2.0 * tolerance);
        let up = orientation.to_body(&cast([0.0, 0.0, 1.0])).map(T::to_f64);
        assert!(distance(&orientation.up_in_body(), up) < tolerance);
        let norm: f64 = orientation.quaternion().iter().map(|q| q.to_f64() * q.to_f64()).sum();
        assert!((norm - 1.0).abs() < tolerance);
    }
}

fn check_upright<T: Scalar>(force: [f64; 3], tolerance: f64) {
    let orientation = Orientation::<T>::from_specific_force(&cast(force)).unwrap();
    let norm = Vector3::from(force).norm();
    let earth = orientation.to_earth(&cast(force)) / T::from_f64(norm);
    assert!(distance(&earth, Vector3::z()) < tolerance, "{force:?} became {earth:?}");
}

proptest! {
    #[test]
    fn turns_compose_and_turn_back(
        first in proptest::array::uniform3(-1.5..1.5f64),
        second in proptest::array::uniform3(-0.05..0.05f64),
        v in proptest::array::uniform3(-10.0..10.0f64),
    ) {
        check_turns::<f64>(first, second, v, 1e-5);
        check_turns::<f32>(first, second, v, 3e-5);
        check_turns::<Q12_20>(first, second, v, 1.5e-3);
    }

    #[test]
    fn gravity_stands_upright_from_every_side(force in proptest::array::uniform3(-20.0..20.0f64)) {
        prop_assume!(Vector3::from(force).norm() > 0.5);
        check_upright::<f64>(force, 1e-12);
        check_upright::<f32>(force, 1e-6);
        check_upright::<Q12_20>(force, 2e-5);
    }

    #[test]
    fn no_bits_panic(bits in proptest::array::uniform4(any::<f32>())) {
        let [a, b, c, d] = bits;
        if let Some(orientation) = Orientation::from_quaternion(bits) {
            prop_assert!(orientation.quaternion().iter().all(|q| q.abs() <= 1.001));
        }
        let turned = Orientation::identity().turned_in_body(&SVector::from([a, b, c]));
        let _ = turned.to_earth(&SVector::from([b, c, d]));
        let _ = turned.heading();
        let _ = Orientation::from_specific_force(&SVector::from([a, b, c]));
    }
}

#[test]
fn upside_down_and_no_direction() {
    check_upright::<f64>([0.0, 0.0, -9.81], 1e-12);
    check_upright::<f32>([1e-20, 0.0, -9.81], 1e-6);
    assert_eq!(Orientation::<f64>::from_specific_force(&SVector::zeros()), None);
    assert_eq!(Orientation::from_specific_force(&SVector::from([f32::NAN, 0.0, 1.0])), None);
    assert_eq!(Orientation::<f32>::from_quaternion([0.0; 4]), None);
}

#[test]
fn heading_counts_anticlockwise_from_x() {
    for degrees in [-179.0_f64, -90.0, -1.0, 0.0, 45.0, 90.0, 179.0] {
        let orientation = Orientation::<f64>::identity().turned_in_earth(&SVector::from([
            0.0,
            0.0,
            degrees.to_radians(),
        ]));
        assert!((orientation.heading().to_degrees() - degrees).abs() < 1e-3);
    }
}

#[test]
fn a_million_small_turns_keep_the_norm_if_it_is_brought_back_now_and_then() {
    let turn = SVector::from([0.003_f32, -0.001, 0.002]);
    let mut orientation = Orientation::identity();
    for _ in 0..1_000 {
        for _ in 0..1_000 {
            orientation = orientation.turned_in_body(&turn);
        }
        orientation = orientation.renormalised();
    }
    let norm: f32 = orientation.quaternion().iter().map(|q| q * q).sum();
    assert!((norm - 1.0).abs() < 1e-5);
}

proptest! {
    /// Levelling removes the tilt error and keeps a correct heading.
    #[test]
    fn a_levelled_orientation_keeps_its_heading(
        heading in -3.0..3.0f64,
        mounted in proptest::array::uniform3(-1.5..1.5f64),
        tilt in proptest::array::uniform2(-0.8..0.8f64),
        v in proptest::array::uniform3(-10.0..10.0f64),
    ) {
        let truth = Orientation::<f64>::identity()
            .turned_in_earth(&cast(mounted))
            .turned_in_earth(&cast([0.0, 0.0, heading]));
        let wrong = truth.turned_in_earth(&cast([tilt[0], tilt[1], 0.0]));
        let levelled = wrong.levelled(&truth.to_body(&cast([0.0, 0.0, 9.8]))).unwrap();
        let expected = truth.to_earth(&cast(v));
        prop_assert!(distance(&levelled.to_earth(&cast(v)), expected) < 1e-3);
        prop_assert!(wrong.levelled(&cast([0.0; 3])).is_none());
    }
}
