//! Runs of broken samples among good ones: every estimate remains finite, and the aircraft is tracked again within ten
//! seconds. `PROPTEST_CASES` sets the number of sequences.

use kestirim_observer_design::{Complex, zero_order_hold};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{
    Dynamics, Estimator, FlightFilter, FlightObserver, Noise, Sample, observer_gain,
};
use kestirim_uav_longitudinal::{rate_airspeed_and_pitch, thesis_like};
use nalgebra::{SVector, Vector2, Vector3, Vector4};
use proptest::prelude::*;

const USUAL_S: f64 = 0.01;

/// The fault in a run of samples.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Zero,
    Stuck,
    StuckOutput(usize),
    /// Full scale of either sign.
    Railed([bool; 3]),
    Alternating,
    Noise(f64),
    NotFinite,
    Missing,
    NotMeasured,
    Repeated,
    Reordered(usize),
    Clock(f64),
    WrongTime(f64),
}

#[derive(Clone, Copy, Debug)]
struct Run {
    fault: Fault,
    begin: usize,
    length: usize,
}

fn any_run(begin: std::ops::Range<usize>, length: usize) -> impl Strategy<Value = Run> {
    let fault = prop_oneof![
        Just(Fault::Zero),
        Just(Fault::Stuck),
        (0_usize..3).prop_map(Fault::StuckOutput),
        proptest::array::uniform3(any::<bool>()).prop_map(Fault::Railed),
        Just(Fault::Alternating),
        (0.01..1.0).prop_map(Fault::Noise),
        Just(Fault::NotFinite),
        Just(Fault::Missing),
        Just(Fault::NotMeasured),
        Just(Fault::Repeated),
        (2_usize..40).prop_map(Fault::Reordered),
        prop_oneof![-20.0..20.0, -1e3..1e3].prop_map(Fault::Clock),
        prop_oneof![-20.0..20.0, -1e3..1e3].prop_map(Fault::WrongTime),
    ];
    (fault, begin, 1..=length).prop_map(|(fault, begin, length)| Run { fault, begin, length })
}

/// Pitch rate (rad/s), airspeed (m/s) and pitch angle (rad) at the limits of their sensors.
const RAILS: [f64; 3] = [8.7, 100.0, 3.1];

fn noise() -> Noise<3> {
    Noise { inputs: Vector2::new(0.009, 0.02), outputs: Vector3::new(0.009, 0.5, 0.009) }
}

/// Pseudo-random noise from −1 to 1.
fn noisy(index: usize) -> f64 {
    (index as f64 * 12.9898).sin()
}

/// A flight of this many samples, and the states.
fn flight(count: usize) -> (Vec<Sample<3>>, Vec<Vector4<f64>>) {
    let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
    let mut state = Vector4::new(0.05, 0.0, 3.0, 0.1);
    let mut states = Vec::new();
    let samples = (0..count).map(|index| {
        let input = Vector2::new(0.02 * (index as f64 * 0.03).sin(), 0.1);
        states.push(state);
        let exact = rate_airspeed_and_pitch() * state;
        let sigmas = noise().outputs;
        let measured =
            std::array::from_fn(|k| Some(exact[k] + 0.5 * sigmas[k] * noisy(3 * index + k)));
        state = plant.a * state + plant.b * input;
        Sample { time_us: 3_600_000_000 + 10_000 * index as i64, input, measured }
    });
    (samples.collect(), states)
}

fn spoil(samples: &mut Vec<Sample<3>>, run: &Run) {
    let end = (run.begin + run.length).min(samples.len());
    let part = &mut samples[run.begin..end];
    let Some(first) = part.first().copied() else { return };
    let moved = |time_us: i64, by: f64| time_us + (by * 1e6) as i64;
    for (k, sample) in part.iter_mut().enumerate() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        match run.fault {
            Fault::Zero => sample.measured = [Some(0.0); 3],
            Fault::Stuck => sample.measured = first.measured,
            Fault::StuckOutput(output) => sample.measured[output] = first.measured[output],
            Fault::Railed(up) => {
                sample.measured =
                    std::array::from_fn(|i| Some(if up[i] { RAILS[i] } else { -RAILS[i] }));
            }
            Fault::Alternating => sample.measured = RAILS.map(|rail| Some(rail * sign)),
            Fault::Noise(size) => {
                sample.measured = std::array::from_fn(|i| Some(RAILS[i] * size * noisy(7 * k + i)));
            }
            Fault::NotFinite => sample.measured[1] = Some(f64::NAN),
            Fault::NotMeasured => sample.measured = [None; 3],
            Fault::Repeated => sample.time_us = first.time_us,
            Fault::Clock(by) => sample.time_us = moved(sample.time_us, by),
            Fault::WrongTime(by) if k == 0 => sample.time_us = moved(sample.time_us, by),
            Fault::WrongTime(_) | Fault::Reordered(_) | Fault::Missing => {}
        }
    }
    match run.fault {
        Fault::Reordered(block) => part.chunks_mut(block).for_each(<[_]>::reverse),
        Fault::Missing => {
            samples.drain(run.begin..end);
        }
        _ => {}
    }
}

