//! Flights of a simulator and of an airliner, filtered with a model identified from another flight: a regression of the
//! derivatives and outputs on states and inputs, with the noise of usual sensors.
//!
//! They are in `../shared/data/uav/flights`, beside the repository. Where they are absent these tests print SKIPPED and
//! pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each flight is printed.

use std::collections::BTreeMap;

use kestirim_replay::ScalarKind;
use kestirim_replay::uav::{
    Deviations, Error, EstimatorKind, Extended, Followed, Log, Model, ModelFile, Options,
    STATE_COLUMNS, Sample,
};
use kestirim_simulate::random::{normal, stream};
use kestirim_tests::recordings::folder_of;
use kestirim_uav_estimator::{Drift, Dynamics};
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::{SMatrix, SVector};

/// The columns of a flight, by name.
type Flight = BTreeMap<String, Vec<f64>>;

fn read(name: &str) -> Option<Flight> {
    let path = folder_of("uav")?.join("flights").join(name).with_extension("csv");
    let text = std::fs::read_to_string(path).expect("a flight");
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let mut flight = Flight::new();
    for line in lines {
        for (name, field) in names.iter().zip(line.split(',')) {
            flight.entry((*name).to_owned()).or_default().push(field.parse().expect("a number"));
        }
    }
    Some(flight)
}

/// The deviations of α, q, V, θ, δe, δt from the trim, and a constant one.
type Regressors = SVector<f64, 7>;

/// The least-squares coefficients of the regressors.
fn regression(rows: impl Iterator<Item = (Regressors, f64)>) -> Regressors {
    // So small that it only affects regressors that are zero in every row: their coefficients become zero.
    let mut squares = SMatrix::<f64, 7, 7>::identity() * 1e-12;
    let mut products = Regressors::zeros();
    for (row, value) in rows {
        squares += row * row.transpose();
        products += row * value;
    }
    squares.cholesky().expect("inputs that move everything").solve(&products)
}

/// The noise of an aircraft's sensors.
struct Sensors {
    /// The standard deviations of α, q, V, θ, az, qbar.
    sigmas: [f64; 6],
    /// The spectral densities of the noise on the states' derivatives.
    process: [f64; 4],
}

const OUTPUTS: [&str; 6] = ["alpha", "q", "V", "theta", "az", "qbar"];
/// The sensors that the data's README states, and a vane of 5 mrad.
const USUAL: Sensors =
    Sensors { sigmas: [0.005, 0.003, 0.3, 0.003, 0.3, 8.0], process: [1e-8, 1e-5, 4e-4, 1e-9] };
/// The sensors of the ATTAS, whose recordings contain their noise.
const ATTAS: Sensors =
    Sensors { sigmas: [0.005, 0.002, 0.2, 0.002, 0.15, 20.0], process: [1e-5, 1e-4, 1e-2, 1e-7] };

const fn drift(sigma: f64, rate: f64) -> Drift {
    Drift { sigma, rate }
}

