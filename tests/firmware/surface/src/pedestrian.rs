//! Calls everything of `kestirim-pedestrian`.

use core::fmt::Debug;

use kestirim_attitude::Orientation;
use kestirim_pedestrian::detector::{
    Adaptive, AngularRateEnergy, FixedShoe, Magnitude, Motion, MovingVariance, Shoe, StanceDetector,
};
use kestirim_pedestrian::{
    Alignment, Config, Ekf, Estimate, ImuSample, Lite, MagneticHeading, MissedTurn, Navigator,
    OfflineTracker, PathUncertainty, SensorClass, Step, Stride, Tracker, Warnings, ZeroVelocity,
};
use kestirim_scalar::{Q12_20, Scalar};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, number, one_of, rounds, slice, slice_mut, try_on,
    whole, yes_or_no,
};

fn config<T: Scalar>() -> Config<T> {
    let config = any(<Config<T> as Default>::default());
    any(Config { sensor: one_of([SensorClass::Industrial, SensorClass::Consumer]), ..config })
}

fn sample<T: Scalar>() -> ImuSample<T> {
    let (specific_force, angular_rate) = (matrix(), matrix());
    any(ImuSample { time_us: whole(), specific_force, angular_rate })
}

fn shows<T: Scalar, D: StanceDetector<T> + Debug>(mut detector: D) {
    for _ in 0..rounds() {
        let motion = any(Motion { time_us: whole(), force_g: matrix(), angular_rate: matrix() });
        keep(StanceDetector::update(any(&mut detector), &motion));
    }
}

fn detectors<T: Scalar>() {
    shows::<T, _>(<Adaptive<T> as Default>::default());
    shows::<T, _>(FixedShoe::new(number::<T>()));
    shows::<T, _>(Magnitude::new(number::<T>()));
    shows::<T, _>(MovingVariance::new(number::<T>()));
    shows::<T, _>(AngularRateEnergy::new(number::<T>()));
    let motion = any(Motion { time_us: whole(), force_g: matrix(), angular_rate: matrix() });
    let mut shoe = any(<Shoe<T> as Default>::default());
    keep(Shoe::update(&mut shoe, &motion));
}

fn navigates<T: Scalar, N: Navigator<T> + Debug>() {
    let start = any(Orientation::identity());
    let mut navigator = any(<N as Navigator<T>>::start(
        one_of([SensorClass::Industrial, SensorClass::Consumer]),
        start,
    ));
    let step =
        any(Step { interval: number(), force_g: matrix(), angular_rate: matrix(), turn: matrix() });
    for _ in 0..rounds() {
        Navigator::propagate(any(&mut navigator), &step, yes_or_no());
        let (velocity, landing) = (matrix(), yes_or_no());
        let zero = any(ZeroVelocity { velocity, statistic: number(), interval: number(), landing });
        let missed = any(MissedTurn { turn: matrix(), pushed: matrix() });
        Navigator::miss(any(&mut navigator), &missed);
        Navigator::zero_velocity(any(&mut navigator), &zero);
        let sensor = one_of([SensorClass::Industrial, SensorClass::Consumer]);
        Navigator::restart(any(&mut navigator), sensor, any(Orientation::identity()));
    }
    keep(Navigator::position(&navigator));
    keep(Navigator::velocity(&navigator));
    keep(Navigator::orientation(&navigator));
}

fn navigators<T: Scalar>() {
    call_each([navigates::<T, Lite<T>>, navigates::<T, Ekf<T>>]);
    let start = Orientation::identity();
    keep(Ekf::<T>::covariance(&any(<Ekf<T> as Navigator<T>>::start(SensorClass::Consumer, start))));
}

fn tracks<T: Scalar, N: Navigator<T> + Debug>() {
    track(any(Tracker::<T, N>::new(config())));
    track(any(Tracker::<T, N, _>::with_detector(config(), FixedShoe::new(number()))));
}

fn track<T: Scalar, N: Navigator<T> + Debug, D: StanceDetector<T> + Debug>(
    mut tracker: Tracker<T, N, D>,
) {
    for _ in 0..rounds() {
        try_on(&mut tracker, |tracker| Tracker::update(tracker, &sample()));
    }
    keep(Tracker::finish(any(&mut tracker)));
    keep(Tracker::path_length(&tracker));
    let warnings = any(Tracker::warnings(&tracker));
    keep(Warnings::health(&warnings));
    let alignment = Tracker::alignment(&tracker);
    keep(Alignment::gyro_bias(alignment));
    keep(Alignment::accelerometer_bias(alignment));
}

fn looks_back<T: Scalar, N: Navigator<T> + Debug>() {
    let samples = any([sample::<T>(); 4]);
    let mut statistic = any([T::ZERO; 4]);
    let samples = slice(&samples);
    let tracker = OfflineTracker::<T, N>::new(config(), samples, slice_mut(&mut statistic));
    let Ok(mut tracker) = any(tracker) else { return };
    for _ in 0..rounds() {
        keep(<OfflineTracker<'_, T, N> as Iterator>::next(any(&mut tracker)));
    }
    keep(OfflineTracker::finish(any(&mut tracker)));
    keep(OfflineTracker::path_length(&tracker));
    keep(OfflineTracker::warnings(&tracker));
}

fn doubts<T: Scalar>() {
    let sensor = one_of([SensorClass::Industrial, SensorClass::Consumer]);
    keep((SensorClass::heading_rate::<T>(sensor), SensorClass::stride_scale::<T>(sensor)));
    keep((SensorClass::height_drift::<T>(sensor), SensorClass::drifts_by(sensor, number::<T>())));
    let mut uncertainty = any(PathUncertainty::<T>::new(sensor));
    let (length, duration, heading_change) = (number(), number(), number());
    let (time_us, position, unseen, bridged, gravity_off) =
        (whole(), matrix(), number(), number(), number());
    let stride = any(Stride {
        time_us,
        position,
        length,
        duration,
        heading_change,
        unseen,
        bridged,
        gravity_off,
    });
    PathUncertainty::add(any(&mut uncertainty), &stride);
    keep(PathUncertainty::standard_deviation(&uncertainty));
    keep(PathUncertainty::<T>::scale(sensor, number()));
}

fn turns_back<T: Scalar>() {
    let mut heading = any(<MagneticHeading<T> as Default>::default());
    for _ in 0..rounds() {
        let (position, velocity) = (matrix(), matrix());
        let orientation = any(Orientation::identity());
        let (time_us, stance, stride) = (whole(), yes_or_no(), None);
        let estimate = any(Estimate { time_us, position, velocity, orientation, stance, stride });
        let field = matrix();
        MagneticHeading::update(any(&mut heading), &sample(), &estimate, Some(&field), number());
    }
    MagneticHeading::finish(any(&mut heading), number());
    keep(MagneticHeading::rate(&heading));
}

fn all_of<T: Scalar>() {
    call_each([
        doubts::<T>,
        turns_back::<T>,
        detectors::<T>,
        navigators::<T>,
        tracks::<T, Lite<T>>,
        tracks::<T, Ekf<T>>,
        looks_back::<T, Lite<T>>,
        looks_back::<T, Ekf<T>>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
