//! Tests with accelerometers and gyroscopes whose errors are known.

use crate::common::{
    GRAVITY, Noise, accelerometer, attitudes, cast, gyroscope, gyroscope_of, measured, poses,
};
use kestirim_imu_calibration::{
    AccelerometerModel, Calibration, Error, Gyroscope, GyroscopeModel, Pose, Poses, Side, Triad,
    Turn,
};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{Matrix3, Rotation3, SVector, Vector3};

/// The largest deviation of a parameter from the truth, in σ.
fn worst<T: Scalar>(
    found: &Triad<T>,
    truth: &Triad<f64>,
    offsets: [T; 3],
    matrix: [[Option<T>; 3]; 3],
) -> f64 {
    let mut worst: f64 = 0.0;
    for row in 0..3 {
        let off = found.offset[row].to_f64() - truth.offset[row];
        worst = worst.max(off.abs() / offsets[row].to_f64());
        for column in 0..3 {
            let off = found.matrix[(row, column)].to_f64() - truth.matrix[(row, column)];
            match matrix[row][column] {
                Some(sigma) => worst = worst.max(off.abs() / sigma.to_f64()),
                None => assert!(row > column || off.abs() < 0.02, "{row}{column}: {off}"),
            }
        }
    }
    worst
}

fn the_accelerometer_is_found<T: Scalar>() {
    let (mut beyond, mut all) = (0, 0);
    for seed in 0..40 {
        let poses = poses::<T>(&attitudes(12), &mut Noise(seed), 0.01);
        assert_eq!(poses.missing().next(), None);
        let fit = poses.accelerometer(T::from_f64(GRAVITY), T::from_f64(0.01)).unwrap();
        assert_eq!(fit.model, AccelerometerModel::Full);
        let worst = worst(&fit.triad, &accelerometer(), fit.offset_sigma, fit.matrix_sigma);
        assert!(worst < 4.0, "{seed}: {worst} σ");
        beyond += u32::from(worst > 2.0);
        all += 1;
        assert!(fit.offset_sigma.iter().all(|sigma| sigma.to_f64() < 0.03), "{fit:?}");
        assert!(fit.residual.to_f64() < 0.03);
    }
    // If the σ are right, one of nine parameters is beyond 2 σ in a third of the trials; they are the larger of two.
    assert!((2..=20).contains(&beyond), "{beyond} of {all}");
}

#[test]
fn twelve_poses_tell_nine_parameters_within_their_sigma() {
    the_accelerometer_is_found::<f64>();
    the_accelerometer_is_found::<f32>();
}

#[test]
fn six_sides_tell_offset_and_scale() {
    // The axes are orthogonal, so that parameters which are not estimated do not disturb.
    let matrix = Matrix3::from_diagonal(&Vector3::new(0.98, 1.03, 1.01));
    let truth = Triad { matrix, ..accelerometer() };
    let mut sides = Poses::<f64, 6>::new();
    for attitude in attitudes(6) {
        let up = attitude.inverse() * Vector3::z() * GRAVITY;
        let mut pose = Pose::new();
        pose.push(&measured(&truth, &up), &Vector3::zeros()).unwrap();
        sides.add(pose).unwrap();
    }
    let fit = sides.accelerometer(GRAVITY, 0.01).unwrap();
    assert_eq!(fit.model, AccelerometerModel::OffsetAndScale);
    assert_eq!(fit.matrix_sigma[0][1], None);
    assert!((fit.triad.offset - truth.offset).norm() < 1e-9, "{fit:?}");
    assert!((fit.triad.matrix - truth.matrix).norm() < 1e-9, "{fit:?}");
    // One pose in each direction of an axis: σ/√2.
    assert!((fit.offset_sigma[0] - 0.01 / 2.0_f64.sqrt()).abs() < 1e-3, "{fit:?}");
    assert_eq!(
        sides.add(Pose { samples: 1.0, specific_force: Vector3::z(), ..Pose::new() }),
        Err(Error::Full)
    );
}

