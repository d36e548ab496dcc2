//! The report that the command prints.

use std::fmt;

use comfy_table::Table;
use kestirim_replay::uav::Plant;
use serde::Serialize;

use super::accuracy::{self, Window};
use super::catching;
use super::claims::{Claim, Independence, SlowestPoles};
use super::responses::Responses;
use crate::output;
use crate::system::ScalarKind;
use crate::systems::uav::account::states::{shown, times};
use crate::systems::uav::paper::published::{CONSTANT_INPUTS, SETTLING_S};
use crate::systems::uav::simulate::plant::STATES;
use crate::systems::uav::simulate::scenario::Inputs;

/// The results of all experiments.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Always `uav`.
    pub system: &'static str,
    /// Seed of all randomness.
    pub seed: u64,
    /// The number type of the estimators.
    pub scalar: ScalarKind,
    /// The number of flights per cell of the accuracies.
    pub trials: usize,
    /// The responses of the plants.
    pub plants: Vec<Responses>,
    /// The times to catch the plant.
    pub catching: Vec<catching::Row>,
    /// The errors under noise.
    pub accuracy: Vec<accuracy::Row>,
    /// The slowest poles of a steady-state filter.
    pub slowest_poles: Vec<SlowestPoles>,
    /// The independence of the errors from the inputs.
    pub independence: Vec<Independence>,
    /// The conclusions of the thesis.
    pub claims: Vec<Claim>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, trials, .. } = self;
        let scalar = format!("{:?}", self.scalar).to_lowercase();
        writeln!(
            f,
            "uav: α, q, θ in rad and rad/s, V in m/s; seed {seed}, estimators in {scalar}\n\n{}\n\n{}",
            plants(&self.plants),
            constant_inputs(&self.plants)
        )?;
        writeln!(
            f,
            "\ntime from which the error stays within 0.005 rad, 0.005 rad/s, 0.1 m/s and 0.005 rad, s, \
             without noise\n(limit: of the error recursion alone, in double precision)\n{}",
            caught(&self.catching)
        )?;
        writeln!(f, "\n{}\n\n{}", alike(&self.catching), slowest(&self.slowest_poles))?;
        writeln!(
            f,
            "\nRMSE of {trials} flights (limit: Lyapunov's equation, or its recursion over the whole flight)\n{}",
            errors(&self.accuracy)
        )?;
        writeln!(
            f,
            "\nerrors do not depend on what the pilot does: e⁺ = (A − L C) e has no u\n{}",
            independence(&self.independence)
        )?;
        write!(f, "\nthe thesis' conclusions\n{}", claims(&self.claims))
    }
}

fn plants(rows: &[Responses]) -> Table {
    let mut table = output::table();
    let settling = format!("settling δe, s (published ≈ {SETTLING_S})");
    table.set_header([
        "plant",
        &settling,
        "settling δt, s",
        "short period, phugoid",
        "largest gain",
        "least visible: all, q V θ, V θ",
    ]);
    for row in rows {
        let [short, phugoid] =
            row.modes().map(|[omega, damping]| format!("{omega:.3} rad/s ({damping:.3})"));
        let settling = |input: usize| row.settling_s[input].map(|s| format!("{s:.0}")).join(" ");
        let seen: Vec<_> = row.observability.iter().map(|it| format!("{:.1e}", it.least)).collect();
        table.add_row([
            row.plant.name().to_owned(),
            settling(0),
            settling(1),
            format!("{short}, {phugoid}"),
            format!("{:.0} at {:.3} rad/s", row.peak.gain, row.peak.omega),
            seen.join(" "),
        ]);
    }
    table
}

fn constant_inputs(rows: &[Responses]) -> Table {
    let mut table = output::table();
    table.set_header(["P2 with δe 0.025, δt 0.155", "published", "ours"]);
    table.add_rows(said_of_constant_inputs(rows));
    table
}

/// The thesis' statements about its Figs 5.5 to 5.8 and our results: quantity, published, ours.
pub(super) fn said_of_constant_inputs(rows: &[Responses]) -> Vec<[String; 3]> {
    let Some(row) = rows.iter().find(|row| row.plant == Plant::P2) else { return Vec::new() };
    let samples = &row.constant_inputs;
    let at = |s: f64, state: usize| {
        let sample = samples.iter().rfind(|sample| sample[0] <= s + 1e-9);
        sample.map_or(f64::NAN, |sample| sample[state])
    };
    let least = |state: usize| {
        let lowest = samples.iter().min_by(|a, b| a[state].total_cmp(&b[state]));
        lowest.map_or([f64::NAN; 2], |sample| [sample[0], sample[state]])
    };
    let ours = [
        format!("{:.3}", at(1.5, 1)),
        format!("{:.3}", at(10.0, 1)),
        format!("{:.2} s", least(2)[0]),
        format!("{:.1}", least(3)[1]),
        format!("{:.3}", least(4)[1]),
        format!("{:.3}", at(10.0, 4)),
    ];
    let both = CONSTANT_INPUTS.into_iter().zip(ours);
    both.map(|([name, published], ours)| [name.to_owned(), published.to_owned(), ours]).collect()
}

