//! `host-sim run uav`: the thesis' experiments.

use kestirim_replay::uav::Plant;
use rayon::prelude::*;

use super::report::Report;
use super::{accuracy, catching, claims, responses};
use crate::system::choose_scalar;
use crate::system::{RunOptions, ScalarKind};
use crate::{Error, output};

/// Flights a cell unless told otherwise: a RMSE is then known to one or two percent.
const TRIALS: u32 = 500;

/// Runs all.
///
/// # Errors
/// If the scalar is not supported.
pub fn run(options: RunOptions) -> Result<Report, Error> {
    let all = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];
    let scalar = choose_scalar("uav", options.scalar, &all, ScalarKind::F32)?;
    let trials = options.trials.unwrap_or(TRIALS);
    let cells = accuracy::cells();
    let bar = output::progress(cells.len() as u64, "cells");
    let accuracy: Vec<_> = cells
        .iter()
        .flat_map(|cell| {
            let rows = cell.rows(scalar, options.seed, trials);
            bar.inc(1);
            rows
        })
        .collect();
    bar.finish_and_clear();
    let catching = catching::rows(scalar);
    Ok(Report {
        system: "uav",
        seed: options.seed,
        scalar,
        trials,
        plants: Plant::ALL.into_par_iter().map(responses::responses).collect(),
        claims: claims::claims(&catching, &accuracy),
        slowest_poles: claims::slowest_poles(),
        independence: claims::independence(scalar),
        catching,
        accuracy,
    })
}
