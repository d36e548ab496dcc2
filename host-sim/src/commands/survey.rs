//! `host-sim survey`: where a system's stations are, from what they measure of each other.

use clap::{ArgMatches, Command};

use super::arguments::chosen;
use crate::Error;
use crate::systems::ALL;

pub(super) fn command() -> Command {
    let surveys = ALL.iter().filter_map(|system| {
        let command = system.survey()?.command();
        Some(command.name(system.name()))
    });
    let about = "Find where a system's stations are, from what they measure of each other";
    let command = Command::new("survey").about(about).subcommand_required(true);
    command.arg_required_else_help(true).subcommands(surveys)
}

pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    match system.survey() {
        Some(survey) => survey.run(matches),
        None => Err(Error::Usage(format!("{} has nothing to survey", system.name()))),
    }
}