/// A model identified from a flight, about the mean of the flight.
fn identified(flight: &Flight, sensors: &Sensors) -> Model {
    let column = |name: &str| &flight[name];
    let mean = |name: &str| column(name).iter().sum::<f64>() / column(name).len() as f64;
    let state = STATE_COLUMNS.map(mean);
    let input = ["delta_e", "delta_t"].map(mean);
    let (t, count) = (column("t"), column("t").len());
    let at = |name: &str, origin: f64, k: usize| column(name)[k] - origin;
    let states = |k: usize| std::array::from_fn::<f64, 4, _>(|i| at(STATE_COLUMNS[i], state[i], k));
    let row = |x: [f64; 4], k: usize| {
        let inputs = [at("delta_e", input[0], k), at("delta_t", input[1], k)];
        Regressors::from_iterator(x.into_iter().chain(inputs).chain([1.0]))
    };
    let (mut a, mut b) = (SMatrix::zeros(), SMatrix::zeros());
    for i in 0..4 {
        let derivative = regression((1..count).map(|k| {
            let (before, now) = (states(k - 1), states(k));
            let middle = std::array::from_fn(|j| 0.5 * (before[j] + now[j]));
            (row(middle, k - 1), (now[i] - before[i]) / (t[k] - t[k - 1]))
        }));
        for j in 0..4 {
            a[(i, j)] = derivative[j];
        }
        (b[(i, 0)], b[(i, 1)]) = (derivative[4], derivative[5]);
    }
    // The regression of the specific force, on which the airspeed only acts by the dynamic pressure.
    let force = regression((0..count).map(|k| {
        let (mut row, ratio) = (row(states(k), k), column("V")[k] / state[2]);
        row[2] = 0.0;
        (row * ratio * ratio, column("az")[k])
    }));
    let steady = force[6];
    let unit = |i: usize| std::array::from_fn(|j| f64::from(u8::from(i == j)));
    let mut rows: Vec<[f64; 4]> = (0..4).map(unit).collect();
    rows.push([force[0], force[1], 2.0 * steady / state[2], force[3]]);
    rows.push([0.0, 0.0, 2.0 * mean("qbar") / state[2], 0.0]);
    let mut direct = vec![[0.0; 2]; 6];
    direct[4] = [force[4], force[5]];
    let shown = state.into_iter().chain([steady, mean("qbar")]);
    let extended = Extended {
        direct,
        steady: shown.collect(),
        scaled: vec![false, false, false, false, true, true],
        process: Some(SMatrix::from_diagonal(&sensors.process.into())),
        sigmas: Some(sensors.sigmas.to_vec()),
        biases: vec![(1, drift(0.02, 1e-5)), (3, drift(0.03, 1e-5)), (4, drift(0.05, 0.01))],
        gust: Some(([2.0; 2], [300.0; 2])),
        wind: Some(drift(8.0, 0.0)),
        density: Some(drift(0.03, 5e-4)),
        forces: vec![(0, drift(0.005, 1e-3)), (1, drift(0.01, 1e-4)), (2, drift(0.3, 0.02))],
        ..Extended::default()
    };
    Model {
        dynamics: Dynamics::Continuous(StateSpace { a, b }),
        outputs: OUTPUTS.iter().map(|name| (*name).to_owned()).zip(rows).collect(),
        trim: Some((state, input)),
        extended: Some(Box::new(extended)),
    }
}

/// Samples of some outputs, with noise of the given standard deviations and an offset added to each.
fn log(
    model: &Model,
    flight: &Flight,
    names: &[&str],
    noise: Option<&Sensors>,
    added: &[f64],
    seed: u64,
) -> Log {
    let place = |name: &&str| OUTPUTS.iter().position(|output| output == name).expect("an output");
    let outputs: Vec<usize> = names.iter().map(place).collect();
    let mut random = stream(seed, 0);
    let sample = |k: usize| {
        let measured = outputs.iter().zip(added).map(|(&output, added)| {
            let sigma = noise.map_or(0.0, |sensors| sensors.sigmas[output]);
            Some(flight[OUTPUTS[output]][k] + added + normal(&mut random, sigma))
        });
        Sample {
            t_us: (flight["t"][k] * 1e6).round() as i64,
            input: [flight["delta_e"][k], flight["delta_t"][k]],
            measured: measured.collect(),
        }
    };
    assert_eq!(model.outputs.len(), OUTPUTS.len());
    let samples = (0..flight["t"].len()).map(sample).collect();
    Log::new(outputs, samples).expect("a log")
}

struct Told {
    /// The root mean square errors: mrad, mrad/s, m/s, mrad.
    errors: [f64; 4],
    contradictions: usize,
}

/// Filters a flight, and prints the errors.
fn followed(label: &str, model: &Model, log: Log, flight: &Flight, options: &Options) -> Told {
    let deviations = Deviations::new(model.clone(), log, None, true).expect("a trim");
    let followed: Followed = deviations.follow(options).expect("an estimate");
    let errors = std::array::from_fn(|i| {
        let truth = &flight[STATE_COLUMNS[i]];
        let squares = followed.estimates.iter().zip(truth);
        let sum: f64 =
            squares.map(|(it, truth)| (deviations.absolute(it)[i] - truth).powi(2)).sum();
        (sum / truth.len() as f64).sqrt() * if i == 2 { 1.0 } else { 1e3 }
    });
    let contradictions = followed.contradictions();
    println!("{label}: {errors:.2?} gusts {:?} {contradictions:?}", followed.gust);
    Told { errors, contradictions: contradictions.len() }
}

