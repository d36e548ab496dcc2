//! The drone's part of the report: the thesis' chapter 3 in its order, followed by what goes beyond it.

mod cells;
mod moving;
mod staying;
mod summary;
mod tables;

use super::report::Report;
use crate::Error;
use crate::report::{Chapter, Item, Made};
use crate::system::System;
use crate::systems::drone::Drone;

/// The complete chapter.
///
/// # Errors
/// None: items for which a report of a single cell has no rows are left out.
pub fn chapter(report: &Report) -> Result<Chapter, Error> {
    let walks = moving::Walks::new(report);
    let mut items: Vec<Item> = staying::items(report);
    items.extend(moving::items(report, &walks));
    items.extend(tables::beyond(report));
    Ok(Chapter {
        system: Drone::NAME,
        title: "Drone: a base station finds a user by path loss and a particle filter",
        paper: Drone::PAPER,
        about: "A drone measures the path loss to a user on the ground, of whom it knows nothing else. The \
                thesis' particle filter is repeated literally; ours is a lattice for a user who stays and a \
                cloud whose particles know their velocity for one who walks. Its numbers are means of 100 \
                trials, with standard errors of 6 to 40 m; ours are given with theirs (±). The limit is the \
                exact posterior's mean on the same measurements."
            .to_owned(),
        summary: summary::summary(report),
        headlines: summary::headlines(report),
        picture: "drone-fig-3-6-circling",
        items,
        streams: walks.streams(),
        recorded: None,
    })
}

/// How the tables of the command were made, with the number of trials.
fn made(report: &Report, trials: impl Into<String>) -> Made {
    let scalar = format!("{:?}", report.scalar).to_lowercase();
    let seed = report.seed;
    let trials = trials.into();
    Made {
        command: format!(
            "cargo run --release -p host-sim -- run drone --seed {seed} --scalar {scalar}"
        ),
        seed,
        trials,
    }
}

#[cfg(test)]
mod tests;
