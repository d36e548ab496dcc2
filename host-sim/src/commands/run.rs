//! `host-sim run`: runs a system on its synthetic streams and shows published beside own results.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Args, Command, value_parser};

use super::arguments::{chosen, read};
use super::recorded::{self, Folders};
use crate::report::Recorded;
use crate::system::{AnySystem, Outputs, RunOptions, Setting, Settings, say_where, tried};
use crate::systems::ALL;
use crate::text::{command_line, printable_path};
use crate::{Error, output, report};

/// The option that names a folder of recordings.
const DATA: &str = "data";

pub(super) fn command() -> Command {
    let about = "Run a system on its synthetic streams and print published beside own results";
    let command = Command::new("run").about(about).subcommand_required(true);
    command.arg_required_else_help(true).subcommands(ALL.iter().map(|system| of(*system)))
}

fn of(system: &dyn AnySystem) -> Command {
    let command = RunOptions::augment_args(Command::new(system.name()));
    let command = command.next_help_heading("One cell instead of all tables");
    let command = command.args(system.cell().iter().flat_map(Setting::arguments));
    Outputs::augment_args(command).arg(data().requires("report")).about(system.title())
}

/// The option that adds recordings to the report.
pub(super) fn data() -> Arg {
    let help = "Show in the report what the recordings of this folder give, too: those that README's table cites, laid out as \
                fetch-data does; missing ones are named";
    let arg = Arg::new(DATA).long(DATA).value_name("FOLDER").help(help);
    arg.value_parser(value_parser!(PathBuf))
}

/// The folder of recordings, if one is given.
pub(super) fn data_of(matches: &ArgMatches) -> Option<&Path> {
    matches.get_one::<PathBuf>(DATA).map(PathBuf::as_path)
}

/// The recorded part of a chapter, if a folder of recordings is given.
fn recorded(
    system: &dyn AnySystem,
    data: Option<&Path>,
    report: &Path,
    arguments: &[&str],
) -> Result<Option<Recorded>, Error> {
    let Some(data) = data else { return Ok(None) };
    let words = arguments.iter().map(|&word| word.to_owned());
    let words = words.chain(["--data".to_owned(), printable_path(data)]);
    let command = command_line(["host-sim".to_owned()].into_iter().chain(words));
    recorded::of(system, Folders { data, report }, &command)
}

/// Runs an experiment, writes the requested files and prints the result.
pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    let (options, outputs) = (read::<RunOptions>(matches)?, read::<Outputs>(matches)?);
    outputs.check()?;
    let data = data_of(matches);
    data.map_or(Ok(()), recorded::refuse_absent)?;
    let cell = Settings::matched(system.cell(), matches);
    let samples = tried(&system.trials(&options, &cell)?)?;
    let experiment = system.experiment(&options, &cell, &samples, outputs.any_file())?;
    if let Some(mut chapter) = experiment.chapter {
        if let Some(report) = &outputs.report {
            let shown = printable_path(report);
            let words = ["run", system.name(), "--report", &shown];
            chapter.recorded = recorded(system, data, report, &words)?;
        }
        outputs.write(chapter)?;
    }
    if outputs.json {
        return output::print(&experiment.report.to_string());
    }
    output::print(&experiment.text)
}

/// Runs every system on its synthetic streams, prints the few most important numbers, and writes the report into
/// `folder`, including the results of recordings in the folder `data`.
pub(super) fn everything(folder: &Path, data: Option<&Path>) -> Result<(), Error> {
    output::refuse_unwritable_folder(folder)?;
    data.map_or(Ok(()), recorded::refuse_absent)?;
    let mut chapters = Vec::new();
    for system in ALL {
        let (options, cell) = (RunOptions::default(), Settings::new(system.cell()));
        let samples = tried(&system.trials(&options, &cell)?)?;
        let experiment = system.experiment(&options, &cell, &samples, true)?;
        if let Some(mut chapter) = experiment.chapter {
            chapter.recorded = recorded(system, data, folder, &[])?;
            output::print(&format!("{}\n", chapter.summary))?;
            chapters.push(chapter);
        }
    }
    say_where(&report::write(folder, &chapters)?);
    Ok(())
}
