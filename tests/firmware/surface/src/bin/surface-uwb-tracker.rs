//! Everything of `kestirim-uwb-tracker`.

#![no_std]
#![no_main]

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::Room;
use kestirim_uwb_tracker::{
    Anchor, Config, Error, InertialSample, OdometrySample, RangeSample, Tracker,
};
use surface::{any, call_each, image, keep, matrix, number, numbers, option, slice};

fn configs<T: Scalar>() {
    keep::<Config<T>>(Config::calibrated(number()));
    keep::<Config<T>>(Config::uncalibrated(number()));
    keep::<Config<T>>(Config::plain(number()));
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
}

/// Any configuration.
fn config<T: Scalar>() -> Config<T> {
    let config = any(Config::calibrated(number()));
    any(Config {
        range_sigma: number(),
        gate: option(),
        acceleration_density: number(),
        decay_time: option(),
        common_bias_sigma: number(),
        room: any(Some(Room { low: numbers(), high: numbers() })),
        ..config
    })
}

fn tracks<T: Scalar, const D: usize, const N: usize, const A: usize>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    let tracker = Tracker::<T, D, N, A>::new(config(), slice(&anchors));
    let Ok(mut tracker) = any(tracker) else { return };
    let range = any(RangeSample { time_us: any(1), anchor: any(1), range: number() });
    keep(Tracker::range(any(&mut tracker), &range));
    let push = any(Some(numbers()));
    let inertial = any(InertialSample { time_us: any(1), acceleration: matrix(), push });
    keep(Tracker::inertial(any(&mut tracker), &inertial));
    let odometry = any(OdometrySample { time_us: any(1), speed: number(), turn_rate: number() });
    keep(Tracker::odometry(any(&mut tracker), &odometry));
    keep(Tracker::set_height(any(&mut tracker), number()));
    keep(Tracker::position(&tracker));
    keep(Tracker::velocity(&tracker));
    keep(Tracker::estimate(&tracker));
    keep(Tracker::range_sigma(&tracker, any(1)));
    keep(Tracker::health(&tracker, any(1)));
}

fn all_of<T: Scalar>() {
    call_each([
        configs::<T>,
        tracks::<T, 2, 4, 4>,
        tracks::<T, 2, 5, 9>,
        tracks::<T, 3, 6, 4>,
        tracks::<T, 3, 7, 9>,
    ]);
}

fn run() {
    call_each([all_of::<f32>, all_of::<Q12_20>]);
}

image!(run);
