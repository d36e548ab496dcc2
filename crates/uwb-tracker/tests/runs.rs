//! Runs of broken samples among good ones: whatever comes, every estimate is finite, and the tag is followed again
//! within ten seconds. `PROPTEST_CASES` sets the number of sequences.

mod common;

use common::{CORNERS, anchors, distance, sample};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::Solver;
use kestirim_uwb_tracker::{
    Config, EpochMethod, EpochSolver, InertialSample, OdometrySample, PublishedConfig,
    PublishedTracker, Tracker,
};
use nalgebra::Vector3;
use proptest::prelude::*;

/// An epoch is a range of each anchor, the IMU and the wheels.
const EPOCH_US: u64 = 100_000;

/// What is wrong with the samples of a run.
#[derive(Clone, Copy, Debug)]
enum Fault {
    /// Every range is the same.
    Equal(f64),
    /// Every anchor repeats what it said last.
    Stuck,
    /// One anchor does.
    StuckAnchor(usize),
    /// Ranges jump between these.
    Alternating(f64, f64),
    /// At either end of what is taken.
    Railed([bool; 4]),
    /// All are too long by this.
    Longer(f64),
    /// Anything.
    Noise(f64),
    NotFinite,
    Missing,
    /// The same time again.
    Repeated,
    /// Blocks of so many epochs come in reverse.
    Reordered(usize),
    /// A clock that is off by this (s), throughout or in the first sample only.
    Clock(f64),
    WrongTime(f64),
    /// Anchors answer for each other.
    Swapped,
    /// IMU and wheels say that the tag stands …
    Standing,
    /// … or accelerates and drives like this.
    Driving(f64),
}

#[derive(Clone, Copy, Debug)]
struct Run {
    fault: Fault,
    begin: u64,
    length: u64,
}

fn any_fault() -> impl Strategy<Value = Fault> {
    prop_oneof![
        prop_oneof![Just(0.0), -1.0..200.0].prop_map(Fault::Equal),
        Just(Fault::Stuck),
        (0_usize..4).prop_map(Fault::StuckAnchor),
        (-1.0..20.0, -1.0..200.0).prop_map(|(a, b)| Fault::Alternating(a, b)),
        proptest::array::uniform4(any::<bool>()).prop_map(Fault::Railed),
        (-3.0..30.0).prop_map(Fault::Longer),
        (0.1..100.0).prop_map(Fault::Noise),
        Just(Fault::NotFinite),
        Just(Fault::Missing),
        Just(Fault::Repeated),
        (2_usize..20).prop_map(Fault::Reordered),
        prop_oneof![-20.0..20.0, -1e3..1e3].prop_map(Fault::Clock),
        prop_oneof![-20.0..20.0, -1e3..1e3].prop_map(Fault::WrongTime),
        Just(Fault::Swapped),
        Just(Fault::Standing),
        prop_oneof![-2.0..2.0, -100.0..100.0].prop_map(Fault::Driving),
    ]
}

fn any_run(begin: std::ops::Range<u64>, length: u64) -> impl Strategy<Value = Run> {
    (any_fault(), begin, 1..=length).prop_map(|(fault, begin, length)| Run { fault, begin, length })
}

/// What comes at a time.
#[derive(Clone, Copy, Debug)]
struct Epoch {
    time_us: u64,
    ranges: [Option<f64>; 4],
    shaken: f64,
    driven: Option<f64>,
}

/// The tag on a circle of 2 m about the middle of the room, at half a metre a second.
fn place(k: u64) -> [f64; 3] {
    let angle = 0.025 * k as f64;
    [4.0 + 2.0 * angle.cos(), 3.0 + 2.0 * angle.sin(), 1.0]
}

/// From −1 to 1.
fn noise(k: u64) -> f64 {
    (k.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407) >> 33) as f64
        / 1_073_741_824.0
        - 1.0
}

/// `count` epochs with these runs.
fn drive(count: u64, runs: &[Run]) -> Vec<Epoch> {
    let mut epochs: Vec<Epoch> = (0..count)
        .map(|k| Epoch {
            time_us: 3_600_000_000 + EPOCH_US * k,
            ranges: std::array::from_fn(|anchor| {
                Some(distance(CORNERS[anchor], place(k)) + 0.05 * noise(4 * k + anchor as u64))
            }),
            shaken: noise(7 * k + 3),
            driven: None,
        })
        .collect();
    for run in runs {
        let end = (run.begin + run.length).min(count) as usize;
        spoil(&mut epochs[run.begin as usize..end], run.fault);
    }
    epochs
}