#[test]
fn a_light_aircraft_calm_in_turbulence_with_biases_and_with_less_throttle() {
    let Some(ident) = read("jsbsim_c172p_ident") else { return };
    let model = identified(&ident, &USUAL);
    let all = ["q", "V", "theta", "az"];
    let vane = ["alpha", "q", "V", "theta"];
    let nothing = [0.0; 4];
    let biased = [0.01, 0.0, 0.02, 0.0];
    for (name, outputs, added, alpha, airspeed) in [
        ("valid", &all, &nothing, 0.45, 0.1),
        ("valid", &all, &biased, 1.0, 0.1),
        ("slow", &all, &nothing, 1.5, 0.19),
        ("turb3", &all, &nothing, 4.5, 0.2),
        ("turb3", &vane, &nothing, 3.3, 0.19),
    ] {
        let flight = read(&format!("jsbsim_c172p_{name}")).expect("a flight");
        for seed in [1, 2] {
            let log = log(&model, &flight, outputs, Some(&USUAL), added, seed);
            let told = followed(name, &model, log, &flight, &Options::default());
            assert!(told.errors[0] < alpha, "{name} {outputs:?} {added:?}: α {:?}", told.errors);
            assert!(told.errors[2] < airspeed, "{name} {outputs:?} {added:?}: V {:?}", told.errors);
            // With less throttle az is farther from its trim than the model predicts, which is reported.
            let may_be = usize::from(name == "slow");
            assert!(told.contradictions <= may_be, "{name} {outputs:?} {added:?}");
        }
    }
}

/// In fixed point, too: outputs that the log lacks, and those that fill all eight places.
#[test]
fn fixed_point_holds_a_light_aircraft() {
    let Some(ident) = read("jsbsim_c172p_ident") else { return };
    let model = identified(&ident, &USUAL);
    for (name, outputs, alpha) in [
        ("valid", &OUTPUTS[1..5], 0.45),
        ("valid", &OUTPUTS[..], 0.45),
        ("turb3", &OUTPUTS[1..5], 4.5),
    ] {
        let flight = read(&format!("jsbsim_c172p_{name}")).expect("a flight");
        let log = log(&model, &flight, outputs, Some(&USUAL), &[0.0; 6], 1);
        let options = Options { scalar: ScalarKind::Fixed, ..Options::default() };
        let told = followed(name, &model, log, &flight, &options);
        assert!(told.errors[0] < alpha, "{name} {outputs:?}: {:?}", told.errors);
        assert_eq!(told.contradictions, 0, "{name} {outputs:?}");
    }
    let flight = read("jsbsim_c172p_valid").expect("a flight");
    let far = log(&model, &flight, &["V"], None, &[1e6], 1);
    let options = Options { scalar: ScalarKind::Fixed, ..Options::default() };
    let deviations = Deviations::new(model, far, None, true).expect("a trim");
    assert_eq!(deviations.follow(&options).err(), Some(Error::BeyondRange));
}

#[test]
fn an_airliner_by_the_model_of_its_other_flight() {
    let Some([one, two]) = read("attas_elv1").zip(read("attas_elv2")).map(|(a, b)| [a, b]) else {
        return;
    };
    for (known, flown, name) in [(&one, &two, "from 1 to 2"), (&two, &one, "from 2 to 1")] {
        let model = identified(known, &ATTAS);
        let log = log(&model, flown, &["q", "V", "theta", "az", "qbar"], None, &[0.0; 5], 0);
        let told = followed(name, &model, log, flown, &Options::default());
        assert!(told.errors[0] < 0.9, "{name}: {:?}", told.errors);
        assert_eq!(told.contradictions, 0, "{name}");
    }
}