/// Largest error of α, q, V and θ, relative to small errors of each: below 1 is near.
fn off(estimate: &SVector<f64, 4>, truth: &Vector4<f64>) -> f64 {
    (estimate - truth).component_div(&Vector4::new(0.02, 0.05, 1.0, 0.03)).amax()
}

struct Estimators<T: Scalar> {
    filter: FlightFilter<T, 3>,
    observer: FlightObserver<T, 3>,
    /// For regular samples, which it processes one after the other.
    constant: Estimator<T, 3>,
}

impl<T: Scalar> Estimators<T> {
    fn new() -> Self {
        let (dynamics, c) = (Dynamics::Continuous(thesis_like()), rate_airspeed_and_pitch());
        let poles = [-3.0, -3.5, -4.0, -4.5].map(|pole: f64| Complex::from((pole * USUAL_S).exp()));
        let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
        let gain = observer_gain(&plant, &c, &poles).unwrap();
        let start = SVector::zeros();
        Self {
            filter: FlightFilter::new(&dynamics, &c, &noise(), USUAL_S).unwrap(),
            observer: FlightObserver::new(&dynamics, &c, &poles, USUAL_S).unwrap(),
            constant: Estimator::constant_gain(&plant, &c, &gain, &start).unwrap(),
        }
    }

    fn take(&mut self, sample: &Sample<3>) -> [SVector<f64, 4>; 3] {
        let (before, refused) = (self.filter, self.filter.take(sample).is_err());
        assert!(!refused || self.filter == before);
        let (before, refused) = (self.observer, self.observer.take(sample).is_err());
        assert!(!refused || self.observer == before);
        let _ = self.constant.step(&sample.input, &sample.measured);
        let estimates =
            [self.filter.filter().estimate(), self.observer.estimate(), self.constant.estimate()];
        for estimate in &estimates {
            assert!(estimate.iter().all(|x| x.is_finite()), "{sample:?} {estimates:?}");
        }
        let sigma = self.filter.filter().sigma();
        assert!(sigma.iter().all(|x| x.is_finite() && *x >= 0.0), "{sample:?} {sigma}");
        estimates
    }
}

fn finite<T: Scalar>(runs: &[Run]) {
    let (mut samples, _) = flight(4000);
    for run in runs {
        if run.begin < samples.len() {
            spoil(&mut samples, run);
        }
    }
    let mut estimators = Estimators::<T>::new();
    for sample in &samples {
        estimators.take(sample);
    }
}

fn recovers<T: Scalar>(run: &Run) {
    let end = run.begin + run.length;
    let (mut samples, states) = flight(end + 1300);
    spoil(&mut samples, run);
    let mut estimators = Estimators::<T>::new();
    let missing = states.len() - samples.len();
    for (index, sample) in samples.iter().enumerate() {
        let estimates = estimators.take(sample);
        let index = index + missing;
        if index >= end + 1000 {
            let next = states.get(index + 1).unwrap_or(&states[index]);
            for (name, off) in [
                ("filter", off(&estimates[0], &states[index])),
                ("observer", off(&estimates[1], &states[index])),
                ("constant gain", off(&estimates[2], next)),
            ] {
                assert!(
                    off < 2.0 || (missing > 0 && name == "constant gain" && off < 4.0),
                    "{name}: {off} at {}",
                    index - end
                );
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

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn every_estimate_is_finite(
        runs in proptest::collection::vec(any_run(0..3000, 1000), 1..8)
    ) {
        finite::<f32>(&runs);
        finite::<f64>(&runs);
        finite::<Q16_16>(&runs);
    }

    #[test]
    fn the_aircraft_is_followed_again(run in any_run(0..1000, 6000)) {
        recovers::<f32>(&run);
        recovers::<f64>(&run);
        recovers::<Q16_16>(&run);
    }
}
