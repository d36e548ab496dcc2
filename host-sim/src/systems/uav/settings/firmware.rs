//! The equivalent configuration of firmware: the estimator of `kestirim-uav-estimator`, with its model as numbers.

use std::fmt::Write;

use kestirim_observer_design::{Complex, Discrete};
use kestirim_replay::uav::{
    Assumed, EstimatorKind, Model, Noise, Options, Parts, Unknown, discrete, rows,
};
use kestirim_simulate::with_outputs;
use kestirim_uav_estimator::Dynamics;
use kestirim_uav_longitudinal::StateSpace;
use nalgebra::SMatrix;

use super::{GainKind, Simulation, options};
use crate::system::{Literal, ScalarKind, Settings};
use crate::systems::uav::recording::Recording;
use crate::systems::uav::simulate::scenario::{INTERVAL_S, START};

/// The outputs and interval assumed without a recording: q, V and θ.
const USUAL: ([usize; 3], f64) = ([1, 2, 3], 0.01);

/// The Rust source that builds the estimator. It yields a `Result`, which firmware must check.
pub(in crate::systems::uav) fn firmware(
    recording: Option<&Recording>,
    settings: &Settings,
) -> String {
    let options = options(settings);
    let known = || Model::of(settings.chosen("model"));
    match recording {
        None => logged(&known(), &USUAL.0, USUAL.1, &options),
        Some(Recording::Logged(it)) => {
            let model = it.model.clone().unwrap_or_else(known);
            logged(&model, &it.log.outputs, it.log.interval_s, &options)
        }
        Some(Recording::Synthetic(inputs)) => {
            let simulation = Simulation::of(settings, *inputs);
            with_outputs!(simulation.flight.outputs, simulated, &simulation, &options)
        }
    }
}

fn scalar(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Fixed => "kestirim_scalar::Q16_16",
        kind => Literal::number_type(kind),
    }
}

/// The source of a filter or observer for samples with gaps.
fn logged(model: &Model, outputs: &[usize], interval: f64, options: &Options) -> String {
    let count = outputs.len();
    let (dynamics, import) = match &model.dynamics {
        Dynamics::Continuous(StateSpace { a, b }) => (
            format!("Dynamics::Continuous(StateSpace {})", plant(a, b)),
            "kestirim_uav_longitudinal::StateSpace",
        ),
        Dynamics::Discrete { step, interval } => (
            format!(
                "Dynamics::Discrete {{\n    step: Discrete {},\n    interval: {interval:?},\n}}",
                plant(&step.a, &step.b)
            ),
            "kestirim_observer_design::Discrete",
        ),
    };
    let c = match count {
        1 => columns(&rows::<1>(model, outputs)),
        2 => columns(&rows::<2>(model, outputs)),
        3 => columns(&rows::<3>(model, outputs)),
        4 => columns(&rows::<4>(model, outputs)),
        5 => columns(&rows::<5>(model, outputs)),
        6 => columns(&rows::<6>(model, outputs)),
        7 => columns(&rows::<7>(model, outputs)),
        _ => columns(&rows::<8>(model, outputs)),
    };
    // The matrices are designed in f64, independent of the estimator's number type.
    let literal =
        Literal::new("kestirim_uav_estimator::Dynamics", ScalarKind::F64, "Dynamics", &dynamics)
            .import(import);
    let scalar = scalar(options.scalar);
    let parts = Parts::of(model, outputs, options, 1.0);
    match options.estimator {
        EstimatorKind::Kalman if model.is_grid() => {
            scheduled(model, outputs, interval, options).unwrap_or(literal)
        }
        EstimatorKind::Kalman if parts.is_some() => {
            parts.map_or(literal, |parts| augmented(model, &parts, interval, scalar))
        }
        EstimatorKind::Kalman => {
            let Assumed { inputs, outputs } = Assumed::of(model, outputs, options);
            literal.import("kestirim_uav_estimator::{FlightFilter, Noise}").then(format!(
                "let noise = Noise {{ inputs: {inputs:?}.into(), outputs: {outputs:?}.into() }};\n\
                 let filter = FlightFilter::<{scalar}, {count}>::new(&config, &{c}, &noise, {interval:?});"
            ))
        }
        EstimatorKind::Luenberger => {
            let poles = discrete(options.poles, interval);
            let poles = poles.map(|Complex { re, im }| format!("Complex {{ re: {re:?}, im: {im:?} }}"));
            literal
                .import("kestirim_observer_design::Complex")
                .import("kestirim_uav_estimator::FlightObserver")
                .then(format!(
                    "let poles = [\n    {},\n];\n\
                     let observer = FlightObserver::<{scalar}, {count}>::new(&config, &{c}, &poles, {interval:?});",
                    poles.join(",\n    ")
                ))
        }
    }
    .to_string()
}