fn spoil(epochs: &mut [Epoch], fault: Fault) {
    let Some(first) = epochs.first().copied() else { return };
    let moved = |time_us: u64, by: f64| (time_us as f64 + by * 1e6).max(0.0) as u64;
    for (k, epoch) in epochs.iter_mut().enumerate() {
        match fault {
            Fault::Equal(range) => epoch.ranges = [Some(range); 4],
            Fault::Stuck => epoch.ranges = first.ranges,
            Fault::StuckAnchor(anchor) => epoch.ranges[anchor] = first.ranges[anchor],
            Fault::Alternating(a, b) => epoch.ranges = [Some(if k % 2 == 0 { a } else { b }); 4],
            Fault::Railed(up) => epoch.ranges = up.map(|up| Some(if up { 200.0 } else { -1.0 })),
            Fault::Longer(by) => epoch.ranges = epoch.ranges.map(|range| range.map(|r| r + by)),
            Fault::Noise(size) => {
                epoch.ranges =
                    std::array::from_fn(|a| Some(size * (1.0 + noise(9 * k as u64 + a as u64))));
            }
            Fault::NotFinite => {
                epoch.ranges = [Some(f64::NAN), Some(f64::INFINITY), Some(1e30), None];
            }
            Fault::Missing => epoch.ranges = [None; 4],
            Fault::Repeated => epoch.time_us = first.time_us,
            Fault::Clock(by) => epoch.time_us = moved(epoch.time_us, by),
            Fault::WrongTime(by) if k == 0 => epoch.time_us = moved(epoch.time_us, by),
            Fault::Swapped => epoch.ranges.swap(0, 2),
            Fault::Standing => (epoch.shaken, epoch.driven) = (0.0, Some(0.0)),
            Fault::Driving(v) => {
                (epoch.shaken, epoch.driven) = (v * noise(k as u64), Some(v));
            }
            Fault::WrongTime(_) | Fault::Reordered(_) => {}
        }
    }
    if let Fault::Reordered(block) = fault {
        epochs.chunks_mut(block).for_each(<[_]>::reverse);
    }
}

/// Takes an epoch in, whatever of it is refused.
fn take<T: Scalar, const D: usize, const N: usize>(
    tracker: &mut Tracker<T, D, N, 4>,
    epoch: &Epoch,
) {
    let time_us = epoch.time_us;
    let acceleration = Vector3::new(epoch.shaken, 0.0, 9.8).map(T::from_f64);
    let push =
        (epoch.driven.is_some() && epoch.shaken != 0.0).then(|| [T::from_f64(epoch.shaken); D]);
    let _ = tracker.inertial(&InertialSample { time_us, acceleration, push });
    if let Some(speed) = epoch.driven {
        let speed = T::from_f64(speed);
        let _ = tracker.odometry(&OdometrySample { time_us, speed, turn_rate: T::ZERO });
    }
    for (anchor, range) in epoch.ranges.iter().enumerate() {
        if let Some(range) = range {
            let _ = tracker.range(&sample(time_us, anchor, *range));
        }
    }
}

fn check_finite<T: Scalar, const D: usize, const N: usize>(
    tracker: &Tracker<T, D, N, 4>,
    epoch: &Epoch,
) {
    if let Some(estimate) = tracker.estimate() {
        assert!(T::all_finite(estimate.mean.as_slice()), "{epoch:?}: {:?}", estimate.mean);
        let variances = estimate.covariance.variances();
        assert!(
            variances.iter().all(|v| v.is_finite() && *v > T::ZERO),
            "{epoch:?}: {variances:?}"
        );
    }
    let health = tracker.health(epoch.time_us);
    assert!(health.nis.is_finite() && health.nis >= T::ZERO, "{epoch:?}: {health:?}");
    assert!(health.position_sigma.is_none_or(T::is_finite), "{epoch:?}: {health:?}");
    assert!(health.dilution.is_none_or(T::is_finite), "{epoch:?}: {health:?}");
    assert!((0..4).all(|anchor| tracker.range_sigma(anchor).is_some_and(T::is_finite)));
}

