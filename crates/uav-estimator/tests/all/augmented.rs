//! The filter with more than four states: gusts, wind, biases, a wrong trim, specific forces.

use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{
    AugmentedFilter, AugmentedFlight, AugmentedModel, Drift, Dynamics, Error, FlightFilter, Gust,
    Noise, Output, Reference, Sample,
};
use kestirim_uav_longitudinal::{navion, rate_airspeed_and_pitch};
use nalgebra::{SMatrix, SVector, Vector2, Vector3, Vector4};

use crate::dice::Dice;

const USUAL_S: f64 = 0.02;
const AIRSPEED: f64 = 53.6;
const SIGMAS: [f64; 6] = [0.003, 0.3, 0.003, 0.3, 0.3, 0.3];
/// Specific force along z in the steady flight, and its derivatives with respect to α and δe.
const STEADY: f64 = -9.7;
const BY_ALPHA: f64 = -108.0;
const BY_ELEVATOR: f64 = -8.0;

fn force() -> Output {
    Output {
        row: [BY_ALPHA, 0.0, 2.0 * STEADY / AIRSPEED, 0.0],
        direct: [BY_ELEVATOR, 0.0],
        sigma: SIGMAS[3],
        reference: Reference::Pressure { steady: STEADY, airspeed: AIRSPEED },
    }
}

/// The outputs q, V, θ, specific force, ground speed, rate of climb.
fn outputs() -> [Output; 6] {
    let ground = |row| Output { row, direct: [0.0; 2], sigma: 0.3, reference: Reference::Ground };
    [
        Output::state(1, SIGMAS[0]),
        Output::state(2, SIGMAS[1]),
        Output::state(3, SIGMAS[2]),
        force(),
        ground([0.0, 0.0, 1.0, 0.0]),
        ground([-AIRSPEED, 0.0, 0.0, AIRSPEED]),
    ]
}

const DRIFT: Drift = Drift { sigma: 0.02, rate: 1e-5 };

fn gusts(sigma: f64) -> Gust {
    Gust { sigmas: [sigma; 2], lengths: [300.0, 150.0], airspeed: AIRSPEED }
}

type Model = AugmentedModel<11, 7, 6>;

/// A model with gusts of this size, a force on V, biases of q and θ, and a head wind.
fn model(gust: f64) -> Model {
    let density = SMatrix::from_diagonal(&Vector4::new(1e-8, 1e-5, 1e-4, 1e-9));
    let model = Model::new(&navion(), &density, &outputs()).unwrap();
    let model = model.with_gust(&gusts(gust)).unwrap();
    let model = model.with_force(2, &Drift { sigma: 0.3, rate: 0.01 }).unwrap();
    let model = model.with_bias(0, &DRIFT).unwrap().with_bias(2, &DRIFT).unwrap();
    model.with_wind(&Drift { sigma: 8.0, rate: 0.0 }).unwrap()
}

/// The true state at a sample: α and V relative to the air, q, θ; gusts, force, biases, wind.
type Truth = SVector<f64, 10>;

