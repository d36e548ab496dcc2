//! Interpolated models at several airspeeds.

use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{
    AugmentedFlight, AugmentedModel, Drift, Error, Gust, LocalModel, Output, Reference, Sample,
    ScheduledFilter, ScheduledFlight,
};
use kestirim_uav_longitudinal::{Airframe, SteadyFlight, Trim};
use nalgebra::{SMatrix, SVector, Vector2, Vector4};

use crate::dice::Dice;

const USUAL_S: f64 = 0.02;
/// Airspeeds of the models, m/s.
const X8: [f64; 5] = [14.0, 16.0, 18.0, 20.0, 22.0];
const AEROSONDE: [f64; 5] = [26.0, 30.0, 34.0, 38.0, 42.0];
/// Index of the model from whose steady flight deviations are counted.
const ORIGIN: usize = 2;
/// Standard deviations of q, V, θ and az.
const SIGMAS: [f64; 4] = [0.005, 0.3, 0.01, 0.3];

type Local = LocalModel<10, 7, 4>;

fn trim(airframe: &Airframe, airspeed: f64) -> Trim {
    airframe.trim(&SteadyFlight { airspeed, climb_angle: 0.0 }).unwrap()
}

/// The outputs q, V, θ and the specific force downwards.
fn shown(airframe: &Airframe, at: &Trim) -> SVector<f64, 4> {
    let force = airframe.specific_force(at).unwrap().steady[1];
    SVector::from([at.state[1], at.state[2], at.state[3], force])
}

/// The model near a steady flight: unknown forces, and biases of q, θ and az.
fn local(airframe: &Airframe, airspeed: f64, origin: &Trim) -> Local {
    let trim = trim(airframe, airspeed);
    let plant = airframe.linearise(&trim).unwrap();
    let force = airframe.specific_force(&trim).unwrap();
    let [alpha, rate, along, _] = plant.process_noise(0.1, &[0.03, 0.1, 1.0, 0.05, 0.03, 0.1], 0.5);
    let density = SMatrix::from_diagonal(&Vector4::new(alpha, rate, along, 1e-8));
    let steady = force.steady[1];
    let outputs = [
        Output::state(1, SIGMAS[0]),
        Output::state(2, SIGMAS[1]),
        Output::state(3, SIGMAS[2]),
        Output {
            row: std::array::from_fn(|state| force.c[(1, state)]),
            direct: std::array::from_fn(|input| force.d[(1, input)]),
            sigma: SIGMAS[3],
            reference: Reference::Pressure { steady, airspeed },
        },
    ];
    let drift = |sigma, rate| Drift { sigma, rate };
    let model = AugmentedModel::new(&plant, &density, &outputs).unwrap();
    let model = model.with_force(0, &drift(0.02, 1e-3)).unwrap();
    let model = model.with_force(1, &drift(0.5, 1e-3)).unwrap();
    let model = model.with_force(2, &drift(0.3, 0.02)).unwrap();
    let model = model.with_bias(0, &drift(0.02, 1e-5)).unwrap();
    let model = model.with_bias(2, &drift(0.03, 1e-5)).unwrap();
    let model = model.with_bias(3, &drift(0.3, 0.01)).unwrap();
    LocalModel {
        model,
        state: trim.state - origin.state,
        input: trim.input - origin.input,
        outputs: shown(airframe, &trim) - shown(airframe, origin),
    }
}

fn grid(airframe: &Airframe, airspeeds: &[f64; 5]) -> [Local; 5] {
    let origin = trim(airframe, airspeeds[ORIGIN]);
    airspeeds.map(|airspeed| local(airframe, airspeed, &origin))
}

