//! Grids of models, from files to estimates.

use kestirim_uav_longitudinal::{Airframe, SteadyFlight, Trim};
use nalgebra::{SVector, Vector4};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use serde_json::{Value, json};

use kestirim_replay::ScalarKind;
use kestirim_replay::uav::{
    Contradiction, Deviations, Error, EstimatorKind, Followed, Log, Model, ModelFile,
    ModelFileError, Options, Sample, Truth,
};

const INTERVAL_S: f64 = 0.02;

fn model(file: &Value) -> Result<Model, ModelFileError> {
    serde_json::from_value::<ModelFile>(file.clone()).unwrap().model()
}

fn airframe(airspeed: &Value) -> Model {
    model(&json!({ "airframe": "skywalker_x8", "airspeed": airspeed })).unwrap()
}

fn trim(airspeed: f64) -> Trim {
    Airframe::skywalker_x8().trim(&SteadyFlight { airspeed, climb_angle: 0.0 }).unwrap()
}

/// The X8 in calm air, from 14 to 22 m/s and back, as flown: q, V, θ and az, and the true states.
fn flight() -> (Log, Truth) {
    const SMALL: usize = 4;
    let aircraft = Airframe::skywalker_x8();
    let mut random = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut gaussian = || {
        let uniform = (0..12).map(|_| random.next_u32() as f64 / f64::from(u32::MAX));
        uniform.sum::<f64>() - 6.0
    };
    let mut state = trim(14.0).state;
    let (mut samples, mut truth) = (Vec::new(), Vec::new());
    for index in 0..4_000_i64 {
        let phase = index as f64 / 1_000.0;
        let share = if phase < 2.0 { phase.min(1.0) } else { (3.0 - phase).max(0.0) };
        let wanted = trim(14.0 + 8.0 * share);
        let mut input = wanted.input;
        let doublet = [0.03, -0.03].get((index % 300) as usize / 25);
        input[0] += doublet.unwrap_or(&0.0) + 0.3 * (state[3] - wanted.state[3]);
        input[1] = (input[1] + 0.05 * (wanted.state[2] - state[2])).clamp(0.0, 1.0);
        let force = aircraft.specific_force(&Trim { state, input }).unwrap().steady[1];
        let exact = [(state[1], 0.005), (state[2], 0.3), (state[3], 0.01), (force, 0.3)];
        let measured = exact.map(|(exact, sigma)| Some(exact + sigma * gaussian()));
        let t_us = index * (INTERVAL_S * 1e6) as i64;
        samples.push(Sample { t_us, input: input.into(), measured: measured.to_vec() });
        truth.push((t_us, <[f64; 4]>::from(state).map(Some)));
        for _ in 0..SMALL {
            let step = INTERVAL_S / SMALL as f64;
            let rates = |state: Vector4<f64>| aircraft.rates(&state, &input).unwrap();
            let first = rates(state);
            let second = rates(state + first * (step / 2.0));
            let third = rates(state + second * (step / 2.0));
            let fourth = rates(state + third * step);
            state += (first + 2.0 * (second + third) + fourth) * (step / 6.0);
        }
    }
    (Log::new(vec![0, 1, 2, 3], samples).unwrap(), truth)
}

/// The result of a replay, and the RMS error of α in mrad after the first ten seconds.
fn followed(model: Model, options: &Options) -> (Followed, f64) {
    let (log, truth) = flight();
    let flight = Deviations::new(model, log, Some(truth), true).unwrap();
    let followed = flight.follow(options).unwrap();
    let errors = flight.errors(&followed.estimates);
    let late = errors.iter().skip(500).filter_map(|(_, error)| error[0]);
    let square = late.map(|error| error * error).sum::<f64>() / 3_500.0;
    (followed, 1e3 * square.sqrt())
}

#[test]
fn airspeeds_of_a_file_are_a_grid_that_is_used() {
    let options = Options::default();
    let airspeeds = json!([14, 16, 18, 20, 22]);
    let (blended, by_grid) = followed(airframe(&airspeeds), &options);
    assert_eq!(blended.contradictions(), []);
    let by_one = [14, 18, 22].map(|airspeed| followed(airframe(&json!(airspeed)), &options).1);
    for (one, worse) in by_one.iter().zip([10.0, 3.0, 10.0]) {
        assert!(by_grid < 1.0 && *one > worse * by_grid, "{by_grid} mrad, {by_one:?}");
    }
    for (scalar, near) in [(ScalarKind::F32, 0.02), (ScalarKind::Fixed, 0.22)] {
        let (_, error) = followed(airframe(&airspeeds), &Options { scalar, ..options });
        assert!((error - by_grid).abs() < near * by_grid, "{error} mrad beside {by_grid}");
    }
}

