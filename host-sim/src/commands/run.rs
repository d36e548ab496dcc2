//! `host-sim run`: a system on its synthetic streams, published beside own results.

use std::path::Path;

use clap::{ArgMatches, Args, Command};

use super::arguments::{chosen, read};
use crate::system::{AnySystem, Outputs, RunOptions, Setting, Settings, say_where, tried};
use crate::systems::ALL;
use crate::{Error, output, report};

pub(super) fn command() -> Command {
    let about = "Run a system on its synthetic streams and print published beside own results";
    let command = Command::new("run").about(about).subcommand_required(true);
    command.arg_required_else_help(true).subcommands(ALL.iter().map(|system| of(*system)))
}

fn of(system: &dyn AnySystem) -> Command {
    let command = RunOptions::augment_args(Command::new(system.name()).about(system.title()));
    let command = command.next_help_heading("One cell instead of all tables");
    let command = command.args(system.cell().iter().flat_map(Setting::arguments));
    Outputs::augment_args(command)
}

/// Runs an experiment, writes what was asked for, and prints the rest.
pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    let (options, outputs) = (read::<RunOptions>(matches)?, read::<Outputs>(matches)?);
    outputs.check()?;
    let cell = Settings::matched(system.cell(), matches);
    let samples = tried(&system.trials(&options, &cell)?)?;
    let experiment = system.experiment(&options, &cell, &samples, outputs.any_file())?;
    if let Some(chapter) = experiment.chapter {
        outputs.write(chapter)?;
    }
    if outputs.json {
        return output::print(&experiment.report.to_string());
    }
    output::print(&experiment.text)
}

/// Runs every system on its synthetic streams, prints the few numbers that matter most, and writes the
/// report into `folder`.
pub(super) fn everything(folder: &Path) -> Result<(), Error> {
    output::refuse_unwritable_folder(folder)?;
    let mut chapters = Vec::new();
    for system in ALL {
        let (options, cell) = (RunOptions::default(), Settings::new(system.cell()));
        let samples = tried(&system.trials(&options, &cell)?)?;
        let experiment = system.experiment(&options, &cell, &samples, true)?;
        if let Some(chapter) = experiment.chapter {
            output::print(&format!("{}\n", chapter.summary))?;
            chapters.push(chapter);
        }
    }
    say_where(&report::write(folder, &chapters)?);
    Ok(())
}
