//! Flights with gaps and missing outputs.

use kestirim_kalman::{Covariance, Gaussian, LinearObservation, SparseRow};
use kestirim_observer_design::{Complex, zero_order_hold};
use kestirim_uav_estimator::{
    Dynamics, Error, Estimator, FlightFilter, FlightObserver, KalmanFilter, Noise, Reason, Sample,
};
use kestirim_uav_longitudinal::{airspeed_and_pitch, navion, rate_airspeed_and_pitch, thesis_like};
use nalgebra::{SMatrix, SVector, Vector2, Vector3, Vector4};
use proptest::prelude::*;

const USUAL_S: f64 = 0.01;

fn noise() -> Noise<3> {
    Noise { inputs: Vector2::new(0.009, 0.02), outputs: Vector3::new(0.009, 0.5, 0.009) }
}

fn dynamics() -> Dynamics {
    Dynamics::Continuous(thesis_like())
}

/// A pseudo-random number from −1 to 1.
fn noisy(index: i64) -> f64 {
    (index as f64 * 12.9898).sin()
}

fn input(index: i64) -> Vector2<f64> {
    Vector2::new(0.02 * (index as f64 * 0.03).sin(), 0.1)
}

/// The aircraft's samples at these multiples of 10 ms, with all outputs measured with a little noise, and its last
/// state.
fn flight(at: &[i64]) -> (Vec<Sample<3>>, Vector4<f64>) {
    let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
    let mut state = Vector4::new(0.05, 0.0, 3.0, 0.1);
    let mut samples = Vec::new();
    let mut applied = Vector2::zeros();
    for index in 0..=*at.last().unwrap() {
        if index > 0 {
            state = plant.a * state + plant.b * applied;
        }
        if at.contains(&index) {
            applied = input(index);
            let exact = rate_airspeed_and_pitch() * state;
            let sigmas = noise().outputs;
            let measured = |output: usize| {
                Some(exact[output] + 0.5 * sigmas[output] * noisy(3 * index + output as i64))
            };
            let measured = std::array::from_fn(measured);
            samples.push(Sample { time_us: index * 10_000, input: applied, measured });
        }
    }
    (samples, state)
}

#[test]
fn gaps_and_missing_outputs_cost_little() {
    let at: Vec<i64> = (0..800).filter(|index| !(300..340).contains(index)).collect();
    let (mut samples, truth) = flight(&at);
    for sample in &mut samples[500..600] {
        sample.measured[1] = None;
    }
    let mut filter =
        FlightFilter::<f64, 3>::new(&dynamics(), &rate_airspeed_and_pitch(), &noise(), USUAL_S)
            .unwrap();
    let poles = [-3.0, -3.5, -4.0, -4.5].map(|pole: f64| Complex::from((pole * USUAL_S).exp()));
    let mut observer =
        FlightObserver::<f64, 3>::new(&dynamics(), &rate_airspeed_and_pitch(), &poles, USUAL_S)
            .unwrap();
    for sample in &samples {
        let known = filter.filter().sigma();
        let innovations = filter.take(sample).unwrap();
        assert_eq!(innovations[1].is_none(), sample.measured[1].is_none());
        let residuals = observer.take(sample).unwrap();
        assert_eq!(residuals[1].is_none(), sample.measured[1].is_none());
        if sample.time_us == 3_400_000 {
            // The noise during the gap is in the expected variance of the first sample after it.
            let airspeed = innovations[1].unwrap();
            assert!(airspeed.variance > known[2].powi(2) + 0.25);
        }
    }
    let error = filter.filter().estimate() - truth;
    for (error, sigma) in error.iter().zip(&filter.filter().sigma()) {
        assert!(error.abs() < 3.0 * sigma, "{error} {sigma}");
    }
    let error = observer.estimate() - truth;
    assert!(error.component_div(&Vector4::new(0.02, 0.05, 0.5, 0.02)).amax() < 1.0, "{error}");
}

#[test]
fn all_scalars_tell_the_same() {
    fn last<T: kestirim_scalar::Scalar>(samples: &[Sample<3>]) -> Vector4<f64> {
        let c = rate_airspeed_and_pitch();
        let mut filter = FlightFilter::<T, 3>::new(&dynamics(), &c, &noise(), USUAL_S).unwrap();
        for sample in samples {
            filter.take(sample).unwrap();
        }
        filter.filter().estimate()
    }
    let (samples, _) = flight(&(0..400).collect::<Vec<_>>());
    let exact = last::<f64>(&samples);
    let off =
        |found: Vector4<f64>| (found - exact).component_div(&Vector4::new(1.0, 1.0, 40.0, 1.0));
    assert!(off(last::<f32>(&samples)).amax() < 1e-5);
    assert!(off(last::<kestirim_scalar::Q16_16>(&samples)).amax() < 1e-3);
}