/// A nonlinear flight in calm air over all airspeeds and back, in deviations from the origin, with its true states.
fn flight(
    airframe: &Airframe,
    airspeeds: &[f64; 5],
    seconds: f64,
    dice: &mut Dice,
) -> (Vec<Sample<4>>, Vec<Vector4<f64>>) {
    const SMALL: usize = 8;
    let origin = trim(airframe, airspeeds[ORIGIN]);
    let zero = shown(airframe, &origin);
    let [slowest, .., fastest] = *airspeeds;
    let biases = [0.005, 0.0, 0.01, 0.1].map(|sigma| sigma * dice.gaussian());
    let mut state = trim(airframe, slowest).state;
    let (mut samples, mut truths) = (Vec::new(), Vec::new());
    for index in 0..(seconds / USUAL_S) as i64 {
        let time = index as f64 * USUAL_S;
        // Up and back, with both ends held for a quarter of the time each.
        let phase = (4.0 * time / seconds).rem_euclid(4.0);
        let share = if phase < 1.0 {
            phase
        } else if phase < 2.0 {
            1.0
        } else {
            (3.0 - phase).max(0.0)
        };
        let wanted = trim(airframe, slowest + share * (fastest - slowest));
        let doublet = match time.rem_euclid(6.0) {
            since if since < 0.5 => 0.03,
            since if since < 1.0 => -0.03,
            _ => 0.0,
        };
        let mut input = wanted.input;
        input[0] += doublet + 0.3 * (state[3] - wanted.state[3]);
        input[1] = (input[1] + 0.05 * (wanted.state[2] - state[2])).clamp(0.0, 1.0);
        let now = Trim { state, input };
        let exact = shown(airframe, &now) - zero;
        let measured =
            std::array::from_fn(|i| Some(exact[i] + biases[i] + SIGMAS[i] * dice.gaussian()));
        samples.push(Sample { time_us: index * 20_000, input: input - origin.input, measured });
        truths.push(state - origin.state);
        let step = USUAL_S / SMALL as f64;
        for _ in 0..SMALL {
            let rates = |state: Vector4<f64>| airframe.rates(&state, &input).unwrap();
            let first = rates(state);
            let second = rates(state + first * (step / 2.0));
            let third = rates(state + second * (step / 2.0));
            let fourth = rates(state + third * step);
            state += (first + 2.0 * (second + third) + fourth) * (step / 6.0);
        }
    }
    (samples, truths)
}

/// Number of samples after which the estimate has settled.
const SETTLED: usize = 250;

/// Errors of an estimate: root mean squares for the four states, and the mean normalised square.
struct Errors {
    rms: [f64; 4],
    nees: f64,
}

fn errors(
    samples: &[Sample<4>],
    truths: &[Vector4<f64>],
    mut take: impl FnMut(&Sample<4>) -> (SVector<f64, 10>, SMatrix<f64, 4, 4>),
) -> Errors {
    let (mut squares, mut nees, mut count) = ([0.0; 4], 0.0, 0.0);
    for (index, (sample, truth)) in samples.iter().zip(truths).enumerate() {
        let (estimate, covariance) = take(sample);
        if index < SETTLED {
            continue;
        }
        let error: Vector4<f64> = estimate.fixed_rows::<4>(0) - truth;
        for (square, error) in squares.iter_mut().zip(&error) {
            *square += error * error;
        }
        nees += error.dot(&(covariance.try_inverse().unwrap() * error)) / 4.0;
        count += 1.0;
    }
    Errors { rms: squares.map(|square| (square / count).sqrt()), nees: nees / count }
}

/// Covariance of the four states, in SI units.
macro_rules! known {
    ($flight:expr) => {{
        let filter = $flight.filter();
        let units = filter.state_units();
        let covariance = filter.state().covariance.to_matrix();
        let four =
            SMatrix::<f64, 4, 4>::from_fn(|i, j| covariance[(i, j)].to_f64() * units[i] * units[j]);
        (filter.estimate(), four)
    }};
}

fn by_grid<T: Scalar>(
    grid: &[Local; 5],
    samples: &[Sample<4>],
    truths: &[Vector4<f64>],
) -> (Errors, Vec<SVector<f64, 10>>) {
    let mut flight =
        ScheduledFlight::<T, 10, 7, 4, 5>::new(grid, &Vector2::zeros(), USUAL_S).unwrap();
    let mut estimates = Vec::new();
    let errors = errors(samples, truths, |sample| {
        flight.take(sample).unwrap();
        let (estimate, covariance) = known!(flight);
        estimates.push(estimate);
        (estimate, covariance)
    });
    (errors, estimates)
}

/// The errors with a single model, whose deviations are from its own steady flight.
fn by_one(local: &Local, samples: &[Sample<4>], truths: &[Vector4<f64>]) -> Errors {
    let mut flight =
        AugmentedFlight::<f64, 10, 7, 4>::new(&local.model, &Vector2::zeros(), USUAL_S).unwrap();
    errors(samples, truths, |sample| {
        let measured = std::array::from_fn(|i| sample.measured[i].map(|it| it - local.outputs[i]));
        flight.take(&Sample { input: sample.input - local.input, measured, ..*sample }).unwrap();
        let (mut estimate, covariance) = known!(flight);
        for (estimate, state) in estimate.iter_mut().zip(&local.state) {
            *estimate += state;
        }
        (estimate, covariance)
    })
}

