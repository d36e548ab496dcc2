//! `host-sim replay`: tracks a recording and compares it with the truth where that is known.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};

use super::archive;
use super::arguments::chosen;
use crate::system::{
    Account, AnySystem, Files, Opened, Reading, Setting, Settings, Source, Wanted,
};
use crate::systems::ALL;
use crate::{Error, output};

pub(super) fn command() -> Command {
    let command = Command::new("replay").about("Run a system on a recorded log");
    command
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(ALL.iter().map(|system| of(*system)))
}

fn of(system: &dyn AnySystem) -> Command {
    let outputs = system.outputs().iter().map(|output| file(output.name, "OUT.csv", output.help));
    let mcap = "Write sensors, estimate and truth as MCAP, for viewers such as Foxglove and Rerun";
    let out = "The table of --logs, of the format that its ending says";
    let required: Vec<_> =
        system.files().iter().filter(|field| field.required).map(|field| field.name).collect();
    let logs = format!(
        "Run every recording that matches a pattern such as 'dir/**/*.txt', in place of --{}, the first of them that is not given; in other \
         files' names {{dir}} and {{stem}} stand for its folder and its name without ending",
        required.join(" or --")
    );
    let logs = Arg::new("logs").long("logs").value_name("PATTERN").help(logs).requires("out");
    let names = system.outputs().iter().map(|it| it.name).chain(["mcap", "json", "synthetic"]);
    let command = required.into_iter().fold(recorded(system), |command, name| {
        command.mut_arg(name, |arg| arg.required_unless_present("logs"))
    });
    command
        .args(outputs)
        .arg(file("mcap", "OUT.mcap", mcap))
        .next_help_heading("Archives")
        .arg(logs.conflicts_with_all(names))
        .arg(file("out", "TABLE.csv", out).requires("logs"))
}

/// A command for a recording of a system, with the options for its files and for how it is tracked.
pub(super) fn recorded(system: &dyn AnySystem) -> Command {
    let settings = system.settings();
    let is_file = |name: &str| system.files().iter().any(|field| field.name == name);
    let files = system.files().iter().map(|field| {
        let arg = field.argument(&settings);
        if field.required { arg.required_unless_present("synthetic") } else { arg }
    });
    let names = system.synthetic().iter().map(|(name, _)| *name);
    let synthetic = Arg::new("synthetic")
        .long("synthetic")
        .value_name("NAME")
        .help("A synthetic recording instead of files")
        .value_parser(PossibleValuesParser::new(names))
        .conflicts_with_all(system.files().iter().map(|field| field.name).filter(|name| {
            // A text that is a value of a setting is not a file.
            !settings.iter().any(|setting| setting.name == *name)
        }));
    let imports = system.files().iter().any(|field| field.imported);
    let reading = Reading::arguments().filter(|_| imports);
    Command::new(system.name())
        .about(system.title())
        .args(files)
        .arg(synthetic)
        .args(reading.map(|arg| arg.conflicts_with("synthetic")))
        .args(settings.iter().filter(|it| !is_file(it.name)).flat_map(Setting::arguments))
        .next_help_heading("Output")
        .arg(
            Arg::new("json")
                .long("json")
                .help("Print one JSON object instead of a table")
                .action(ArgAction::SetTrue),
        )
}

fn file(name: &'static str, value_name: &'static str, help: &'static str) -> Arg {
    let arg = Arg::new(name).long(name).value_name(value_name).help(help);
    arg.value_parser(value_parser!(PathBuf))
}

/// Reads, tracks, compares, writes and prints; nothing is printed if there is an error.
pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    if let Some(pattern) = matches.get_one::<String>("logs") {
        return archive::run(system, matches, named(system, matches)?, pattern);
    }
    show(&account(system, matches)?, matches.get_flag("json"))
}

/// Reads, tracks, compares and writes.
pub(super) fn account(system: &dyn AnySystem, matches: &ArgMatches) -> Result<Account, Error> {
    let outputs = system.outputs().iter();
    let tables = outputs
        .filter_map(|output| Some((output.name, matches.get_one::<PathBuf>(output.name)?.clone())));
    let mcap = matches.get_one::<PathBuf>("mcap").cloned();
    let wanted = Wanted { tables: tables.collect(), mcap };
    let (settings, files) = named(system, matches)?;
    check_outputs(&wanted, &files)?;
    open(system, matches, &settings, files)?.replay(&settings, &wanted)
}

/// The recording that a command line names, opened, and its settings.
pub(super) fn opened(
    system: &dyn AnySystem,
    matches: &ArgMatches,
) -> Result<(Box<dyn Opened>, Settings), Error> {
    let (settings, files) = named(system, matches)?;
    Ok((open(system, matches, &settings, files)?, settings))
}

fn named(system: &dyn AnySystem, matches: &ArgMatches) -> Result<(Settings, Files), Error> {
    let mut settings = Settings::matched(system.settings(), matches);
    let files = Files::matched(system.files(), matches, &mut settings)?;
    Ok((settings, files))
}

fn open(
    system: &dyn AnySystem,
    matches: &ArgMatches,
    settings: &Settings,
    files: Files,
) -> Result<Box<dyn Opened>, Error> {
    system.refuse_idle(settings)?;
    let source = match matches.get_one::<String>("synthetic") {
        // A text that is not a value of the setting of the same name is a file.
        Some(_) if files.paths().next().is_some() => {
            return Err(Error::Usage("--synthetic needs no file".to_owned()));
        }
        Some(name) => Source::Synthetic(name.clone()),
        None => Source::Files(files),
    };
    system.open(source, settings)
}

fn show(account: &Account, json: bool) -> Result<(), Error> {
    for warning in &account.warnings {
        match &account.about {
            Some(path) => output::warn_of(path, std::slice::from_ref(warning)),
            None => output::warn(&format!("warning: {warning}")),
        }
    }
    if json {
        return output::print(&account.report.to_string());
    }
    if let Some(text) = &account.text {
        return output::print(text);
    }
    let mut table = output::table();
    for (name, value) in &account.facts {
        table.add_row([name, value]);
    }
    output::print(&table.to_string())
}

/// Refuses outputs that would be written twice or over an input, or that cannot be written.
fn check_outputs(wanted: &Wanted, files: &Files) -> Result<(), Error> {
    let option = |name: &str| format!("--{name}");
    let tables = wanted.tables.iter().map(|(name, path)| (option(name), path));
    let all: Vec<_> = tables.chain(wanted.mcap.iter().map(|path| (option("mcap"), path))).collect();
    let outputs: Vec<_> =
        all.iter().map(|(name, path)| (name.as_str(), Some(path.as_path()))).collect();
    output::refuse_clashes(&outputs, &files.paths())?;
    all.iter().try_for_each(|(_, path)| output::refuse_unwritable(path))
}