#[test]
fn units_inside_change_no_bit() {
    let c = SMatrix::<f64, 2, 4>::new(0.3, -1.7, 0.01, 2.0, 0.0, 0.0, 1.0, 3.0);
    let (sigmas, start) = (Vector2::new(0.02, 0.3), Vector4::new(0.01, 0.0, -2.0, 0.05));
    let doubts = Vector4::new(0.2, 0.5, 20.0, 0.5);
    let step =
        Dynamics::Continuous(navion()).over(0.013, 0.01, &Vector2::new(0.009, 0.02)).unwrap();
    let mut filter = KalmanFilter::<f64, 2>::new(&c, &sigmas, &start, &doubts).unwrap();
    let variances = doubts.map(|doubt| doubt * doubt).into();
    let mut plain = Gaussian::new(start, Covariance::from_variances(&variances));
    let transition = kestirim_uav_estimator::Transition::new(&step);
    for index in 0..100 {
        let measured = [Some(noisy(index)), (index % 3 != 0).then_some(2.0 * noisy(-index))];
        let innovations = filter.correct(&measured).unwrap();
        for (output, measured) in measured.into_iter().enumerate() {
            let row = SparseRow::<f64, 4>::new(std::array::from_fn(|i| (i, c[(output, i)])));
            let variance = sigmas[output] * sigmas[output];
            let told = measured.map(|measured| {
                plain.observe(&LinearObservation { row, measured }, variance).unwrap()
            });
            assert_eq!(innovations[output], told);
        }
        filter.predict(&transition, &input(index)).unwrap();
        plain.predict(&step.transition.a, &Covariance::from_lower_triangle(&step.noise)).unwrap();
        plain.mean += step.transition.b * input(index);
        assert_eq!(filter.estimate(), plain.mean);
        assert_eq!(filter.covariance(), plain.covariance.to_matrix());
    }
}

#[test]
fn a_missing_output_is_what_was_expected() {
    let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
    let c = airspeed_and_pitch();
    let gain = SMatrix::<f64, 4, 2>::new(0.01, 0.1, -0.02, 0.3, 0.2, 0.1, 0.0, 0.4);
    let start = Vector4::new(0.1, 0.0, 2.0, 0.1);
    let mut missing = Estimator::<f64, 2>::constant_gain(&plant, &c, &gain, &start).unwrap();
    let mut told = missing;
    let expected = c * missing.estimate();
    missing.step(&input(1), &[None, Some(0.2)]).unwrap();
    told.step(&input(1), &[Some(expected[0]), Some(0.2)]).unwrap();
    assert!((missing.estimate() - told.estimate()).amax() < 1e-15);
    assert_eq!(missing.sigma(), None);
}

#[test]
fn what_is_refused_changes_nothing() {
    let (samples, _) = flight(&[0, 1, 2]);
    let c = rate_airspeed_and_pitch();
    let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
    let model = Dynamics::Discrete { step: plant, interval: USUAL_S };
    let mut filter = FlightFilter::<f64, 3, 4>::new(&model, &c, &noise(), USUAL_S).unwrap();
    filter.take(&samples[0]).unwrap();
    filter.take(&samples[1]).unwrap();
    let before = filter;
    let at = |time_us: i64| Sample { time_us, ..samples[2] };
    assert_eq!(filter.take(&at(10_000)), Err(Error::OutOfOrder));
    assert_eq!(filter.take(&at(-5)), Err(Error::OutOfOrder));
    let between = Error::WrongInterval { own: USUAL_S, found: 0.015 };
    assert_eq!(filter.take(&at(25_000)), Err(between));
    let wild = Sample { measured: [Some(f64::NAN), None, None], ..samples[2] };
    assert_eq!(filter.take(&wild), Err(Error::NotFinite));
    assert_eq!(filter, before);
    // Two steps of the model, to within a tenth.
    assert!(filter.take(&at(30_500)).is_ok());
}

