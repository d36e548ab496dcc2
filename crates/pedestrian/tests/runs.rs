//! Runs of broken samples among good ones: whatever comes, every estimate is finite, and the foot is followed
//! again. `PROPTEST_CASES` sets the number of sequences.

mod common;

use common::Foot;
use kestirim_pedestrian::{
    Config, Ekf, Error, Estimate, ImuSample, Lite, Navigator, OfflineTracker, Stride, Tracker,
};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::{SVector, Vector3};
use proptest::prelude::*;
use std::sync::LazyLock;

/// What is wrong with a run of samples.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Zero,
    /// Of one sensor only.
    ZeroRate,
    /// The last value again and again, of the gyroscope alone or of both.
    Frozen,
    FrozenRate,
    /// Any constant.
    Constant([f64; 6]),
    /// Full scale of either sign.
    Railed([bool; 6]),
    Alternating([f64; 6]),
    AlternatingRails,
    /// Something else each time, of everyday size or as large as any that is taken.
    Noise(f64),
    NotFinite,
    /// None at all.
    Missing,
    /// The same time again.
    Repeated,
    /// Neighbours swapped, or blocks of so many reversed.
    Reordered(usize),
    /// A clock that is this far off (s).
    Clock(f64),
    /// And only in the first sample.
    WrongTime(f64),
}

#[derive(Clone, Debug)]
struct Run {
    fault: Fault,
    begin: usize,
    length: usize,
}

fn any_fault() -> impl Strategy<Value = Fault> {
    let values = || {
        (proptest::array::uniform3(-60.0..60.0), proptest::array::uniform3(-20.0..20.0))
            .prop_map(|(f, w)| [f[0], f[1], f[2], w[0], w[1], w[2]])
    };
    prop_oneof![
        Just(Fault::Zero),
        Just(Fault::ZeroRate),
        Just(Fault::Frozen),
        Just(Fault::FrozenRate),
        values().prop_map(Fault::Constant),
        proptest::array::uniform6(any::<bool>()).prop_map(Fault::Railed),
        values().prop_map(Fault::Alternating),
        Just(Fault::AlternatingRails),
        prop_oneof![1.0..30.0, 30.0..1700.0].prop_map(Fault::Noise),
        Just(Fault::NotFinite),
        Just(Fault::Missing),
        Just(Fault::Repeated),
        (2_usize..40).prop_map(Fault::Reordered),
        prop_oneof![-20.0..20.0, -1e4..1e4].prop_map(Fault::Clock),
        prop_oneof![-20.0..20.0, -1e4..1e4].prop_map(Fault::WrongTime),
    ]
}

fn any_run(begin: impl Strategy<Value = usize>, length: usize) -> impl Strategy<Value = Run> {
    (any_fault(), begin, 1..=length).prop_map(|(fault, begin, length)| Run { fault, begin, length })
}

/// Two minutes of walking straight on at 100 Hz, an hour after the clock began.
static WALK: LazyLock<Vec<ImuSample<f64>>> = LazyLock::new(|| {
    let foot = Foot { headings: vec![0.0; 105], noise: 0.05, ..Foot::default() };
    let mut samples = foot.samples();
    for sample in &mut samples {
        sample.time_us += 3_600_000_000;
    }
    samples
});

fn spoil(samples: &mut [ImuSample<f64>], fault: Fault) -> bool {
    const RAILS: [f64; 6] = [156.9, 156.9, 156.9, 34.9, 34.9, 34.9];
    let Some(first) = samples.first().copied() else { return true };
    let set = |sample: &mut ImuSample<f64>, v: [f64; 6]| {
        sample.specific_force = Vector3::new(v[0], v[1], v[2]);
        sample.angular_rate = Vector3::new(v[3], v[4], v[5]);
    };
    let moved = |time_us: u64, by: f64| (time_us as f64 + by * 1e6).max(0.0) as u64;
    for (k, sample) in samples.iter_mut().enumerate() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        match fault {
            Fault::Zero => set(sample, [0.0; 6]),
            Fault::ZeroRate => sample.angular_rate = Vector3::zeros(),
            Fault::Frozen => *sample = ImuSample { time_us: sample.time_us, ..first },
            Fault::FrozenRate => sample.angular_rate = first.angular_rate,
            Fault::Constant(v) => set(sample, v),
            Fault::Railed(up) => {
                set(sample, std::array::from_fn(|i| if up[i] { RAILS[i] } else { -RAILS[i] }));
            }
            Fault::Alternating(v) => set(sample, v.map(|v| v * sign)),
            Fault::AlternatingRails => set(sample, RAILS.map(|v| v * sign)),
            Fault::Noise(size) => {
                let mut state = k as u64 + 1;
                set(
                    sample,
                    std::array::from_fn(|_| {
                        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(99);
                        ((state >> 40) as f64 / 8_388_608.0 - 1.0) * size
                    }),
                );
            }
            Fault::NotFinite => sample.specific_force.y = f64::NAN,
            Fault::Repeated => sample.time_us = first.time_us,
            Fault::Clock(by) => sample.time_us = moved(sample.time_us, by),
            Fault::WrongTime(by) if k == 0 => sample.time_us = moved(sample.time_us, by),
            Fault::WrongTime(_) | Fault::Missing | Fault::Reordered(_) => {}
        }
    }
    if let Fault::Reordered(block) = fault {
        samples.chunks_mut(block).for_each(<[_]>::reverse);
    }
    !matches!(fault, Fault::Missing)
}