/// The number of states, the number of further states that move the four, and the number of outputs.
fn sizes(parts: &Parts) -> [usize; 3] {
    let states = |moving| {
        let sizes = parts.unknown.iter().map(Unknown::moves);
        sizes.filter(|(moves, _)| *moves == moving).map(|(_, count)| count).sum::<usize>()
    };
    let k = 4 + states(true);
    [k + states(false), k, parts.outputs.len()]
}

/// The source of a model with further states, where `plant` is an expression for A and B.
fn augmented_model(parts: &Parts, plant: &str) -> String {
    let [n, k, p] = sizes(parts);
    let outputs: Vec<_> = parts.outputs.iter().map(|output| format!("    {output:?},\n")).collect();
    let calls = parts.unknown.iter().map(|unknown| match unknown {
        Unknown::Gust(gust) => format!("    .with_gust(&{gust:?})?\n"),
        Unknown::Force(state, drift) => format!("    .with_force({state}, &{drift:?})?\n"),
        Unknown::Bias(output, drift) => format!("    .with_bias({output}, &{drift:?})?\n"),
        Unknown::Wind(drift) => format!("    .with_wind(&{drift:?})?\n"),
        Unknown::Density(drift) => format!("    .with_density(&{drift:?})?\n"),
    });
    format!(
        "let density = {};\nlet outputs = [\n{}];\n\
         let model = AugmentedModel::<{n}, {k}, {p}>::new(&{plant}, &density, &outputs)?\n{};",
        columns(&parts.process),
        outputs.concat(),
        calls.collect::<String>().trim_end(),
    )
}

/// The source of a filter with further states.
fn augmented(model: &Model, parts: &Parts, interval: f64, scalar: &str) -> Literal {
    let [n, k, p] = sizes(parts);
    let config = format!("StateSpace {}", plant_of(model));
    Literal::new(
        "kestirim_uav_longitudinal::StateSpace",
        ScalarKind::F64,
        "StateSpace",
        &config,
    )
    .import(
        "kestirim_uav_estimator::{AugmentedFlight, AugmentedModel, Drift, Gust, Output, Reference::*}",
    )
    .then(augmented_model(parts, "config"))
    .then(format!(
        "let filter = AugmentedFlight::<{scalar}, {n}, {k}, {p}>::new(&model, &{:?}.into(), {interval:?});",
        parts.inputs,
    ))
}

