//! `host-sim run uav`: the thesis' experiments.

use kestirim_replay::uav::Plant;
use kestirim_sweep::{Block, Samples};
use rayon::prelude::*;

use super::report::Report;
use super::{accuracy, catching, claims, responses};
use crate::Error;
use crate::system::{RunOptions, ScalarKind, choose_scalar};

/// The default number of flights per cell, which determines an RMSE to one or two percent.
const TRIALS: u64 = 500;

/// The trials: the flights of each cell.
///
/// # Errors
/// If the number type is not supported.
pub fn trials(options: RunOptions) -> Result<Vec<Block>, Error> {
    let scalar = choose_scalar("uav", options.scalar, &ScalarKind::ALL, ScalarKind::F32)?;
    let trials = options.trials.unwrap_or(TRIALS);
    let cells = accuracy::cells().into_iter().enumerate();
    Ok(cells.map(|(place, cell)| cell.block(place, scalar, options.seed, trials)).collect())
}

/// Evaluates the samples of the trials, and adds the results that need no trials.
///
/// # Errors
/// Those of [`trials`].
pub fn report(options: RunOptions, samples: &[Samples]) -> Result<Report, Error> {
    let scalar = choose_scalar("uav", options.scalar, &ScalarKind::ALL, ScalarKind::F32)?;
    let cells = accuracy::cells().into_iter().zip(samples);
    let accuracy: Vec<_> = cells.flat_map(|(cell, flights)| cell.rows(flights)).collect();
    let catching = catching::rows(scalar);
    Ok(Report {
        system: "uav",
        seed: options.seed,
        scalar,
        trials: samples.first().map_or(0, Samples::len),
        plants: Plant::ALL.into_par_iter().map(responses::responses).collect(),
        claims: claims::claims(&catching, &accuracy),
        slowest_poles: claims::slowest_poles(),
        independence: claims::independence(scalar),
        catching,
        accuracy,
    })
}
