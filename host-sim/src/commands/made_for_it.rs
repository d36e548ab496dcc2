//! `host-sim calibrate`, `survey` and `identify`: what a system determines from a log recorded for the purpose.

use clap::{ArgMatches, Command};

use super::arguments::chosen;
use crate::Error;
use crate::system::{AnySystem, Calibration};
use crate::systems::ALL;

/// A command: its name, its description, and the function that gets it from a system.
type Made = (&'static str, &'static str, fn(&dyn AnySystem) -> Option<Box<dyn Calibration>>);

pub(super) const CALIBRATE: Made =
    ("calibrate", "Find what a system's sensors measure wrong, from a log made for it", |system| {
        system.calibration()
    });
pub(super) const SURVEY: Made = (
    "survey",
    "Find where a system's stations are, from what they measure of each other",
    |system| system.survey(),
);
pub(super) const IDENTIFY: Made =
    ("identify", "Find how a system moves, from logs of manoeuvres", |system| {
        system.identification()
    });

pub(super) fn command((name, about, of): Made) -> Command {
    let systems = ALL.iter().filter_map(|system| Some(of(*system)?.command().name(system.name())));
    let command = Command::new(name).about(about).subcommand_required(true);
    command.arg_required_else_help(true).subcommands(systems)
}

pub(super) fn run((name, _, of): Made, matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    match of(system) {
        Some(found) => found.run(matches),
        None => Err(Error::Usage(format!("{} has nothing to {name}", system.name()))),
    }
}