/// A flight through gusts, integrated relative to the ground in small steps: of the filter's model it only uses A and
/// B.
fn flight(
    seconds: f64,
    gust: f64,
    beside: [f64; 4],
    dice: &mut Dice,
) -> (Vec<Sample<6>>, Vec<Truth>) {
    const SMALL: usize = 20;
    let h = USUAL_S / SMALL as f64;
    let plant = navion();
    let [force, rate_bias, pitch_bias, wind] = beside;
    let mut inertial = Vector4::zeros();
    let mut gusts = [gust * dice.gaussian(), gust * dice.gaussian()];
    let (mut samples, mut truths) = (Vec::new(), Vec::new());
    for index in 0..(seconds / USUAL_S) as i64 {
        let input = Vector2::new(0.02 * f64::from((index as f64 * 0.013).sin() > 0.0), 0.02);
        let airy = |inertial: &Vector4<f64>, gusts: &[f64; 2]| {
            inertial + Vector4::new(gusts[1] / AIRSPEED, 0.0, gusts[0], 0.0)
        };
        let air = airy(&inertial, &gusts);
        let specific = (1.0 + air[2] / AIRSPEED).powi(2)
            * (STEADY + BY_ALPHA * air[0] + BY_ELEVATOR * input[0])
            - STEADY;
        let exact = [
            air[1] + rate_bias,
            air[2],
            air[3] + pitch_bias,
            specific,
            inertial[2] - wind,
            AIRSPEED * (inertial[3] - inertial[0]),
        ];
        let measured = std::array::from_fn(|i| Some(exact[i] + SIGMAS[i] * dice.gaussian()));
        samples.push(Sample { time_us: index * 20_000, input, measured });
        truths.push(Truth::from_iterator(
            air.iter().copied().chain(gusts).chain([force, rate_bias, pitch_bias, wind]),
        ));
        for _ in 0..SMALL {
            let air = airy(&inertial, &gusts);
            inertial += h * (plant.a * air + plant.b * input);
            inertial[2] += h * force;
            inertial[1] += (1e-5 * h).sqrt() * dice.gaussian();
            inertial[2] += (1e-4 * h).sqrt() * dice.gaussian();
            // The effect of the tail's lag is approximated by white noise.
            let lag = 0.5 * plant.a[(1, 1)] * gust / AIRSPEED;
            inertial[1] += lag * (2.0 * AIRSPEED / 150.0 * h).sqrt() * dice.gaussian();
            for (now, length) in gusts.iter_mut().zip([300.0, 150.0]) {
                let fading = AIRSPEED / length;
                *now += -fading * h * *now + gust * (2.0 * fading * h).sqrt() * dice.gaussian();
            }
        }
    }
    (samples, truths)
}

fn rms(numbers: impl Iterator<Item = f64>) -> f64 {
    let numbers: Vec<f64> = numbers.collect();
    (numbers.iter().map(|number| number * number).sum::<f64>() / numbers.len() as f64).sqrt()
}

#[test]
fn errors_and_innovations_are_as_large_as_the_filter_says() {
    let (mut nees, mut nis, mut count) = (0.0, [0.0; 6], 0.0);
    for seed in 0..20 {
        let mut dice = Dice::new(seed);
        let beside = [0.3, 0.02, 0.02, 8.0].map(|sigma| sigma * dice.gaussian());
        let (samples, truths) = flight(30.0, 2.0, beside, &mut dice);
        let mut filter =
            AugmentedFlight::<f64, 11, 7, 6>::new(&model(2.0), &Vector2::zeros(), USUAL_S).unwrap();
        for (index, (sample, truth)) in samples.iter().zip(&truths).enumerate() {
            let innovations = filter.take(sample).unwrap();
            if index < 500 {
                continue;
            }
            let state = filter.filter().estimate();
            let units = filter.filter().state_units();
            let covariance = filter.filter().state().covariance.to_matrix();
            let error = SVector::<f64, 10>::from_fn(|i, _| (state[i] - truth[i]) / units[i]);
            let known = SMatrix::<f64, 10, 10>::from_fn(|i, j| covariance[(i, j)]);
            nees += error.dot(&(known.try_inverse().unwrap() * error));
            for (sum, innovation) in nis.iter_mut().zip(innovations) {
                *sum += innovation.unwrap().nis;
            }
            count += 1.0;
        }
    }
    let nees = nees / count / 10.0;
    // Twenty flights with biases that are constant within each: the mean has a standard deviation of about 0.1.
    assert!((0.6..1.4).contains(&nees), "{nees}");
    for (output, nis) in nis.iter().enumerate() {
        let nis = nis / count;
        assert!((0.9..1.1).contains(&nis), "{output}: {nis}");
    }
}

