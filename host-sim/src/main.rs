//! The program: dispatches the command line to the library.

use std::path::Path;
use std::process::ExitCode;

use clap::Parser;
use host_sim::cli::{self, Calibrate, Cli, Command, Replay, Run};
use host_sim::systems;
use host_sim::{Error, output};

/// Wrong usage or unreadable input.
const REFUSED: u8 = 2;

/// Where the report goes, from the folder in which the program is started.
const REPORT: &str = "target/report";

fn main() -> ExitCode {
    if let Err(error) =
        rayon::ThreadPoolBuilder::new().stack_size(host_sim::STACK_BYTES).build_global()
    {
        return refuse(&format!("no threads: {error}"));
    }
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) if error.use_stderr() => return refuse(&cli::sentence(&error)),
        // Clap knows whether the terminal wants colours.
        Err(help_or_version) => return finish(output::done(help_or_version.print())),
    };
    finish(dispatch(cli.command))
}

fn dispatch(command: Option<Command>) -> Result<(), Error> {
    match command {
        None => systems::report(Path::new(REPORT)),
        Some(Command::Run(Run::Pedestrian(run))) => systems::run_pedestrian(&run),
        Some(Command::Run(Run::Robot(run))) => systems::run_robot(&run),
        Some(Command::Run(Run::Drone(run))) => systems::run_drone(&run),
        Some(Command::Run(Run::Uav(run))) => systems::run_uav(&run),
        Some(Command::Run(Run::Gnss(run))) => systems::run_gnss(&run),
        Some(Command::Replay(Replay::Pedestrian(replay))) => replay.run(),
        Some(Command::Replay(Replay::Robot(replay))) => replay.run(),
        Some(Command::Replay(Replay::Drone(replay))) => replay.run(),
        Some(Command::Replay(Replay::Uav(replay))) => replay.run(),
        Some(Command::Replay(Replay::Gnss(replay))) => replay.run(),
        Some(Command::Calibrate(Calibrate::Robot(calibrate))) => calibrate.run(),
        Some(Command::Design(design)) => design.run(),
        Some(Command::Serve(serve)) => serve.run(&systems::SOURCES),
        Some(Command::Completions { shell }) => output::print(&cli::completions(shell)),
        Some(Command::Live(live)) => live.run(),
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