/// Measured errors relative to the grid's: 1.6 to 2.5 for the middle model, which is the best, 3.1 to 5.0 for its
/// neighbours and 7.5 to 12.6 for those at the ends. The process noise represents models that are wrong by a tenth,
/// and these are exact at their airspeeds: σ is too large, and the normalised square 0.43 to 0.55. For a single model
/// it is 0.75 to 1.06 in the middle and 5.4 to 17 at the ends.
#[test]
fn over_all_airspeeds_the_grid_is_better_than_the_best_of_its_models() {
    for (name, airframe, airspeeds) in [
        ("Skywalker X8", Airframe::skywalker_x8(), X8),
        ("Aerosonde", Airframe::aerosonde(), AEROSONDE),
    ] {
        let grid = grid(&airframe, &airspeeds);
        for seed in 0..3 {
            let (samples, truths) = flight(&airframe, &airspeeds, 120.0, &mut Dice::new(seed));
            let (blended, _) = by_grid::<f64>(&grid, &samples, &truths);
            let told = |by: &str, errors: &Errors| {
                let (mrad, nees) = (1e3 * errors.rms[0], errors.nees);
                println!("{name}, seed {seed}, {by}: {mrad:.2} mrad, {nees:.2}");
            };
            told("grid", &blended);
            assert!((0.4..0.7).contains(&blended.nees), "{}", blended.nees);
            for ((local, airspeed), worse) in
                grid.iter().zip(airspeeds).zip([6.0, 2.5, 1.5, 2.5, 6.0])
            {
                let one = by_one(local, &samples, &truths);
                told(&format!("{airspeed} m/s"), &one);
                assert!(one.rms[0] > worse * blended.rms[0], "{airspeed} m/s");
            }
        }
    }
}

#[test]
fn a_grid_of_one_model_is_its_filter() {
    let airframe = Airframe::skywalker_x8();
    let one = local(&airframe, 18.0, &trim(&airframe, 18.0));
    let (samples, _) = flight(&airframe, &X8, 40.0, &mut Dice::new(5));
    let mut alone =
        AugmentedFlight::<f64, 10, 7, 4>::new(&one.model, &Vector2::zeros(), USUAL_S).unwrap();
    let mut blended =
        ScheduledFlight::<f64, 10, 7, 4, 3>::new(&[one; 3], &Vector2::zeros(), USUAL_S).unwrap();
    for (index, sample) in samples.iter().enumerate().filter(|(index, _)| index % 50 != 3) {
        let mut sample = *sample;
        if index % 7 == 0 {
            sample.measured[1] = None;
        }
        if index % 300 == 200 {
            sample.measured[3] = sample.measured[3].map(|force| force + 20.0);
        }
        alone.take(&sample).unwrap();
        blended.take(&sample).unwrap();
        let apart = alone.filter().estimate() - blended.filter().estimate();
        assert!(apart.norm() < 1e-9, "{index}: {apart}");
        assert!((alone.filter().sigma() - blended.filter().sigma()).norm() < 1e-9, "{index}");
    }
    assert!(alone.rejected()[3] > 3);
    assert_eq!(alone.rejected(), blended.rejected());
    assert_eq!(alone.health(), blended.health());
}

/// A model with gusts and a head wind; its outputs are the four states, the specific force and the rate of climb.
fn windy(airframe: &Airframe, airspeed: f64, origin: &Trim) -> LocalModel<7, 6, 6> {
    let trim = trim(airframe, airspeed);
    let force = airframe.specific_force(&trim).unwrap();
    let steady = force.steady[1];
    let output = |row, direct, reference| Output { row, direct, sigma: 1e-6, reference };
    let outputs = [
        Output::state(0, 1e-6),
        Output::state(1, 1e-6),
        Output::state(2, 1e-6),
        Output::state(3, 1e-6),
        output(
            std::array::from_fn(|state| force.c[(1, state)]),
            std::array::from_fn(|input| force.d[(1, input)]),
            Reference::Pressure { steady, airspeed },
        ),
        output([-airspeed, 0.0, 0.0, airspeed], [0.0; 2], Reference::Ground),
    ];
    let plant = airframe.linearise(&trim).unwrap();
    let model = AugmentedModel::new(&plant, &SMatrix::zeros(), &outputs).unwrap();
    let gust = Gust { sigmas: [1.0; 2], lengths: [200.0, 50.0], airspeed };
    let model = model.with_gust(&gust).unwrap();
    let (there, here) = (shown(airframe, &trim), shown(airframe, origin));
    LocalModel {
        model: model.with_wind(&Drift { sigma: 5.0, rate: 0.0 }).unwrap(),
        state: trim.state - origin.state,
        input: trim.input - origin.input,
        outputs: SVector::from_fn(|output, _| match output {
            0..4 => trim.state[output] - origin.state[output],
            4 => there[3] - here[3],
            _ => 0.0,
        }),
    }
}

