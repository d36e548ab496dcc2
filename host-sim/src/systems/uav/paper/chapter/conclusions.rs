//! The conclusions of the thesis, and questions that it does not ask.

use kestirim_replay::uav::{MIDDLE, Noise, Plant, faster};

use super::made;
use crate::Error;
use crate::figure::{Colour, Figure, Series};
use crate::report::{Comparison, Item, Value};
use crate::system::ScalarKind;
use crate::systems::uav::account::states::{caught, shown};
use crate::systems::uav::paper::accuracy::{Cell, Window};
use crate::systems::uav::paper::catching::{Chase, THESIS_LUENBERGER};
use crate::systems::uav::paper::report::{Report, alike, four};
use crate::systems::uav::simulate::design::{Family, Kind};
use crate::systems::uav::simulate::plant::{Outputs, STATE_UNITS, STATES};
use crate::systems::uav::simulate::scenario::Inputs;

/// The items of claims, accuracies and limits.
pub(super) fn items(report: &Report) -> Result<Vec<Item>, Error> {
    let flights = made(report, format!("{} flights a row", report.trials));
    let once = made(report, "1 flight a row, without noise");
    Ok(vec![
        flights.item(claims(report)),
        flights.item(accuracy(report)),
        once.item(slowest(report)),
        once.item(independence(report)),
        once.item(against_time()?),
    ])
}

fn claims(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-claims",
        "Chapter 7: what the thesis concludes (here: α, q, V, θ by the Kalman filter | by the best observer)",
    );
    report.claims.iter().fold(empty, |table, claim| {
        let quantity = format!("{}: {}", claim.claim, claim.setting);
        let verdict = if claim.holds { "true" } else { "false" };
        let here = format!("{verdict}: {} | {}", shown(claim.kalman), shown(claim.luenberger));
        let by = |method: &str, numbers| {
            let what = if claim.claim.contains("faster") { "time to catch" } else { "RMSE" };
            let unit = if what == "RMSE" { STATE_UNITS } else { ["s"; 4] };
            Value::each(what, STATES, unit, numbers)
                .map(|value| value.under(quantity.clone()).by(method))
        };
        let values =
            [by("Kalman filter", claim.kalman), by("best Luenberger observer", claim.luenberger)];
        table.repeated(quantity.clone(), "true", here, "").values(values.concat())
    })
}

fn accuracy(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-accuracy",
        format!(
            "RMSE of α, q, V, θ over {} flights (limit: Lyapunov's equation, or its recursion over the flight)",
            report.trials
        ),
    );
    report
        .accuracy
        .iter()
        .fold(empty, |table, row| {
            let window = if row.window == Window::Whole { "10 s" } else { "settled" };
            let (noise, inputs) = (row.noise.name, row.inputs.name());
            let (plant, outputs) = (row.plant.name(), row.outputs.name());
            let quantity = format!(
                "{plant}, {outputs}, noise {noise}, {inputs} inputs, {window}: {}",
                row.estimator
            );
            let values = Value::each("RMSE", STATES, STATE_UNITS, row.rmse);
            let values = values.into_iter().zip(row.predicted).map(|(value, limit)| {
                let value = value.under(quantity.clone()).by(row.estimator.clone());
                value.of(report.trials, None).limited(limit)
            });
            let values: Vec<_> = values.collect();
            // Our method is the filter for the actual noise; the others are as in the thesis.
            let (rmse, limit) = (four(row.rmse), four(row.predicted));
            let is_ours = row.family != Family::Luenberger && !row.estimator.contains("Q/R");
            let table = if is_ours {
                table.row(quantity, "", rmse, limit)
            } else {
                table.repeated(quantity, "", rmse, limit)
            };
            table.values(values)
        })
        .note("The thesis prints no error: the published column is empty.")
}

fn slowest(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-slowest-poles",
        "How fast a steady-state filter of P2 can get: its two slowest poles, 1/s",
    );
    report
        .slowest_poles
        .iter()
        .fold(empty, |table, row| {
            let poles = row.poles.map(|pole| format!("{pole:.3}")).join(" ");
            let condition = format!("Q/R = {:e}", row.ratio);
            let values = ["slowest", "second slowest"].into_iter().zip(row.poles);
            let values = values.map(|(which, pole)| {
                Value::new(format!("{which} pole"), "1/s").under(condition.clone()).by("steady Kalman filter").is(pole)
            });
            let values: Vec<_> = values.collect();
            table.row(condition, "", poles, "").values(values)
        })
        .note("They go to the plant's zeros and no further, however little the filter trusts its model.")
}

fn independence(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-independence",
        "Sine inputs: by how much the errors of α, q, V, θ differ from those with constant inputs",
    );
    report
        .independence
        .iter()
        .fold(empty, |table, row| {
            let values = Value::each("difference of errors", STATES, STATE_UNITS, row.difference);
            let values = values.map(|value| value.by(row.estimator.clone()).limited(0.0));
            table.row(row.estimator.clone(), "", four(row.difference), "0 exactly").values(values)
        })
        .note(format!(
            "e⁺ = (A − L C) e has no u in it, so sine inputs are no experiment: {}.",
            alike(&report.catching)
        ))
}

/// The cost of speed: the middle poles made faster and slower, compared with the steady-state filter.
fn against_time() -> Result<Figure, Error> {
    let (plant, outputs, noise) = (Plant::P2, Outputs::Full, Noise::SENSORS);
    let (inputs, window) = (Inputs::Constant, Window::Settled);
    let settled = Cell { plant, outputs, noise, inputs, window, kinds: Vec::new() };
    let times = |kind: Kind| {
        let errors = Chase { kind, ..THESIS_LUENBERGER }.errors(ScalarKind::F64);
        errors
            .map(|errors| caught(&errors))
            .map_err(|problem| Error::Usage(format!("uav: there is no {}: {problem}", kind.name())))
    };
    let kalman = Kind::Matched(noise);
    let (best, kalman_times) = (settled.predicted(&kalman), times(kalman)?);
    let mut lines: [Vec<[f64; 2]>; 4] = Default::default();
    for quarters in -12..=11 {
        let factor = 2_f64.powf(f64::from(quarters) / 4.0);
        let kind = Kind::Luenberger(faster(MIDDLE, factor));
        let (rmse, times) = (settled.predicted(&kind), times(kind)?);
        for (state, line) in lines.iter_mut().enumerate() {
            line.extend(times[state].map(|time| [time, rmse[state] / best[state]]));
        }
    }
    let observers = STATES.into_iter().zip(lines).enumerate().map(|(state, (name, line))| {
        Series::path(format!("{name}, observers"), line).coloured(Colour::Other(state))
    });
    let filters = STATES.into_iter().zip(kalman_times).enumerate().map(|(state, (name, time))| {
        let points = time.map(|time| [time, 1.0]);
        Series::points(format!("{name}, Kalman"), points).coloured(Colour::Other(state))
    });
    let mut figure = Figure::new("uav-noise-against-time", "What a fast observer costs on P2")
        .axes("time to catch without noise, s", "settled RMSE under noise / the Kalman filter's")
        .caption("An observer is as quick as one likes, and as noisy; the steady filter is one point of each line's plane.")
        .logarithmic()
        .showing(Some([0.08, 10.0]), Some([0.8, 12.0]))
        .with_all(observers)
        .with_all(filters);
    figure.x.logarithmic = true;
    Ok(figure)
}
