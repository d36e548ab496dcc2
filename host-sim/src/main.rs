//! The executable: passes the command line on to the library.

use std::process::ExitCode;

use host_sim::{Error, commands, output};

/// The exit status for wrong usage or unreadable input.
const REFUSED: u8 = 2;

fn main() -> ExitCode {
    if let Err(error) =
        rayon::ThreadPoolBuilder::new().stack_size(host_sim::STACK_BYTES).build_global()
    {
        return refuse(&format!("no threads: {error}"));
    }
    let arguments: Vec<_> = std::env::args_os().collect();
    let matches = match commands::command(&arguments).try_get_matches_from(&arguments) {
        Ok(matches) => matches,
        Err(error) if error.use_stderr() => {
            return refuse(&commands::complaint(&error, &arguments));
        }
        // Clap knows whether the terminal wants colours.
        Err(help_or_version) => return finish(output::done(help_or_version.print())),
    };
    finish(commands::dispatch(&matches))
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