#[test]
fn each_steady_flight_of_the_grid_stays_and_shows_what_it_shows() {
    let airframe = Airframe::skywalker_x8();
    let origin = trim(&airframe, 17.0);
    let grid = X8.map(|airspeed| windy(&airframe, airspeed, &origin));
    for local in &grid {
        let mut filter = ScheduledFilter::<f64, 7, 6, 6, 5>::new(&grid).unwrap();
        let steps = grid.map(|it| it.model.over(USUAL_S, USUAL_S, &Vector2::zeros()).unwrap());
        let transition = filter.transition(&steps);
        let units = *filter.filter().output_units();
        let measured = std::array::from_fn(|output| {
            (output < 4).then_some(local.outputs[output] / units[output])
        });
        // The first correction finds the airspeed, the second the interpolation there.
        for _ in 0..2 {
            filter.correct(&measured, &local.input).unwrap();
        }
        let expected = |filter: &mut ScheduledFilter<f64, 7, 6, 6, 5>| {
            let measured = std::array::from_fn(|output| {
                (output >= 4).then_some(local.outputs[output] / units[output])
            });
            let innovations = { *filter }.correct(&measured, &local.input).unwrap();
            [4, 5].map(|output| innovations[output].unwrap().innovation * units[output])
        };
        for step in 0..200 {
            let estimate = filter.filter().estimate();
            let off = estimate.fixed_rows::<4>(0) - local.state;
            assert!(off.norm() < 1e-6, "{} m/s, {step}: {off}", local.state[2]);
            let [force, climb] = expected(&mut filter);
            assert!(force.abs() < 1e-4 && climb.abs() < 1e-4, "{force} {climb}");
            filter.predict(&transition, &local.input).unwrap();
        }
        // Its rows are those at the airspeed of the last correction.
        let mut begun = filter.begun_anew();
        begun.correct(&[None; 6], &local.input).unwrap();
        assert_eq!(begun, ScheduledFilter::new(&grid).unwrap());
    }
}

#[test]
fn between_two_models_it_is_their_mean() {
    let airframe = Airframe::skywalker_x8();
    let origin = trim(&airframe, 16.0);
    let grid = [14.0, 18.0].map(|airspeed| windy(&airframe, airspeed, &origin));
    let mut filter = ScheduledFilter::<f64, 7, 6, 6, 2>::new(&grid).unwrap();
    let steps = grid.map(|it| it.model.over(USUAL_S, USUAL_S, &Vector2::zeros()).unwrap());
    let transition = filter.transition(&steps);
    let input = Vector2::new(0.01, 0.02);
    filter.predict(&transition, &input).unwrap();
    // From zero, each moves by (I − A) d − B e + B u.
    let moved = [0, 1].map(|which| {
        let a = steps[which].transition.a.fixed_view::<4, 4>(0, 0).into_owned();
        let b = steps[which].transition.b.fixed_rows::<4>(0).into_owned();
        let local = &grid[which];
        local.state - a * local.state + b * (input - local.input)
    });
    let mean = 0.5 * (moved[0] + moved[1]);
    let off = filter.filter().estimate().fixed_rows::<4>(0) - mean;
    assert!(off.norm() < 1e-12, "{off}");
    assert!((moved[0] - moved[1]).norm() > 0.001, "the two differ");
}