#[test]
fn matrices_of_a_file_are_the_same_grid() {
    let aircraft = Airframe::skywalker_x8();
    let airspeeds = [14.0, 18.0, 22.0];
    let rows = |matrix: Vec<SVector<f64, 4>>| -> Vec<[f64; 4]> {
        matrix.into_iter().map(Into::into).collect()
    };
    let members = airspeeds.map(|airspeed| {
        let trim = trim(airspeed);
        let plant = aircraft.linearise(&trim).unwrap();
        let force = aircraft.specific_force(&trim).unwrap();
        let mut c = rows([1, 2, 3].map(|state| SVector::ith(state, 1.0)).to_vec());
        c.push(std::array::from_fn(|state| force.c[(1, state)]));
        let b: Vec<[f64; 2]> = plant.b.row_iter().map(|row| [row[0], row[1]]).collect();
        let x: [f64; 4] = trim.state.into();
        let u: [f64; 2] = trim.input.into();
        json!({
            "A": rows(plant.a.transpose().column_iter().map(Into::into).collect()),
            "B": b,
            "C": c,
            "D": [[0, 0], [0, 0], [0, 0], [force.d[(1, 0)], force.d[(1, 1)]]],
            "trim": { "x": x, "u": u, "y": [x[1], x[2], x[3], force.steady[1]] },
        })
    });
    let common = json!({
        "outputs": ["q", "V", "theta", "az"],
        "scaled": ["az"],
        "noise": { "process": [1e-3, 1.0, 0.05, 1e-8] },
        "bias": [{ "of": "az", "sigma": 0.3, "rate": 0.01 }],
        "gust": { "sigma_u": 1, "sigma_w": 1, "length_u": 200, "length_w": 50 },
        "affine": { "sigma": [0.02, 0.5, 0.3, 0.0] },
    });
    let with = |more: Value| {
        let mut file = common.clone();
        file.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        followed(model(&file).unwrap(), &Options::default()).0
    };
    let written = with(json!({ "grid": members }));
    let flown = with(json!({ "airframe": "skywalker_x8", "airspeed": airspeeds }));
    for (ours, theirs) in written.estimates.iter().zip(&flown.estimates) {
        assert!((ours.state - theirs.state).norm() < 1e-9);
    }
}

#[test]
fn a_flight_beyond_the_grid_is_told() {
    let beyond = |airspeeds: Value| {
        let told = followed(airframe(&airspeeds), &Options::default()).0.contradictions();
        told.into_iter().find_map(|it| match it {
            Contradiction::Beyond { airspeed, end } => Some((airspeed, end)),
            _ => None,
        })
    };
    assert_eq!(beyond(json!([14, 22])), None);
    assert_eq!(beyond(json!([15, 18, 21])), None, "by less than half of 3 m/s");
    let (airspeed, end) = beyond(json!([14, 16, 18])).unwrap();
    assert!(end == 18.0 && (21.8..22.6).contains(&airspeed), "{airspeed}");
    let (airspeed, end) = beyond(json!([18, 20, 22])).unwrap();
    assert!(end == 18.0 && (13.4..14.2).contains(&airspeed), "{airspeed}");
    // A single model, for half of the flight.
    let (airspeed, end) = beyond(json!(18)).unwrap();
    assert!(end == 18.0 && (airspeed - end).abs() > 3.0, "{airspeed}");
}

#[test]
fn what_is_no_grid_is_refused() {
    let refused = |file: Value| {
        let sentence = model(&file).unwrap_err().to_string();
        assert!(sentence.chars().count() <= 200, "{sentence}");
        sentence
    };
    let airspeeds = |list: Value| refused(json!({ "airframe": "aerosonde", "airspeed": list }));
    let rising = "expected a grid of 2 to 8 airspeeds above 0 m/s that rise";
    for list in [
        json!([]),
        json!([30]),
        json!([34, 30]),
        json!([30, 30]),
        json!([-5, 30]),
        json!([20, 22, 24, 26, 28, 30, 32, 34, 36]),
    ] {
        assert_eq!(airspeeds(list), rising);
    }
    let sentence = airspeeds(json!([30, 90]));
    assert!(sentence.contains("at 90 m/s no throttle"), "{sentence}");

    let member = json!({
        "A": [[-1, 1, 0, 0], [-20, -2, 0, 0], [0, 0, -0.1, -9.8], [0, 1, 0, 0]],
        "B": [[0, 0], [-30, 0], [0, 4], [0, 0]],
        "trim": { "x": [0.05, 0, 20, 0.05], "u": [0, 0.5] },
    });
    let with = |field: &str, value: Value| {
        let mut other = member.clone();
        other[field] = value;
        other
    };
    let faster = with("trim", json!({ "x": [0.02, 0, 25, 0.02], "u": [0, 0.6] }));
    assert!(model(&json!({ "grid": [member, faster] })).unwrap().is_grid());
    assert_eq!(refused(json!({ "grid": [faster, member] })), rising);
    assert_eq!(refused(json!({ "grid": [member] })), rising);
    let without = refused(json!({ "grid": [member, with("trim", Value::Null)] }));
    assert!(without.contains("a trim with x and u in each model"), "{without}");
    let discrete = refused(json!({ "grid": [member, with("h", json!(0.02))] }));
    assert!(discrete.contains("without h"), "{discrete}");
    let rows = refused(json!({ "grid": [with("C", json!([[1, 0, 0, 0]])), faster] }));
    assert!(rows.contains("outputs"), "{rows}");
    for (field, value) in [
        ("airspeed", json!(20)),
        ("airframe", json!("aerosonde")),
        ("A", member["A"].clone()),
        ("trim", member["trim"].clone()),
        ("h", json!(0.02)),
    ] {
        let mut file = json!({ "grid": [member, faster] });
        file[field] = value;
        assert!(refused(file).contains("a grid alone"), "{field}");
    }
    let unread = json!({ "airframe": "aerosonde", "airspeed": "fast" });
    let unread = serde_json::from_value::<ModelFile>(unread).unwrap_err().to_string();
    assert!(unread.contains("an airspeed in m/s or a list of them"), "{unread}");
}

#[test]
fn deviations_and_observers_are_refused() {
    let grid = airframe(&json!([14, 18, 22]));
    let (log, _) = flight();
    let refused = Deviations::new(grid.clone(), log.clone(), None, false);
    assert_eq!(refused, Err(Error::GridOfDeviations));
    let flight = Deviations::new(grid, log, None, true).unwrap();
    let options = Options { estimator: EstimatorKind::Luenberger, ..Options::default() };
    assert_eq!(flight.follow(&options), Err(Error::GridOfObserver));
    for error in [Error::GridOfDeviations, Error::GridOfObserver] {
        assert!(error.to_string().chars().count() <= 200);
    }
}
