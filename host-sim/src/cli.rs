//! The command line.

use clap::{Args, CommandFactory, Parser, Subcommand};
use clap_complete::Shell;

use crate::design::Design;
use crate::live::options::Live;
use crate::outputs::Outputs;
use crate::serve::Serve;
use crate::systems::{drone, gnss, pedestrian, robot, uav};

/// What the first page of `--help` ends with.
const EXAMPLES: &str = "\
Examples:
  host-sim                                        every paper's experiments, and a report to look at
  host-sim serve                                  turn thresholds and filters in the browser
  host-sim run pedestrian --trials 5 --mcap a.mcap
  host-sim replay pedestrian --log walk.txt --track path.csv
  host-sim live --system pedestrian               follow a sensor that sends telemetry
  host-sim completions bash > ~/.local/share/bash-completion/completions/host-sim

Exit status: 0 if it was done, 2 if the command line or a file is not as it should be; then one sentence
on standard error says which file, which line and what was expected. NO_COLOR is respected.";

/// Estimators on synthetic and recorded streams.
///
/// Without arguments every system runs on its synthetic streams, and target/report/index.html shows what
/// came out, beside what the papers print.
#[derive(Debug, Parser)]
#[command(name = "host-sim", version, after_help = EXAMPLES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// What the program can be asked to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a system on its synthetic streams and print published beside own results
    #[command(subcommand)]
    Run(Run),
    /// Run a system on a recorded log
    #[command(subcommand)]
    Replay(Replay),
    /// Find what a system's sensors measure wrong, from a log with known truth
    #[command(subcommand)]
    Calibrate(Calibrate),
    /// Design observers: gains, discretisations and covariances of a file of cases
    Design(Design),
    /// Explore recordings in the browser: thresholds and filters with sliders
    Serve(Serve),
    /// Listen to a sender's telemetry, record it and follow it with a system's estimator
    Live(Live),
    /// List systems, scenarios and log formats
    List,
    /// Print what makes a shell complete this program's options
    Completions {
        /// Which shell
        shell: Shell,
    },
}

/// `host-sim run`: every system has experiments of its own.
#[derive(Debug, Subcommand)]
pub enum Run {
    /// Foot-mounted IMU with zero-velocity updates
    Pedestrian(PlainRun),
    /// A robot among ultra-wideband anchors
    Robot(PlainRun),
    /// A drone that finds and follows a user on the ground
    Drone(drone::options::Run),
    /// The longitudinal motion of a fixed-wing aircraft
    Uav(PlainRun),
    /// A GNSS receiver, positioned precisely
    Gnss(PlainRun),
}

/// An experiment without options of its own.
#[derive(Debug, Clone, Default, Args)]
pub struct PlainRun {
    /// Options that all systems share.
    #[command(flatten)]
    pub options: RunOptions,
    /// Where the results go.
    #[command(flatten)]
    pub outputs: Outputs,
}

/// Options of a synthetic experiment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Args)]
pub struct RunOptions {
    /// Repetitions of the experiment [default: as many as take a few seconds]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub trials: Option<u32>,
    /// Seed of all randomness; the same seed gives the same answer
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Number type of the estimator [default: the system's own]
    #[arg(long, value_name = "TYPE")]
    pub scalar: Option<ScalarKind>,
}

/// `host-sim replay`: every system has a log format and options of its own.
#[derive(Debug, Subcommand)]
pub enum Replay {
    /// A walk recorded by a foot-mounted IMU
    Pedestrian(pedestrian::replay::Replay),
    /// Ranges recorded between anchors and a tag
    Robot(robot::replay::Replay),
    /// Path losses that a drone recorded from a user on the ground
    Drone(drone::replay::Replay),
    /// Inputs and outputs that a fixed-wing aircraft recorded
    Uav(uav::replay::Replay),
    /// Observations that a GNSS receiver recorded
    Gnss(gnss::replay::Replay),
}

/// `host-sim calibrate`.
#[derive(Debug, Subcommand)]
pub enum Calibrate {
    /// What each anchor measures too long
    Robot(robot::calibrate::Calibrate),
}

/// Number type in which an estimator computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ScalarKind {
    /// Single precision
    F32,
    /// Double precision
    F64,
    /// Fixed point
    Fixed,
}

/// What makes a shell complete this program's options.
pub fn completions(shell: Shell) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "host-sim", &mut script);
    String::from_utf8_lossy(&script).into_owned()
}

/// Clap's complaint about a wrong command line, folded into one plain sentence.
pub fn sentence(error: &clap::Error) -> String {
    let rendered = error.render().to_string();
    let complaint = rendered.lines().take_while(|line| !line.trim().is_empty());
    let joined = complaint.map(str::trim).collect::<Vec<_>>().join(" ");
    format!("{} (see --help)", joined.trim_start_matches("error: "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_usage_error_is_one_sentence() {
        for arguments in [
            &["host-sim", "fly"][..],
            &["host-sim", "run"],
            &["host-sim", "run", "pedestrian", "--trials", "0"],
            &["host-sim", "replay", "pedestrian"],
            &["host-sim", "replay", "pedestrian", "--log", "a", "--tracker", "best"],
        ] {
            let sentence = sentence(&Cli::try_parse_from(arguments).unwrap_err());
            assert!(!sentence.contains('\n') && !sentence.starts_with("error"), "{sentence}");
        }
    }
}
