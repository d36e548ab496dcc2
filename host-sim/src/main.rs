//! The program: dispatches the command line to the library.

use std::process::ExitCode;

use clap::Parser;
use host_sim::cli::{self, Calibrate, Cli, Command, Replay, RunOptions};
use host_sim::systems::{self, System};
use host_sim::{Error, output};

/// Wrong usage or unreadable input.
const REFUSED: u8 = 2;

fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) if error.use_stderr() => return refuse(&cli::sentence(&error)),
        Err(help_or_version) => {
            return finish(output::print(&help_or_version.render().to_string()));
        }
    };
    finish(dispatch(cli.command))
}

fn dispatch(command: Option<Command>) -> Result<(), Error> {
    match command {
        None => {
            System::ALL.into_iter().try_for_each(|system| system.run(RunOptions::default(), false))
        }
        Some(Command::Run(run)) => run.system.run(run.options, run.json),
        Some(Command::Replay(Replay::Pedestrian(replay))) => replay.run(),
        Some(Command::Replay(Replay::Robot(replay))) => replay.run(),
        Some(Command::Calibrate(Calibrate::Robot(calibrate))) => calibrate.run(),
        Some(Command::List) => output::print(&systems::list()),
    }
}

fn finish(result: Result<(), Error>) -> ExitCode {
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => refuse(&error.to_string()),
    }
}

fn refuse(sentence: &str) -> ExitCode {
    output::warn(&format!("host-sim: {sentence}"));
    ExitCode::from(REFUSED)
}