#[test]
fn gusts_are_followed_where_a_filter_without_them_is_lost() {
    let (samples, truths) = flight(60.0, 2.0, [0.0; 4], &mut Dice::new(3));
    let error = |gust: f64| {
        let mut filter =
            AugmentedFlight::<f64, 11, 7, 6>::new(&model(gust), &Vector2::zeros(), USUAL_S)
                .unwrap();
        let errors = samples.iter().zip(&truths).map(|(sample, truth)| {
            filter.take(sample).unwrap();
            let state = filter.filter().estimate();
            [state[0] - truth[0], state[2] - truth[2]]
        });
        let errors: Vec<[f64; 2]> = errors.collect();
        [0, 1].map(|which| rms(errors[500..].iter().map(|error| error[which])))
    };
    let ([alpha, airspeed], [blind_alpha, blind_airspeed]) = (error(2.0), error(0.0));
    assert!(alpha < 0.004 && airspeed < 0.25, "{alpha} rad, {airspeed} m/s");
    assert!(alpha < 0.6 * blind_alpha && airspeed < 0.6 * blind_airspeed);
}

#[test]
fn without_anything_beside_it_is_the_filter_of_four_states() {
    let noise =
        Noise { inputs: Vector2::new(0.009, 0.02), outputs: Vector3::new(0.009, 0.5, 0.009) };
    let c = rate_airspeed_and_pitch();
    let mut four =
        FlightFilter::<f64, 3>::new(&Dynamics::Continuous(navion()), &c, &noise, USUAL_S).unwrap();
    let outputs = [1, 2, 3].map(|state| Output::state(state, noise.outputs[state - 1]));
    let model = AugmentedModel::<4, 4, 3>::new(&navion(), &SMatrix::zeros(), &outputs).unwrap();
    let mut augmented =
        AugmentedFlight::<f64, 4, 4, 3>::new(&model, &noise.inputs, USUAL_S).unwrap();
    let (samples, _) = flight(20.0, 0.0, [0.0; 4], &mut Dice::new(7));
    for (index, sample) in
        samples.iter().enumerate().filter(|(index, _)| !(300..320).contains(index))
    {
        let mut measured: [Option<f64>; 3] = std::array::from_fn(|output| sample.measured[output]);
        if index % 7 == 0 {
            measured[1] = None;
        }
        let sample = Sample { time_us: sample.time_us, input: sample.input, measured };
        four.take(&sample).unwrap();
        augmented.take(&sample).unwrap();
        let difference = four.filter().estimate() - augmented.filter().estimate();
        assert!(difference.norm() < 1e-9, "{index}: {difference}");
        assert!((four.filter().sigma() - augmented.filter().sigma()).norm() < 1e-9);
    }
    assert_eq!(four.rejected(), augmented.rejected());
    assert_eq!(four.health(), augmented.health());
}

#[test]
fn other_numbers_find_the_same() {
    fn estimates<T: Scalar>(samples: &[Sample<6>]) -> Vec<Vector4<f64>> {
        let mut filter =
            AugmentedFlight::<T, 11, 7, 6>::new(&model(1.0), &Vector2::zeros(), USUAL_S).unwrap();
        let taken = samples.iter().map(|sample| {
            filter.take(sample).unwrap();
            filter.filter().estimate().fixed_rows::<4>(0).into()
        });
        taken.collect()
    }
    let (samples, truths) = flight(40.0, 1.0, [0.1, 0.01, -0.02, 5.0], &mut Dice::new(11));
    let exact = estimates::<f64>(&samples);
    for (other, share) in [(estimates::<f32>(&samples), 0.05), (estimates::<Q16_16>(&samples), 1.0)]
    {
        for state in 0..4 {
            let late = || exact.iter().zip(&other).zip(&truths).skip(500);
            let apart = rms(late().map(|((exact, other), _)| exact[state] - other[state]));
            let wrong = rms(late().map(|((exact, _), truth)| exact[state] - truth[state]));
            assert!(apart < share * wrong, "state {state}: {apart} beside {wrong}");
        }
    }
}