#[test]
fn six_tilted_sides_allow_for_axes_that_are_not_orthogonal() {
    let (mut squares, mut count) = (0.0, 0.0);
    for signs in 0..8 {
        let [xy, xz, yz] = [0, 1, 2].map(|bit| if signs >> bit & 1 == 1 { 0.01 } else { -0.01 });
        let matrix = Matrix3::new(1.0, xy, xz, 0.0, 1.0, yz, 0.0, 0.0, 1.0);
        let truth = Triad { matrix, ..accelerometer() };
        let mut sides = Poses::<f64, 6>::new();
        for (index, attitude) in attitudes(6).into_iter().enumerate() {
            let by = if index % 2 == 0 { 0.25 } else { -0.2 };
            let tilt = Rotation3::from_euler_angles(by, -0.8 * by, by);
            let up = (tilt * attitude).inverse() * Vector3::z() * GRAVITY;
            let mut pose = Pose::new();
            pose.push(&measured(&truth, &up), &Vector3::zeros()).unwrap();
            sides.add(pose).unwrap();
        }
        let fit = sides.accelerometer(GRAVITY, 0.01).unwrap();
        assert_eq!(fit.model, AccelerometerModel::OffsetAndScale);
        for axis in 0..3 {
            let offset = (fit.triad.offset - truth.offset)[axis] / fit.offset_sigma[axis];
            let sigma = fit.matrix_sigma[axis][axis].unwrap();
            let scale = (fit.triad.matrix[(axis, axis)] - truth.matrix[(axis, axis)]) / sigma;
            squares += offset * offset + scale * scale;
            count += 2.0;
        }
    }
    let typical = f64::sqrt(squares / count);
    assert!((0.2..1.5).contains(&typical), "{typical} σ");
}

#[test]
fn nine_poses_on_sides_alone_tell_no_misalignment() {
    let sides: Vec<_> = attitudes(6).into_iter().cycle().take(12).collect();
    let fit = poses::<f64>(&sides, &mut Noise(3), 0.0).accelerometer(GRAVITY, 0.01).unwrap();
    assert_eq!(fit.model, AccelerometerModel::OffsetAndScale);
}

#[test]
fn poses_that_do_not_tell_are_refused() {
    let refusal = |attitudes: &[Rotation3<f64>]| {
        poses::<f32>(attitudes, &mut Noise(1), 0.005).accelerometer(9.80665, 0.01).unwrap_err()
    };
    assert_eq!(refusal(&attitudes(5)), Error::TooFew { found: 5, needed: 6 });
    let same = [attitudes(1)[0]; 12];
    assert_eq!(refusal(&same), Error::NotObservable);
    // Turned about only one axis: the offset of that axis stays unknown.
    let about: Vec<_> = (0..12)
        .map(|step| Rotation3::from_axis_angle(&Vector3::x_axis(), 0.5 * f64::from(step)))
        .collect();
    assert_eq!(refusal(&about), Error::NotObservable);
    let tilted: Vec<_> = (0..12)
        .map(|step| {
            Rotation3::from_euler_angles(0.1 * f64::from(step % 4), 0.1 * f64::from(step / 4), 0.0)
        })
        .collect();
    assert_eq!(refusal(&tilted), Error::NotObservable);
    // Arguments other than gravity and noise of a sensor.
    let poses = poses::<f32>(&attitudes(12), &mut Noise(1), 0.005);
    assert_eq!(poses.accelerometer(1.0, 0.01), Err(Error::Inconsistent));
    assert_eq!(poses.accelerometer(0.0, 0.01), Err(Error::NotPositive));
    assert_eq!(poses.accelerometer(9.8, f32::NAN), Err(Error::NotPositive));
}

#[test]
fn the_sides_that_are_missing_are_named() {
    let poses = poses::<f32>(&attitudes(4), &mut Noise(1), 0.005);
    let missing: Vec<_> = poses.missing().collect();
    assert_eq!(missing, [Side { axis: 1, is_up: false }, Side { axis: 2, is_up: false }]);
}

#[test]
fn the_bias_is_the_mean_at_rest() {
    let poses = poses::<f32>(&attitudes(12), &mut Noise(9), 0.0);
    let found = poses.gyroscope_bias(1e-4).unwrap();
    let off = found.bias.map(f64::from) - gyroscope().offset;
    for axis in 0..3 {
        assert!(off[axis].abs() < 4.0 * f64::from(found.sigma[axis]), "{found:?}");
        assert!(found.sigma[axis] < 2e-4);
    }
    assert_eq!(poses.gyroscope_bias(0.0), Err(Error::NotPositive));
    assert_eq!(
        Poses::<f32, 2>::new().gyroscope_bias(0.1),
        Err(Error::TooFew { found: 0, needed: 1 })
    );
}

fn the_gyroscope_is_found<T: Scalar>(tolerance: f64) {
    let accelerometer = Triad {
        offset: cast(&accelerometer().offset),
        matrix: accelerometer().matrix.map(T::from_f64),
    };
    let bias: SVector<T, 3> = cast(&gyroscope().offset);
    let of = |passes, noise| gyroscope_of(&attitudes(12), &accelerometer, bias, passes, noise);
    let exact = of(3, 0.0).solve(T::from_f64(0.003)).unwrap();
    assert_eq!(exact.model, GyroscopeModel::Full);
    let off = exact.triad.matrix.map(T::to_f64) - gyroscope().matrix;
    assert!(off.amax() < tolerance, "{off}");
    // One pass leaves errors of second order.
    let first = of(1, 0.0).solve(T::from_f64(0.003)).unwrap();
    let off = first.triad.matrix.map(T::to_f64) - gyroscope().matrix;
    assert!(off.amax() < 4e-3, "{off}");
    let noisy = of(3, 0.01).solve(T::from_f64(0.001)).unwrap();
    let bias_sigma = [T::ONE; 3];
    let worst = worst(&noisy.triad, &gyroscope(), bias_sigma, noisy.matrix_sigma);
    assert!(worst < 3.0, "{worst} σ");
}