/// Four numbers of the states, as text.
pub(super) fn four(numbers: [f64; 4]) -> String {
    numbers.map(|number| format!("{number:.1e}")).join(" ")
}

/// The number of chases that take as long with sine inputs as with constant ones, as text.
pub(super) fn alike(rows: &[catching::Row]) -> String {
    let of = |inputs| rows.iter().filter(move |row| row.inputs == inputs);
    let twin = |row: &&catching::Row| {
        let same = |other: &catching::Row| {
            (row.plant, row.outputs, row.start) == (other.plant, other.outputs, other.start)
                && row.estimator == other.estimator
                && row.ours_s == other.ours_s
        };
        of(Inputs::Constant).any(same)
    };
    let (all, same) = (of(Inputs::Sine).count(), of(Inputs::Sine).filter(twin).count());
    format!("with sine inputs {same} of {all} take exactly as long as with constant ones")
}

fn slowest(rows: &[SlowestPoles]) -> Table {
    let mut table = output::table();
    table.set_header(["steady-state Kalman on P2, all outputs: Q/R", "slowest poles, 1/s"]);
    for SlowestPoles { ratio, poles } in rows {
        table.add_row([format!("{ratio:e}"), poles.map(|pole| format!("{pole:.3}")).join(" ")]);
    }
    table
}

fn caught(rows: &[catching::Row]) -> Table {
    let mut table = output::table();
    let states = STATES.join(" ");
    let header = ["plant", "outputs", "inputs", "start", "estimator", "published"];
    table.set_header(header.map(str::to_owned).into_iter().chain([states, "limit".to_owned()]));
    // The other rows with sine inputs are in the JSON output.
    let shown = rows.iter().filter(|row| row.inputs != Inputs::Sine || row.published.is_some());
    for row in shown {
        let published = match (row.published, row.source) {
            (Some(published), Some(source)) => format!("{} ({source})", published.join(" ")),
            _ => String::new(),
        };
        table.add_row([
            row.plant.name().to_owned(),
            row.outputs.name().to_owned(),
            row.inputs.name().to_owned(),
            row.start.map(|number| number.to_string()).join(" "),
            row.estimator.clone(),
            published,
            times(row.ours_s),
            times(row.limit_s),
        ]);
    }
    table
}

fn errors(rows: &[accuracy::Row]) -> Table {
    let mut table = output::table();
    let states = STATES.join(" ");
    let header = ["plant", "outputs", "noise", "flight", "estimator"];
    table.set_header(header.map(str::to_owned).into_iter().chain([
        states,
        "limit".to_owned(),
        "off".to_owned(),
    ]));
    for row in rows {
        let flight = match row.window {
            Window::Whole => "whole",
            Window::Settled => "settled",
        };
        let refused = match row.refused {
            0 => String::new(),
            count => format!(", {count} steps refused"),
        };
        table.add_row([
            row.plant.name().to_owned(),
            row.outputs.name().to_owned(),
            row.noise.name.to_owned(),
            format!("{flight}, {}", row.inputs.name()),
            row.estimator.clone(),
            four(row.rmse),
            four(row.predicted),
            format!("{:+.1} %{refused}", 100.0 * row.off()),
        ]);
    }
    table
}

fn independence(rows: &[Independence]) -> Table {
    let mut table = output::table();
    table.set_header(["P2, all outputs", "largest error", "sine less constant inputs"]);
    for row in rows {
        table.add_row([row.estimator.clone(), four(row.largest_error), four(row.difference)]);
    }
    table
}

fn claims(rows: &[Claim]) -> Table {
    let mut table = output::table();
    table.set_header(["claim", "where", "Kalman", "best Luenberger", "true"]);
    for row in rows {
        table.add_row([
            row.claim.to_owned(),
            row.setting.to_owned(),
            shown(row.kalman),
            shown(row.luenberger),
            if row.holds { "yes" } else { "no" }.to_owned(),
        ]);
    }
    table
}