/// The model that `identify uav` finds from a flight with this noise, as `replay uav` reads it from a file.
fn by_filter_error(name: &str, noise: Option<&Sensors>) -> Option<Model> {
    let path = folder_of("uav")?.join("flights").join(name).with_extension("csv");
    let mut flight = host_sim::systems::uav::identify::flight(&path).expect("a flight");
    flight.columns.retain(|(name, _)| OUTPUTS.contains(&name.as_str()));
    let mut random = stream(3, 0);
    for (name, values) in &mut flight.columns {
        let output = OUTPUTS.iter().position(|output| output == name).expect("an output");
        let sigma = noise.map_or(0.0, |sensors| sensors.sigmas[output]);
        values.iter_mut().flatten().for_each(|value| *value += normal(&mut random, sigma));
    }
    let found = kestirim_uav_identification::identify(&[flight], None).expect("a model");
    let file = serde_json::to_string(&found.model).expect("a file");
    let model: ModelFile = serde_json::from_str(&file).expect("a model's file");
    Some(model.model().expect("a model"))
}

#[test]
fn aircraft_by_models_that_were_identified() {
    let Some(light) = by_filter_error("jsbsim_c172p_ident", Some(&USUAL)) else { return };
    let (all, vane) = (["q", "V", "theta", "az"], ["alpha", "q", "V", "theta"]);
    for (name, outputs, added, alpha) in [
        ("valid", &all, [0.0; 4], 0.6),
        ("valid", &all, [0.01, 0.0, 0.02, 0.0], 1.0),
        ("slow", &all, [0.0; 4], 1.5),
        ("turb3", &all, [0.0; 4], 4.5),
        ("turb3", &vane, [0.0; 4], 3.9),
    ] {
        let flight = read(&format!("jsbsim_c172p_{name}")).expect("a flight");
        let log = log(&light, &flight, outputs, Some(&USUAL), &added, 1);
        let told = followed(name, &light, log, &flight, &Options::default());
        assert!(told.errors[0] < alpha, "{name} {outputs:?} {added:?}: α {:?}", told.errors);
        assert!(told.contradictions == 0 || name == "slow", "{name} {outputs:?} {added:?}");
    }
    for (known, flown, alpha) in
        [("attas_elv1", "attas_elv2", 0.95), ("attas_elv2", "attas_elv1", 1.1)]
    {
        let model = by_filter_error(known, None).expect("a model");
        let flight = read(flown).expect("a flight");
        let log = log(&model, &flight, &["q", "V", "theta", "az", "qbar"], None, &[0.0; 5], 0);
        let told = followed(flown, &model, log, &flight, &Options::default());
        assert!(told.errors[0] < alpha, "{flown}: {:?}", told.errors);
        assert_eq!(told.contradictions, 0, "{flown}");
    }
}

#[test]
fn a_model_without_gusts_biases_and_trim_is_contradicted_where_there_are_some() {
    let Some(ident) = read("jsbsim_c172p_ident") else { return };
    let plain = Model { extended: None, ..identified(&ident, &USUAL) };
    let plain = Model { outputs: plain.outputs[..4].to_vec(), ..plain };
    let model = identified(&ident, &USUAL);
    let states = ["q", "V", "theta"];
    let vane = ["q", "V", "theta", "alpha"];
    for estimator in [EstimatorKind::Kalman, EstimatorKind::Luenberger] {
        let options = Options::default().with(estimator);
        let contradicted = |name: &str, outputs: &[&str], added: &[f64]| {
            let flight = read(&format!("jsbsim_c172p_{name}")).expect("a flight");
            let log = log(&model, &flight, outputs, Some(&USUAL), added, 1);
            followed(name, &plain, log, &flight, &options).contradictions > 0
        };
        assert!(!contradicted("valid", &states, &[0.0; 3]));
        assert!(contradicted("valid", &states, &[0.01, 0.0, 0.02]), "biases");
        assert!(contradicted("valid", &states, &[0.0, -6.0, 0.0]), "a head wind");
        assert!(contradicted("slow", &states, &[0.0; 3]));
        assert!(contradicted("turb3", &states, &[0.0; 3]));
        assert!(contradicted("turb3", &vane, &[0.0; 4]));
    }
}