#[test]
fn turns_between_poses_tell_scales_and_misalignments() {
    the_gyroscope_is_found::<f64>(1e-7);
    the_gyroscope_is_found::<f32>(2e-4);
}

#[test]
fn turns_about_one_axis_tell_its_scale_alone() {
    let about: Vec<_> = (0..8)
        .map(|step| Rotation3::from_axis_angle(&Vector3::x_axis(), 0.8 * f64::from(step)))
        .collect();
    // Without misalignments, which these turns cannot separate from scales.
    let scale = Vector3::new(1.03, 1.0, 1.0);
    let assumed = Triad::identity();
    let mut fit = Gyroscope::<f64>::new(assumed).unwrap();
    for pair in about.windows(2) {
        let mut turn = Turn::new(assumed).unwrap();
        for _ in 0..80 {
            turn.push(&Vector3::new(1.0 / scale.x, 0.0, 0.0), 0.01).unwrap();
        }
        let up = |attitude: &Rotation3<f64>| attitude.inverse() * Vector3::z();
        fit.add(&turn, &up(&pair[0]), &up(&pair[1])).unwrap();
    }
    let found = fit.solve(0.003).unwrap();
    assert_eq!(found.model, GyroscopeModel::Scale);
    assert!((found.triad.matrix.m11 - 1.03).abs() < 1e-6, "{found:?}");
    assert!(found.matrix_sigma[0][0].is_some());
    assert_eq!([found.matrix_sigma[1][1], found.matrix_sigma[2][2]], [None; 2]);
    assert_eq!(found.triad.matrix.m22, 1.0);
}

#[test]
fn turns_that_do_not_tell_are_refused() {
    let assumed = Triad::<f64>::identity();
    let mut fit = Gyroscope::new(assumed).unwrap();
    assert_eq!(fit.solve(0.003), Err(Error::TooFew { found: 0, needed: 1 }));
    // A turn about gravity.
    let mut turn = Turn::new(assumed).unwrap();
    for _ in 0..100 {
        turn.push(&Vector3::z(), 0.01).unwrap();
    }
    for _ in 0..10 {
        fit.add(&turn, &Vector3::z(), &Vector3::z()).unwrap();
    }
    assert_eq!(fit.solve(0.003), Err(Error::NotObservable));
    let before = fit;
    // A turn that the gyroscope did not measure.
    assert_eq!(fit.add(&turn, &Vector3::z(), &Vector3::x()), Err(Error::Inconsistent));
    assert_eq!(fit.add(&turn, &Vector3::z(), &-Vector3::z()), Err(Error::Inconsistent));
    assert_eq!(fit.add(&turn, &Vector3::z(), &Vector3::zeros()), Err(Error::Empty));
    assert_eq!(fit, before);
    let before = turn;
    assert_eq!(turn.push(&Vector3::x(), -0.01), Err(Error::Inconsistent));
    assert_eq!(turn.push(&Vector3::x(), 5.0), Err(Error::Inconsistent));
    assert_eq!(turn.push(&Vector3::new(f64::NAN, 0.0, 0.0), 0.01), Err(Error::NotFinite));
    assert_eq!(turn, before);
}

fn a_correction_is_undone<T: Scalar>(tolerance: f64) {
    let triad =
        |of: Triad<f64>| Triad { offset: cast(&of.offset), matrix: of.matrix.map(T::from_f64) };
    let calibration =
        Calibration { accelerometer: triad(accelerometer()), gyroscope: triad(gyroscope()) };
    let (force, rate) = (Vector3::new(3.0, -20.0, 9.0), Vector3::new(1.0, -7.0, 0.5));
    let (corrected, turned) = calibration
        .apply(&cast(&measured(&accelerometer(), &force)), &cast(&measured(&gyroscope(), &rate)));
    assert!((corrected.map(T::to_f64) - force).amax() < tolerance);
    assert!((turned.map(T::to_f64) - rate).amax() < tolerance);
    let (same, _) = Calibration::identity().apply(&cast::<T>(&force), &cast(&rate));
    assert_eq!(same, cast(&force));
}

#[test]
fn a_calibration_is_applied_in_every_number() {
    a_correction_is_undone::<f64>(1e-12);
    a_correction_is_undone::<f32>(1e-5);
    a_correction_is_undone::<Q12_20>(1e-4);
}