fn finite<T: Scalar, const D: usize, const N: usize>(config: Config<T>, runs: &[Run]) {
    let mut tracker = Tracker::<T, D, N, 4>::new(config, &anchors(&CORNERS, 0.0)).unwrap();
    for epoch in drive(400, runs) {
        take(&mut tracker, &epoch);
        check_finite(&tracker, &epoch);
    }
}

/// Ten seconds after a run there is a position near the tag, and soon one as good as without it: an anchor's
/// variance, which may have risen to metres, remembers a hundred of its ranges, which are ten seconds here.
fn recovers<T: Scalar, const N: usize>(config: Config<T>, run: &Run) {
    let mut tracker = Tracker::<T, 2, N, 4>::new(config, &anchors(&CORNERS, 0.0)).unwrap();
    let end = run.begin + run.length;
    for (k, epoch) in (0..).zip(drive(end + 300, std::slice::from_ref(run))) {
        take(&mut tracker, &epoch);
        check_finite(&tracker, &epoch);
        if k >= end + 100 {
            let position = tracker.position().expect("a position again").map(T::to_f64);
            let truth = place(k);
            let error = (position[0] - truth[0]).hypot(position[1] - truth[1]);
            let most = if k < end + 250 { 1.0 } else { 0.3 };
            assert!(error < most, "{} epochs after: {error} m off", k - end);
        }
    }
}

/// The two that are there for comparison: finite. (The published filter is known to follow no more.)
fn comparisons<T: Scalar>(runs: &[Run]) {
    let anchors: [_; 4] = anchors(&CORNERS, 0.0).try_into().unwrap();
    let mut published =
        PublishedTracker::<T, 2, 4, 4>::new(PublishedConfig::adaptive(T::ONE), &anchors).unwrap();
    let mut solvers = [EpochMethod::Trilateration, EpochMethod::LeastSquares]
        .map(|method| EpochSolver::<T, 4>::new(method, Solver::new(T::ONE), &anchors).unwrap());
    for epoch in drive(400, runs) {
        for (anchor, range) in epoch.ranges.iter().enumerate() {
            let Some(range) = range else { continue };
            let range = sample(epoch.time_us, anchor, *range);
            let _ = published.range(&range);
            for solver in &mut solvers {
                let _ = solver.range(&range);
            }
        }
        published.end_epoch(epoch.time_us);
        if let Some(position) = published.position() {
            assert!(T::all_finite(position.as_slice()), "{epoch:?}: {position:?}");
        }
        for solver in &solvers {
            if let Ok(position) = solver.position::<2>(epoch.time_us, None) {
                assert!(T::all_finite(position.as_slice()), "{epoch:?}: {position:?}");
            }
        }
    }
}

fn cases(short: u32) -> ProptestConfig {
    let mut config = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = short;
    }
    config
}

fn all_finite<T: Scalar>(runs: &[Run]) {
    finite::<T, 2, 4>(Config::calibrated(T::ONE), runs);
    finite::<T, 2, 5>(Config::uncalibrated(T::ONE), runs);
    finite::<T, 3, 6>(Config::calibrated(T::ONE), runs);
    finite::<T, 3, 7>(Config::uncalibrated(T::ONE), runs);
    finite::<T, 2, 4>(Config::plain(T::ONE), runs);
    comparisons::<T>(runs);
}

fn all_recover<T: Scalar>(run: &Run) {
    recovers::<T, 4>(Config::calibrated(T::ONE), run);
    recovers::<T, 5>(Config::uncalibrated(T::ONE), run);
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn every_estimate_is_finite(
        runs in proptest::collection::vec(any_run(0..350, 250), 1..6)
    ) {
        all_finite::<f32>(&runs);
        all_finite::<f64>(&runs);
        all_finite::<Q12_20>(&runs);
    }

    #[test]
    fn the_tag_is_followed_again(run in any_run(0..200, 600)) {
        all_recover::<f32>(&run);
        all_recover::<f64>(&run);
        all_recover::<Q12_20>(&run);
    }
}