/// An aircraft that is parked overnight, or whose log goes on between the steps of a discrete-time model, is followed
/// again: as by a new estimator.
#[test]
fn what_no_step_leads_to_begins_anew() {
    let (samples, _) = flight(&(0..400).collect::<Vec<_>>());
    let c = rate_airspeed_and_pitch();
    let poles = [-3.0, -3.5, -4.0, -4.5].map(|pole: f64| Complex::from((pole * USUAL_S).exp()));
    let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
    let discrete = Dynamics::Discrete { step: plant, interval: USUAL_S };
    let (flown, later) = samples.split_at(200);
    // A pause of two nights; half a step; and a clock that was set back.
    for (model, pause_us, refused) in
        [(dynamics(), 2 * 86_400_000_000, 0), (discrete, 5_000, 9), (dynamics(), -10_000_000, 0)]
    {
        let filter = || FlightFilter::<f64, 3>::new(&model, &c, &noise(), USUAL_S).unwrap();
        let observer = || FlightObserver::<f64, 3>::new(&model, &c, &poles, USUAL_S).unwrap();
        let (mut kept, mut new) = ((filter(), observer()), (filter(), observer()));
        for sample in flown {
            kept.0.take(sample).unwrap();
            kept.1.take(sample).unwrap();
        }
        for (index, sample) in later.iter().enumerate() {
            // An output that jumped meanwhile contradicts the old estimate, not the new one.
            let mut sample = Sample { time_us: sample.time_us + pause_us, ..*sample };
            sample.measured[1] = sample.measured[1].map(|airspeed| airspeed + 3.0);
            if index < refused {
                assert!(
                    matches!(kept.0.take(&sample), Err(Error::WrongInterval { .. })),
                    "{index}"
                );
                assert!(
                    matches!(kept.1.take(&sample), Err(Error::WrongInterval { .. })),
                    "{index}"
                );
            } else {
                assert_eq!(kept.0.take(&sample), new.0.take(&sample), "{pause_us} {index}");
                assert_eq!(kept.1.take(&sample), new.1.take(&sample), "{pause_us} {index}");
            }
        }
        assert_eq!(kept.0.filter(), new.0.filter());
        assert_eq!(kept.1.estimate(), new.1.estimate());
    }
}

#[test]
fn a_discrete_model_is_stepped_over_a_gap() {
    let plant = zero_order_hold(&thesis_like().a, &thesis_like().b, USUAL_S).unwrap();
    let model = Dynamics::Discrete { step: plant, interval: USUAL_S };
    let inputs = Vector2::new(0.009, 0.02);
    let [seven, exact] = [model, dynamics()].map(|it| it.over(0.07, USUAL_S, &inputs).unwrap());
    assert!((seven.transition.a - exact.transition.a).amax() < 1e-13);
    assert!((seven.transition.b - exact.transition.b).amax() < 1e-13);
    // White noise that is held for a sample, and continuous white noise: nearly the same.
    assert!((seven.noise - exact.noise).amax() < 0.2 * exact.noise.amax());
    // So they are if the log has a sample for every five steps.
    let [seven, exact] =
        [model, dynamics()].map(|it| it.over(0.07, 5.0 * USUAL_S, &inputs).unwrap());
    assert!((seven.noise - exact.noise).amax() < 0.2 * exact.noise.amax());
}

proptest! {
    /// Which steps are cached makes no difference.
    #[test]
    fn kept_steps_are_those_computed(intervals in prop::collection::vec(9_990_i64..10_010, 1..40)) {
        let c = rate_airspeed_and_pitch();
        let mut kept = FlightFilter::<f64, 3, 32>::new(&dynamics(), &c, &noise(), USUAL_S).unwrap();
        let mut anew = FlightFilter::<f64, 3, 1>::new(&dynamics(), &c, &noise(), USUAL_S).unwrap();
        let mut time_us = 0;
        for (index, interval) in (0..).zip(intervals) {
            time_us += interval;
            let measured = SVector::<f64, 3>::from_fn(|output, _| noisy(index + output as i64));
            let measured = <[f64; 3]>::from(measured).map(|value| (value > -0.8).then_some(value));
            let sample = Sample { time_us, input: input(index), measured };
            prop_assert_eq!(kept.take(&sample), anew.take(&sample));
        }
        prop_assert_eq!(kept.filter(), anew.filter());
    }
}

/// After 3 s, one sample in thirty has an output that is off by forty times its noise: a tenth of a radian, twenty
/// metres per second.
fn spiked(samples: &[Sample<3>]) -> Vec<Sample<3>> {
    let mut samples = samples.to_vec();
    for (index, sample) in samples.iter_mut().enumerate().skip(300) {
        let (output, sign) = (index % 3, if index % 2 == 0 { 1.0 } else { -1.0 });
        if index.wrapping_mul(0x9E37_79B9) % 100 < 3 {
            let spike = 40.0 * sign * noise().outputs[output];
            sample.measured[output] = sample.measured[output].map(|value| value + spike);
        }
    }
    samples
}

