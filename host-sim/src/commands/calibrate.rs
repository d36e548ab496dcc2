//! `host-sim calibrate`: what a system's sensors measure wrong, from a log made for it.

use clap::{ArgMatches, Command};

use super::arguments::chosen;
use crate::Error;
use crate::systems::ALL;

pub(super) fn command() -> Command {
    let about = "Find what a system's sensors measure wrong, from a log made for it";
    let calibrations = ALL.iter().filter_map(|system| {
        let command = system.calibration()?.command();
        Some(command.name(system.name()))
    });
    let command = Command::new("calibrate").about(about).subcommand_required(true);
    command.arg_required_else_help(true).subcommands(calibrations)
}

pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    match system.calibration() {
        Some(calibration) => calibration.run(matches),
        None => Err(Error::Usage(format!("{} has nothing to calibrate", system.name()))),
    }
}