#[test]
fn other_numbers_follow() {
    let airframe = Airframe::skywalker_x8();
    let grid = grid(&airframe, &X8);
    // Squares of differences from doubles, and of the errors of those: of single precision and fixed point, by state.
    let mut sums = [[[0.0; 2]; 4]; 2];
    for seed in 1..=8 {
        let (samples, truths) = flight(&airframe, &X8, 60.0, &mut Dice::new(seed));
        let (_, exact) = by_grid::<f64>(&grid, &samples, &truths);
        let (_, single) = by_grid::<f32>(&grid, &samples, &truths);
        let (_, fixed) = by_grid::<Q16_16>(&grid, &samples, &truths);
        for (sums, other) in sums.iter_mut().zip([single, fixed]) {
            for ((one, other), truth) in exact.iter().zip(&other).zip(&truths).skip(SETTLED) {
                for (state, [apart, wrong]) in sums.iter_mut().enumerate() {
                    *apart += (one[state] - other[state]).powi(2);
                    *wrong += (one[state] - truth[state]).powi(2);
                }
            }
        }
    }
    for (name, states, limit) in [("f32", sums[0], 0.01), ("fixed", sums[1], 0.3)] {
        let shares = states.map(|[apart, wrong]| (apart / wrong).sqrt());
        println!("{name} {shares:.4?}");
        assert!(shares.iter().all(|share| *share < limit), "{name}: {shares:?}");
    }
}

#[test]
fn what_is_no_grid_is_refused_and_a_refused_sample_changes_nothing() {
    type Filter<T> = ScheduledFilter<T, 10, 7, 4, 5>;
    let airframe = Airframe::skywalker_x8();
    let grid = grid(&airframe, &X8);
    let mut falling = grid;
    falling.swap(1, 2);
    assert_eq!(Filter::<f64>::new(&falling), Err(Error::Grid));
    let mut other = grid;
    other[3].model = AugmentedModel::new(
        &airframe.linearise(&trim(&airframe, 20.0)).unwrap(),
        &SMatrix::zeros(),
        &[1, 2, 3, 0].map(|state| Output::state(state, 0.1)),
    )
    .unwrap();
    assert_eq!(Filter::<f64>::new(&other), Err(Error::Grid), "other states and outputs");
    let mut elsewhere = grid;
    elsewhere[4].state[2] += 0.5;
    assert_eq!(Filter::<f64>::new(&elsewhere), Err(Error::Grid), "another origin");
    let mut infinite = grid;
    infinite[0].outputs[1] = f64::INFINITY;
    assert_eq!(Filter::<f64>::new(&infinite), Err(Error::NotFinite));
    let mut beyond = grid;
    beyond[0].outputs[0] = 1e9;
    assert_eq!(Filter::<Q16_16>::new(&beyond), Err(Error::NotFinite));

    let mut flown =
        ScheduledFlight::<f32, 10, 7, 4, 5>::new(&grid, &Vector2::zeros(), USUAL_S).unwrap();
    let (samples, _) = flight(&airframe, &X8, 0.2, &mut Dice::new(1));
    for sample in &samples[..5] {
        flown.take(sample).unwrap();
    }
    let before = flown;
    assert_eq!(flown.take(&samples[2]), Err(Error::OutOfOrder));
    let mut broken = samples[5];
    broken.measured[2] = Some(f64::NAN);
    assert_eq!(flown.take(&broken), Err(Error::NotFinite));
    // Finite, but out of range for the filter's scalar.
    broken.measured[2] = Some(1e300);
    assert!(flown.take(&broken).is_err());
    assert_eq!(flown, before);
    flown.take(&samples[5]).unwrap();
    // The clock was set back: it restarts.
    flown.take(&Sample { time_us: -2_000_000, ..samples[0] }).unwrap();
    let mut new =
        ScheduledFlight::<f32, 10, 7, 4, 5>::new(&grid, &Vector2::zeros(), USUAL_S).unwrap();
    new.take(&samples[0]).unwrap();
    assert_eq!(flown.filter().estimate(), new.filter().estimate());
}

#[test]
fn a_step_is_a_prediction_and_a_correction() {
    let grid = grid(&Airframe::skywalker_x8(), &X8);
    let mut stepped = ScheduledFilter::<f32, 10, 7, 4, 5>::new(&grid).unwrap();
    let steps = grid.map(|it| it.model.over(USUAL_S, USUAL_S, &Vector2::zeros()).unwrap());
    let transition = stepped.transition(&steps);
    let (held, now) = (Vector2::new(0.02, 0.1), Vector2::new(-0.01, 0.1));
    let mut apart = stepped;
    let mut measured = [Some(0.1), Some(9.0), None, Some(-0.3)];
    for _ in 0..5 {
        apart.predict(&transition, &held).unwrap();
        let innovations = apart.correct(&measured, &now).unwrap();
        assert_eq!(stepped.step(&transition, &held, &measured, &now), Ok(innovations));
        assert_eq!(stepped, apart);
    }
    measured[3] = Some(f32::NAN);
    assert!(stepped.step(&transition, &held, &measured, &now).is_err());
    assert_eq!(stepped, apart);
}