#[test]
fn spikes_cost_little() {
    let (samples, _) = flight(&(0..3000).collect::<Vec<_>>());
    let c = rate_airspeed_and_pitch();
    let poles = [-3.0, -3.5, -4.0, -4.5].map(|pole: f64| Complex::from((pole * USUAL_S).exp()));
    let filter = || FlightFilter::<f64, 3>::new(&dynamics(), &c, &noise(), USUAL_S).unwrap();
    let observer = || FlightObserver::<f64, 3>::new(&dynamics(), &c, &poles, USUAL_S).unwrap();
    let (mut clean, mut hurt) = ((filter(), observer()), (filter(), observer()));
    let scale = Vector4::new(0.01, 0.01, 0.5, 0.01);
    let (mut worst_filter, mut worst_observer) = (0.0_f64, 0.0_f64);
    for (sample, spiked) in samples.iter().zip(spiked(&samples)) {
        clean.0.take(sample).unwrap();
        clean.1.take(sample).unwrap();
        hurt.0.take(&spiked).unwrap();
        hurt.1.take(&spiked).unwrap();
        let apart = |a: Vector4<f64>, b: Vector4<f64>| (a - b).component_div(&scale).amax();
        let filters = apart(clean.0.filter().estimate(), hurt.0.filter().estimate());
        worst_filter = worst_filter.max(filters);
        worst_observer = worst_observer.max(apart(clean.1.estimate(), hurt.1.estimate()));
    }
    let spikes: u32 = hurt.0.rejected().iter().sum();
    println!("{spikes} spikes: filter {worst_filter}, observer {worst_observer}");
    assert!(spikes > 50, "{spikes}");
    assert_eq!(clean.0.rejected(), &[0; 3]);
    assert_eq!(clean.1.rejected(), &[0; 3]);
    assert_eq!(hurt.1.rejected(), hurt.0.rejected());
    assert!(worst_filter < 0.5 && worst_observer < 0.5, "{worst_filter} {worst_observer}");
}

/// A gate that never opened again would lose an aircraft whose motion deviates from the model.
#[test]
fn what_has_changed_is_followed() {
    let (mut samples, _) = flight(&(0..2000).collect::<Vec<_>>());
    for sample in &mut samples[1000..] {
        sample.measured[1] = sample.measured[1].map(|airspeed| airspeed + 30.0);
    }
    let c = rate_airspeed_and_pitch();
    let poles = [-3.0, -3.5, -4.0, -4.5].map(|pole: f64| Complex::from((pole * USUAL_S).exp()));
    let mut filter = FlightFilter::<f64, 3>::new(&dynamics(), &c, &noise(), USUAL_S).unwrap();
    let mut observer = FlightObserver::<f64, 3>::new(&dynamics(), &c, &poles, USUAL_S).unwrap();
    let mut is_told = false;
    for (index, sample) in samples.iter().enumerate() {
        filter.take(sample).unwrap();
        observer.take(sample).unwrap();
        let rejects = observer.health().has(Reason::Rejected);
        assert!(index >= 1000 || !rejects, "{index}");
        is_told |= rejects;
    }
    assert!(is_told, "one output of three has failed");
    let expected = samples.last().unwrap().measured[1].unwrap();
    let found = [filter.filter().estimate()[2], observer.estimate()[2]];
    assert!(found.iter().all(|found| (found - expected).abs() < 10.0), "{found:?} {expected}");
}

/// Whether it is reported at any sample of thirty seconds that inputs and outputs are not simultaneous.
fn is_told<T: kestirim_scalar::Scalar>(outputs_late: usize, inputs_late: usize) -> bool {
    let (samples, _) = flight(&(0..3000).collect::<Vec<_>>());
    let c = rate_airspeed_and_pitch();
    let mut filter = FlightFilter::<T, 3>::new(&dynamics(), &c, &noise(), USUAL_S).unwrap();
    let mut is_told = false;
    for (index, sample) in samples.iter().enumerate() {
        let late = |by: usize| samples[index.saturating_sub(by)];
        let (input, measured) = (late(inputs_late).input, late(outputs_late).measured);
        filter.take(&Sample { time_us: sample.time_us, input, measured }).unwrap();
        is_told |= filter.health().has(Reason::Time);
    }
    is_told
}

#[test]
fn what_comes_late_is_told() {
    fn check<T: kestirim_scalar::Scalar>() {
        assert!(!is_told::<T>(0, 0));
        assert!(is_told::<T>(5, 0) && is_told::<T>(0, 10));
    }
    check::<f32>();
    check::<f64>();
    check::<kestirim_scalar::Q16_16>();
}