/// The walk with these runs in it.
fn spoilt<T: Scalar>(runs: &[Run]) -> Vec<ImuSample<T>> {
    let mut samples = WALK.clone();
    let mut kept = vec![true; samples.len()];
    for run in runs {
        let end = (run.begin + run.length).min(samples.len());
        if !spoil(&mut samples[run.begin..end], run.fault) {
            kept[run.begin..end].fill(false);
        }
    }
    let kept = samples.iter().zip(kept).filter(|(_, kept)| *kept);
    kept.map(|(sample, _)| cast(sample)).collect()
}

fn cast<T: Scalar>(sample: &ImuSample<f64>) -> ImuSample<T> {
    let cast = |v: Vector3<f64>| SVector::<T, 3>::from(v.map(T::from_f64));
    ImuSample {
        time_us: sample.time_us,
        specific_force: cast(sample.specific_force),
        angular_rate: cast(sample.angular_rate),
    }
}

fn check_finite<T: Scalar>(estimate: &Estimate<T>) {
    let finite = T::all_finite(estimate.position.as_slice())
        && T::all_finite(estimate.velocity.as_slice())
        && T::all_finite(&estimate.orientation.quaternion())
        && estimate.stride.is_none_or(|stride| {
            T::all_finite(stride.position.as_slice())
                && T::all_finite(&[stride.length, stride.duration, stride.heading_change])
        });
    assert!(finite, "{estimate:?}");
}

/// The strides of a walk, all of whose estimates are finite, and the samples that were taken.
fn causal<T: Scalar, N: Navigator<T>>(
    samples: &[ImuSample<T>],
) -> (Vec<Stride<T>>, Vec<ImuSample<T>>) {
    let mut tracker = Tracker::<T, N>::new(Config { contact_height: T::ZERO, ..Config::default() });
    let (mut strides, mut taken) = (Vec::new(), Vec::<ImuSample<T>>::new());
    for sample in samples {
        match tracker.update(sample) {
            Ok(estimate) => {
                check_finite(&estimate);
                strides.extend(estimate.stride);
                if taken.last().is_none_or(|last| last.time_us <= sample.time_us) {
                    taken.push(*sample);
                }
            }
            Err(Error::TimeBackwards | Error::NotFinite | Error::Implausible) => {}
            Err(error) => panic!("{error}"),
        }
    }
    strides.extend(tracker.finish());
    assert!(tracker.path_length().is_finite());
    assert!(T::all_finite(tracker.alignment().gyro_bias().as_slice()));
    assert!(T::all_finite(tracker.alignment().accelerometer_bias().as_slice()));
    (strides, taken)
}

fn offline<T: Scalar, N: Navigator<T>>(samples: &[ImuSample<T>]) -> Vec<Stride<T>> {
    let mut memory = vec![T::ZERO; samples.len()];
    let config = Config { contact_height: T::ZERO, ..Config::default() };
    let mut tracker = OfflineTracker::<T, N>::new(config, samples, &mut memory).unwrap();
    let mut strides = Vec::new();
    for estimate in tracker.by_ref() {
        check_finite(&estimate);
        strides.extend(estimate.stride);
    }
    strides.extend(tracker.finish());
    assert!(tracker.path_length().is_finite());
    strides
}

fn finite<T: Scalar>(runs: &[Run]) {
    let samples = spoilt::<T>(runs);
    let (_, taken) = causal::<T, Ekf<T>>(&samples);
    offline::<T, Ekf<T>>(&taken);
    causal::<T, Lite<T>>(&samples);
    offline::<T, Lite<T>>(&taken);
}

/// From ten seconds after a run on, the strides are those of the walk: as long, and straight on.
fn follows<T: Scalar>(run: &Run, name: &str, strides: &[Stride<T>]) {
    let end_us = WALK[run.begin + run.length].time_us + 10_000_000;
    let after = strides.iter().filter(|stride| {
        stride.time_us as f64 - stride.duration.to_f64() * 1e6 > end_us as f64
            && stride.time_us <= WALK[WALK.len() - 1].time_us
    });
    let expected = (WALK[WALK.len() - 1].time_us - 1_000_000 - end_us) / 1_100_000;
    let mut count = 0;
    for (index, stride) in after.enumerate() {
        let (length, turn) = (stride.length.to_f64(), stride.heading_change.to_f64());
        assert!((length / 1.2 - 1.0).abs() < 0.05, "{name}: {length} m");
        assert!(index == 0 || turn.abs() < 0.05, "{name}: {turn} rad");
        count += 1;
    }
    assert!(count + 2 > expected, "{name}: {count} of {expected} strides");
}

fn recovers<T: Scalar>(run: &Run) {
    let samples = spoilt::<T>(std::slice::from_ref(run));
    let (strides, taken) = causal::<T, Ekf<T>>(&samples);
    follows(run, "causal ekf", &strides);
    follows(run, "causal lite", &causal::<T, Lite<T>>(&samples).0);
    // A recording whose times are wrong is not one.
    if taken.len() == samples.len() {
        follows(run, "offline ekf", &offline::<T, Ekf<T>>(&taken));
        follows(run, "offline lite", &offline::<T, Lite<T>>(&taken));
    }
}

fn cases(short: u32) -> ProptestConfig {
    let mut config = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = short;
    }
    config
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn every_estimate_is_finite(
        runs in proptest::collection::vec(any_run(0_usize..11_000, 1000), 1..12)
    ) {
        finite::<f32>(&runs);
        finite::<f64>(&runs);
        finite::<Q12_20>(&runs);
    }

    #[test]
    fn the_foot_is_followed_again(run in any_run(0_usize..3000, 6000)) {
        recovers::<f32>(&run);
        recovers::<f64>(&run);
        recovers::<Q12_20>(&run);
    }
}