/// A satellite receiver that is silent for three minutes, in a filter with unused states: roundings must not
/// accumulate.
#[test]
fn fixed_point_goes_on_after_minutes_without_an_output() {
    let roomy = AugmentedModel::<16, 10, 6>::new(
        &navion(),
        &SMatrix::from_diagonal(&Vector4::new(1e-8, 1e-5, 1e-4, 1e-9)),
        &outputs(),
    );
    let wind = Drift { sigma: 8.0, rate: 0.0 };
    let roomy = roomy.unwrap().with_gust(&gusts(1.0)).unwrap().with_wind(&wind).unwrap();
    let mut filter =
        AugmentedFlight::<Q16_16, 16, 10, 6>::new(&roomy, &Vector2::zeros(), USUAL_S).unwrap();
    let (samples, truths) = flight(240.0, 1.0, [0.0, 0.0, 0.0, 5.0], &mut Dice::new(3));
    let place = 10;
    for (index, sample) in samples.iter().enumerate() {
        let is_silent = (1_000..10_000).contains(&index);
        let measured = std::array::from_fn(|i| sample.measured[i].filter(|_| i != 4 || !is_silent));
        filter.take(&Sample { measured, ..*sample }).unwrap();
        let sigma = filter.filter().sigma();
        assert!(sigma[place] < 2.1 * wind.sigma, "{index}: {sigma}");
        assert!(sigma.rows(6, 4).max() < 0.1 && sigma.rows(11, 5).max() < 0.1, "{index}: {sigma}");
    }
    let (estimate, truth) = (filter.filter().estimate(), truths[truths.len() - 1]);
    assert!((estimate[place] - truth[9]).abs() < 1.5, "{}", estimate[place]);
    assert!((estimate[0] - truth[0]).abs() < 0.01, "{}", estimate[0]);
}

#[test]
fn what_does_not_fit_is_refused() {
    let full = model(1.0);
    assert_eq!(full.with_force(0, &DRIFT), Err(Error::NoRoom));
    assert_eq!(full.with_gust(&gusts(1.0)), Err(Error::NoRoom));
    let bare = Model::new(&navion(), &SMatrix::zeros(), &outputs()).unwrap();
    assert_eq!(bare.with_bias(6, &DRIFT), Err(Error::NoRoom));
    assert_eq!(bare.with_force(4, &DRIFT), Err(Error::NoRoom));
    let infinite = Drift { sigma: f64::INFINITY, rate: 0.0 };
    assert_eq!(bare.with_wind(&infinite), Err(Error::NotFinite));
    let still = Gust { airspeed: 0.0, ..gusts(1.0) };
    assert_eq!(bare.with_gust(&still), Err(Error::NotFinite));
    let mut wrong = outputs();
    wrong[3].reference = Reference::Pressure { steady: STEADY, airspeed: 0.0 };
    assert_eq!(Model::new(&navion(), &SMatrix::zeros(), &wrong), Err(Error::NotFinite));
    let mut filter =
        AugmentedFlight::<f32, 11, 7, 6>::new(&full, &Vector2::zeros(), USUAL_S).unwrap();
    let (samples, _) = flight(0.1, 0.0, [0.0; 4], &mut Dice::new(1));
    filter.take(&samples[0]).unwrap();
    let before = filter;
    let late = Sample { time_us: 0, ..samples[1] };
    assert_eq!(filter.take(&late), Err(Error::OutOfOrder));
    let mut broken = samples[1];
    broken.measured[2] = Some(f64::NAN);
    assert_eq!(filter.take(&broken), Err(Error::NotFinite));
    assert_eq!(filter, before);
}

#[test]
fn a_step_is_a_prediction_and_a_correction() {
    let model = model(1.0);
    let mut stepped = AugmentedFilter::<f32, 11, 7, 6>::new(&model).unwrap();
    let held = Vector2::new(0.02, 0.1).map(f32::from_f64);
    let now = Vector2::new(-0.01, 0.1).map(f32::from_f64);
    let transition =
        stepped.transition(&model.over(USUAL_S, USUAL_S, &Vector2::new(0.0087, 0.02)).unwrap());
    let mut apart = stepped;
    let mut measured = [None, Some(0.5), Some(0.01), Some(-0.2), None, Some(0.3)];
    for _ in 0..5 {
        apart.predict(&transition, &held).unwrap();
        let innovations = apart.correct(&measured, &now).unwrap();
        assert_eq!(stepped.step(&transition, &held, &measured, &now), Ok(innovations));
        assert_eq!(stepped, apart);
    }
    // The last output is refused after the others were processed: nothing has changed.
    measured[5] = Some(f32::NAN);
    assert!(stepped.step(&transition, &held, &measured, &now).is_err());
    assert_eq!(stepped, apart);
}
