//! Calls everything of `kestirim-uwb-tracker`.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{Room, Solver};
use kestirim_uwb_tracker::{
    Anchor, Config, DifferenceSample, DifferenceTracker, EpochMethod, EpochSolver, Error, Health,
    HeightFinder, InertialSample, OdometrySample, PublishedConfig, PublishedTracker, RangeSample,
    Tracker, WheelTracker,
};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, maybe, number, numbers, one_of, option, rounds, slice,
    try_on, whole,
};

fn configs<T: Scalar>() {
    keep::<Config<T>>(Config::calibrated(number()));
    keep::<Config<T>>(Config::uncalibrated(number()));
    keep::<Config<T>>(Config::plain(number()));
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
}

fn places<T: Scalar>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    keep::<Config<T>>(Config::of_place(config(), slice(&anchors)));
    keep::<[T; 2]>(Config::common_sigmas(&config(), slice(&anchors)));
}

/// An arbitrary configuration.
fn config<T: Scalar>() -> Config<T> {
    let config = any(Config::calibrated(number()));
    any(Config {
        range_sigma: number(),
        gate: option(),
        acceleration_density: number(),
        decay_time: option(),
        common_bias_sigma: number(),
        bias_sigma: number(),
        room: maybe(Room { low: numbers(), high: numbers() }),
        ..config
    })
}

fn tracks<T: Scalar, const D: usize, const N: usize, const A: usize>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    let tracker = Tracker::<T, D, N, A>::new(config(), slice(&anchors));
    let Ok(mut tracker) = any(tracker) else { return };
    for _ in 0..rounds() {
        try_on(&mut tracker, |tracker| Tracker::range(tracker, &sample()));
        let push = maybe(numbers());
        let inertial = any(InertialSample { time_us: whole(), acceleration: matrix(), push });
        try_on(&mut tracker, |tracker| Tracker::inertial(tracker, &inertial));
        let odometry =
            any(OdometrySample { time_us: whole(), speed: number(), turn_rate: number() });
        try_on(&mut tracker, |tracker| Tracker::odometry(tracker, &odometry));
        try_on(&mut tracker, |tracker| Tracker::set_height(tracker, number()));
    }
    keep(Tracker::position(&tracker));
    keep(Tracker::velocity(&tracker));
    keep(Tracker::mirror_image(&tracker));
    keep(Tracker::estimate(&tracker));
    keep(Tracker::range_sigma(&tracker, whole()));
    let health = any(Tracker::health(&tracker, whole()));
    keep(Health::in_short(&health));
}

fn drives<T: Scalar, const A: usize>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    let Ok(mut tracker) = any(WheelTracker::<T, A>::new(config(), slice(&anchors))) else { return };
    for _ in 0..rounds() {
        try_on(&mut tracker, |tracker| WheelTracker::range(tracker, &sample()));
        let odometry =
            any(OdometrySample { time_us: whole(), speed: number(), turn_rate: number() });
        try_on(&mut tracker, |tracker| WheelTracker::odometry(tracker, &odometry));
        try_on(&mut tracker, |tracker| WheelTracker::set_height(tracker, number()));
    }
    keep(WheelTracker::position(&tracker));
    keep(WheelTracker::estimate(&tracker));
    keep(WheelTracker::scale(&tracker));
    keep(WheelTracker::health(&tracker, whole()));
}

fn listens<T: Scalar, const D: usize, const N: usize, const A: usize>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    let tracker = DifferenceTracker::<T, D, N, A>::new(config(), slice(&anchors));
    let Ok(mut tracker) = any(tracker) else { return };
    for _ in 0..rounds() {
        let anchors = [whole(), whole()];
        let sample = any(DifferenceSample { time_us: whole(), anchors, difference: number() });
        try_on(&mut tracker, |tracker| DifferenceTracker::difference(tracker, &sample));
        try_on(&mut tracker, |tracker| DifferenceTracker::set_height(tracker, number()));
    }
    keep(DifferenceTracker::position(&tracker));
    keep(DifferenceTracker::velocity(&tracker));
    keep(DifferenceTracker::estimate(&tracker));
    keep(DifferenceTracker::health(&tracker, whole()));
}

fn sample<T: Scalar>() -> RangeSample<T> {
    any(RangeSample { time_us: whole(), anchor: whole(), range: number() })
}

fn epochs<T: Scalar, const D: usize, const A: usize>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    let method = one_of([EpochMethod::Trilateration, EpochMethod::LeastSquares]);
    let room = maybe(Room { low: numbers(), high: numbers() });
    let solver = any(Solver { room, ..Solver::new(number()) });
    let solver = EpochSolver::<T, A>::new(method, solver, slice(&anchors));
    let Ok(mut solver) = any(solver) else { return };
    for _ in 0..rounds() {
        try_on(&mut solver, |solver| EpochSolver::range(solver, &sample()));
        try_on(&mut solver, |solver| EpochSolver::set_height(solver, number()));
    }
    keep(EpochSolver::height(&solver));
    keep(EpochSolver::position::<D>(&solver, whole(), maybe(matrix())));
}

fn published<T: Scalar, const D: usize, const N: usize, const A: usize>() {
    keep::<PublishedConfig<T, D>>(PublishedConfig::plain(number()));
    let config = any(PublishedConfig::<T, D>::adaptive(number()));
    let config = any(PublishedConfig {
        start: maybe(matrix()),
        position_variance: number(),
        process_variance: number(),
        range_variance: number(),
        forgetting: number(),
        ..config
    });
    let anchors = any([Anchor { position: matrix(), bias: number() }; A]);
    let tracker = PublishedTracker::<T, D, N, A>::new(config, &anchors);
    let Ok(mut tracker) = any(tracker) else { return };
    for _ in 0..rounds() {
        for _ in 0..A {
            try_on(&mut tracker, |tracker| PublishedTracker::range(tracker, &sample()));
        }
        PublishedTracker::push(any(&mut tracker), maybe(numbers()));
        keep(PublishedTracker::end_epoch(any(&mut tracker), whole()));
        try_on(&mut tracker, |tracker| PublishedTracker::set_height(tracker, number()));
    }
    keep(PublishedTracker::position(&tracker));
    keep(PublishedTracker::estimate(&tracker));
}

fn heights<T: Scalar, const A: usize>() {
    let anchors = any([Anchor { position: matrix(), bias: number() }; 4]);
    keep(HeightFinder::<T, A>::calibrated(slice(&anchors)));
    let Ok(mut finder) = any(HeightFinder::<T, A>::uncalibrated(slice(&anchors))) else { return };
    for _ in 0..rounds() {
        try_on(&mut finder, |finder| HeightFinder::range(finder, &sample()));
        HeightFinder::end_place(any(&mut finder));
    }
    keep(HeightFinder::height(&finder));
}

fn all_of<T: Scalar>() {
    if LONG_FORM {
        call_each([
            tracks::<T, 2, 4, 4>,
            tracks::<T, 3, 7, 9>,
            listens::<T, 2, 5, 4>,
            drives::<T, 4>,
            epochs::<T, 2, 4>,
            heights::<T, 4>,
            published::<T, 2, 4, 4>,
        ]);
    }
    call_each([
        configs::<T>,
        places::<T>,
        tracks::<T, 2, 5, 9>,
        tracks::<T, 3, 6, 4>,
        listens::<T, 3, 7, 9>,
        drives::<T, 9>,
        epochs::<T, 3, 9>,
        heights::<T, 5>,
        published::<T, 3, 6, 5>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
