//! Calls everything of `kestirim-imu-calibration`.

use kestirim_imu_calibration::{
    AccelerometerModel, Calibration, Gyroscope, Magnetometer, Pose, Poses, Triad, Turn,
};
use kestirim_scalar::{Q12_20, Scalar};

use super::values::{LONG_FORM, any, call_each, keep, matrix, number, one_of, rounds, try_on};

fn triad<T: Scalar>() -> Triad<T> {
    any(Triad { offset: matrix(), matrix: matrix() })
}

fn corrections<T: Scalar>() {
    keep::<Triad<T>>(Triad::identity());
    keep(<Triad<T> as Default>::default());
    keep(Triad::<T>::apply(&triad(), &matrix()));
    keep::<Calibration<T>>(Calibration::identity());
    keep(<Calibration<T> as Default>::default());
    let calibration = any(Calibration { accelerometer: triad::<T>(), gyroscope: triad() });
    keep(Calibration::apply(&calibration, &matrix(), &matrix()));
}

fn poses<T: Scalar, const N: usize>() {
    keep(<Poses<T, N> as Default>::default());
    keep(<Pose<T> as Default>::default());
    let mut poses = any(Poses::<T, N>::new());
    for _ in 0..rounds() {
        let mut pose = any(Pose::new());
        for _ in 0..rounds() {
            try_on(&mut pose, |pose| Pose::push(pose, &matrix(), &matrix()));
        }
        try_on(&mut poses, |poses| Poses::add(poses, pose));
        let samples = number();
        let other = any(Pose { specific_force: matrix(), angular_rate: matrix(), samples });
        try_on(&mut poses, |poses| Poses::add(poses, other));
    }
    keep(Poses::count(&poses));
    for side in any(Poses::missing(&poses)) {
        keep(side);
    }
    keep(Poses::accelerometer(&poses, number(), number()));
    keep(Poses::gyroscope_bias(&poses, number()));
    let model = one_of([AccelerometerModel::OffsetAndScale, AccelerometerModel::Full]);
    keep(AccelerometerModel::unknowns(model));
}

fn turns<T: Scalar>() {
    let Ok(mut gyroscope) = any(Gyroscope::<T>::new(triad())) else { return };
    for _ in 0..rounds() {
        let Ok(mut turn) = any(Turn::new(triad())) else { return };
        for _ in 0..rounds() {
            try_on(&mut turn, |turn| Turn::push(turn, &matrix(), number()));
        }
        let after = any(matrix());
        let before = any(Turn::to_beginning(&turn, &after));
        try_on(&mut gyroscope, |gyroscope| Gyroscope::add(gyroscope, &turn, &before, &after));
        try_on(&mut gyroscope, |gyroscope| Gyroscope::add(gyroscope, &turn, &matrix(), &matrix()));
    }
    keep(Gyroscope::solve(&gyroscope, number()));
}

fn iron<T: Scalar>() {
    let Ok(mut magnetometer) = any(Magnetometer::<T>::new(matrix(), number())) else { return };
    for _ in 0..rounds() {
        try_on(&mut magnetometer, |magnetometer| Magnetometer::add(magnetometer, &matrix()));
    }
    keep(Magnetometer::solve(&magnetometer));
}

fn all_of<T: Scalar>() {
    call_each([corrections::<T>, poses::<T, 1>, poses::<T, 16>, turns::<T>, iron::<T>]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
