//! The commands, each written once for all systems.

mod archive;
mod arguments;
mod check;
mod datagrams;
pub mod design;
mod fetch_data;
#[cfg(feature = "fleet")]
mod fleet;
mod list;
pub mod live;
mod made_for_it;
mod merge;
mod recorded;
mod replay;
mod run;
pub mod serve;
mod sweep;

use std::ffi::OsString;
use std::path::Path;

use clap::{ArgMatches, Args, Command, value_parser};
use clap_complete::Shell;

use self::arguments::{read, sentence};
use self::design::Design;
use self::fetch_data::FetchData;
use self::made_for_it::{CALIBRATE, IDENTIFY, SURVEY};
use self::merge::Together;
use self::serve::Serve;
use self::sweep::Sweep;
use crate::system::{Account, AnySystem};
use crate::systems::ALL;
use crate::{Error, output};

/// The folder of the report, relative to the working directory.
const REPORT: &str = "target/report";

/// The complete command line. The options of `live` are those of the system that `arguments` names.
pub fn command(arguments: &[OsString]) -> Command {
    let command = Command::new("host-sim")
        .version(env!("CARGO_PKG_VERSION"))
        .about("Estimators on synthetic and recorded streams")
        .long_about(
            "Estimators on synthetic and recorded streams.\n\nWithout arguments every system runs on its synthetic \
             streams, and target/report/index.html shows what came out, beside what the papers print.",
        )
        .after_help(examples(ALL[0]))
        .args_conflicts_with_subcommands(true)
        .arg(run::data())
        .subcommand(run::command())
        .subcommand(replay::command())
        .subcommand(
            Sweep::augment_args(Command::new("sweep"))
                .about("Try many settings, seeds or recordings, in shards"),
        )
        .subcommand(
            Together::augment_args(Command::new("merge"))
                .about("Put the shards of a sweep together and print what a single run prints"),
        )
        .subcommand(check::command())
        .subcommand(made_for_it::command(CALIBRATE))
        .subcommand(made_for_it::command(SURVEY))
        .subcommand(made_for_it::command(IDENTIFY))
        .subcommand(
            Design::augment_args(Command::new("design"))
                .about("Design observers: gains, discretisations and covariances of a file of cases"),
        )
        .subcommand(
            Serve::augment_args(Command::new("serve"))
                .about("Explore recordings in the browser: thresholds and filters with sliders"),
        )
        .subcommand(live::command(arguments))
        .subcommand(FetchData::augment_args(Command::new("fetch-data")).about(
            "Fetch the recordings that may be passed on from those who publish them, by curl or wget",
        ))
        .subcommand(Command::new("list").about("List systems, scenarios and log formats"))
        .subcommand(
            Command::new("completions")
                .about("Print what makes a shell complete this program's options")
                .arg(
                    clap::Arg::new("shell")
                        .help("Which shell")
                        .required(true)
                        .value_parser(value_parser!(Shell)),
                ),
        );
    #[cfg(feature = "fleet")]
    let command = command.subcommand(fleet::command());
    command
}

fn examples(system: &dyn AnySystem) -> String {
    let name = system.name();
    format!(
        "\
Examples:
  host-sim                                        every paper's experiments, and a report to look at
  host-sim serve                                  turn thresholds and filters in the browser
  host-sim run {name} --trials 5 --mcap a.mcap
  host-sim replay {name} --log walk.txt --track path.csv
  host-sim live --system {name}               follow a sensor that sends telemetry
  host-sim completions bash > ~/.local/share/bash-completion/completions/host-sim

Exit status: 0 if it was done, 2 if the command line or a file is not as it should be; then one sentence
on standard error says which file, which line and what was expected. NO_COLOR is respected."
    )
}

/// Runs the command that the command line asks for.
///
/// # Errors
/// A one-sentence error.
pub fn dispatch(matches: &ArgMatches) -> Result<(), Error> {
    let Some((name, matches)) = matches.subcommand() else {
        return run::everything(Path::new(REPORT), run::data_of(matches));
    };
    match name {
        "run" => run::run(matches),
        "replay" => replay::run(matches),
        "sweep" => read::<Sweep>(matches)?.run(),
        "merge" => read::<Together>(matches)?.run(),
        "check" => check::run(matches),
        "calibrate" => made_for_it::run(CALIBRATE, matches),
        "survey" => made_for_it::run(SURVEY, matches),
        "identify" => made_for_it::run(IDENTIFY, matches),
        "design" => read::<Design>(matches)?.run(),
        "serve" => read::<Serve>(matches)?.run(),
        "live" => live::run(matches),
        #[cfg(feature = "fleet")]
        "fleet" => fleet::run(matches),
        "fetch-data" => read::<FetchData>(matches)?.run(),
        "list" => output::print(&list::list()),
        _ => completions(matches),
    }
}

/// Replays the recording that a command line of `replay` names, and writes the requested files.
///
/// # Errors
/// A one-sentence error.
pub fn replayed(matches: &ArgMatches) -> Result<Account, Error> {
    let replay = matches.subcommand_matches("replay");
    let replay = replay.ok_or_else(|| Error::Usage("expected replay".to_owned()))?;
    let (system, matches) = arguments::chosen(replay)?;
    replay::account(system, matches)
}

/// Prints the script with which a shell completes this program's options.
fn completions(matches: &ArgMatches) -> Result<(), Error> {
    let Some(&shell) = matches.get_one::<Shell>("shell") else { return Ok(()) };
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command(&[]), "host-sim", &mut script);
    let mut script = String::from_utf8_lossy(&script).into_owned();
    if shell == Shell::Bash {
        // clap_complete writes the hyphen of a program's name in two ways, so that nothing below a command is
        // completed: https://github.com/clap-rs/clap/issues/6421.
        script = script.replace("host__subcmd__sim", "host__sim");
    }
    output::print(&script)
}

/// The error message for a wrong command line, in one plain sentence.
pub fn complaint(error: &clap::Error, arguments: &[OsString]) -> String {
    let is_live = arguments.get(1).is_some_and(|word| word == "live");
    let known = if is_live { live::complaint(error) } else { None };
    if cfg!(not(feature = "fleet")) && arguments.get(1).is_some_and(|word| word == "fleet") {
        return "this program was built without fleets (--features fleet)".to_owned();
    }
    known.unwrap_or_else(|| sentence(error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_consistent() {
        command(&[]).debug_assert();
        for system in ALL {
            let arguments = ["host-sim", "live", "--system", system.name()].map(OsString::from);
            command(&arguments).debug_assert();
        }
    }

    #[test]
    fn each_command_says_what_it_does() {
        fn look(command: &Command) {
            let about = command.get_about().map(ToString::to_string).unwrap_or_default();
            assert!(
                !about.is_empty() && !about.starts_with("Options"),
                "{}: {about}",
                command.get_name()
            );
            command.get_subcommands().for_each(look);
        }
        look(&command(&[]));
    }

    #[test]
    fn a_usage_error_is_one_sentence() {
        let first = ALL[0].name();
        for arguments in [
            &["host-sim", "fly"][..],
            &["host-sim", "run"],
            &["host-sim", "run", first, "--trials", "0"],
            &["host-sim", "replay", first],
            &["host-sim", "replay", first, "--log", "a", "--tracker", "best"],
        ] {
            let error = command(&[]).try_get_matches_from(arguments).unwrap_err();
            let sentence = sentence(&error);
            assert!(!sentence.contains('\n') && !sentence.starts_with("error"), "{sentence}");
        }
    }
}