/// The source of an estimator with models at several airspeeds; `None` if one of them has no trim.
fn scheduled(
    origin: &Model,
    outputs: &[usize],
    interval: f64,
    options: &Options,
) -> Option<Literal> {
    let (state, input) = origin.trim?;
    let grid = &origin.extended.as_ref()?.grid;
    let parts = Parts::of(origin, outputs, options, 1.0)?;
    let [n, k, p] = sizes(&parts);
    let less = |there: &[f64], here: &[f64]| {
        there.iter().zip(here).map(|(there, here)| there - here).collect::<Vec<f64>>()
    };
    let mut locals = String::new();
    for model in grid {
        let parts = Parts::of(model, outputs, options, 1.0)?;
        let (there, held) = model.trim?;
        let shown = outputs
            .iter()
            .map(|&output| model.shown(output, true, &there) - origin.shown(output, true, &state));
        let plant = format!("StateSpace {}", plant_of(model));
        write!(
            locals,
            "{{\n{}\nLocalModel {{\n    model,\n    state: {:?}.into(),\n    input: {:?}.into(),\n    \
             outputs: {:?}.into(),\n}}\n}},\n",
            augmented_model(&parts, &plant),
            less(&there, &state),
            less(&held, &input),
            shown.collect::<Vec<f64>>(),
        )
        .ok()?;
    }
    let count = grid.len();
    let literal = Literal::new(
        "kestirim_uav_longitudinal::StateSpace",
        ScalarKind::F64,
        &format!("[LocalModel<{n}, {k}, {p}>; {count}]"),
        &format!("[\n{locals}]"),
    );
    Some(
        literal
            .import(
                "kestirim_uav_estimator::{AugmentedModel, Drift, Gust, LocalModel, Output, Reference::*, ScheduledFlight}",
            )
            .then(format!(
                "let filter = ScheduledFlight::<{scalar}, {n}, {k}, {p}, {count}>::new(&config, &{:?}.into(), {interval:?});",
                parts.inputs,
                scalar = scalar(options.scalar),
            )),
    )
}

/// The source of A and B of a model.
fn plant_of(model: &Model) -> String {
    let (Dynamics::Continuous(StateSpace { a, b })
    | Dynamics::Discrete { step: Discrete { a, b }, .. }) = &model.dynamics;
    plant(a, b)
}

/// The source of an estimator for samples at a constant rate.
fn simulated<const P: usize>(
    c: &SMatrix<f64, P, 4>,
    simulation: &Simulation,
    options: &Options,
) -> String {
    let kind = simulation.kind(options);
    let discrete = simulation.flight.plant.discrete(INTERVAL_S);
    let (plant, rows) = (plant(&discrete.a, &discrete.b), columns(c));
    let literal = Literal::new(
        "kestirim_observer_design::Discrete",
        ScalarKind::F64,
        "Discrete<4, 2>",
        &format!("Discrete {plant}"),
    )
    .import("kestirim_uav_estimator::Estimator");
    let scalar = scalar(options.scalar);
    let start = simulation.flight.start;
    let varying =
        (options.estimator, simulation.gain) == (EstimatorKind::Kalman, GainKind::Varying);
    if varying {
        let believed = options.weighted(simulation.assumed.inputs);
        let noise = Noise { inputs: believed, ..simulation.assumed };
        let sigmas: Vec<f64> = simulation.assumed.outputs[4 - P..].to_vec();
        let doubts: [f64; 4] = std::array::from_fn(|i| START[i] - start[i]);
        let noise = columns(&noise.process(&discrete));
        return literal
            .import("kestirim_uav_estimator::Step")
            .then(format!(
                "let step = Step {{ transition: config, noise: {noise} }};\n\
                 let estimator = Estimator::<{scalar}, {P}>::time_varying(\n    \
                 &step,\n    &{rows},\n    &{sigmas:?}.into(),\n    &{start:?}.into(),\n    &{doubts:?}.into(),\n);"
            ))
            .to_string();
    }
    match kind.gain(&discrete, c) {
        Err(problem) => format!("// There is no such estimator: {problem}"),
        Ok(gain) => literal
            .then(format!(
                "let estimator = Estimator::<{scalar}, {P}>::constant_gain(\n    \
                 &config,\n    &{rows},\n    &{},\n    &{start:?}.into(),\n);",
                columns(&gain)
            ))
            .to_string(),
    }
}

/// The source of the fields A and B.
fn plant(a: &SMatrix<f64, 4, 4>, b: &SMatrix<f64, 4, 2>) -> String {
    format!("{{\n    a: {},\n    b: {},\n}}", columns(a), columns(b))
}

/// The source of a matrix, as the array of its columns.
fn columns<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> String {
    let columns = matrix.column_iter();
    let columns = columns.map(|column| format!("{:?}", column.iter().collect::<Vec<_>>()));
    format!("[{}].into()", columns.collect::<Vec<_>>().join(", "))
}
