//! The systems, one folder each.

pub mod drone;
pub mod gnss;
pub mod pedestrian;
pub mod robot;
pub mod uav;

use std::fmt::Display;
use std::path::Path;

use serde::Serialize;

use crate::cli::{PlainRun, RunOptions, ScalarKind};
use crate::explore::Source;
use crate::outputs::{self, Outputs};
use crate::report::{self, Chapter};
use crate::{Error, output};

/// A system that can be run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum System {
    /// Foot-mounted IMU with zero-velocity updates.
    Pedestrian,
    /// A robot among ultra-wideband anchors.
    Robot,
    /// A drone that finds and follows a user on the ground.
    Drone,
    /// The longitudinal motion of a fixed-wing aircraft.
    Uav,
    /// A GNSS receiver, positioned precisely.
    Gnss,
}

/// What the explorer can open, the default first.
pub static SOURCES: [Source; 5] = [
    pedestrian::explorer::SOURCE,
    robot::explorer::SOURCE,
    drone::explorer::SOURCE,
    uav::explorer::SOURCE,
    gnss::explorer::SOURCE,
];

/// Runs the pedestrian's experiment and prints its report.
///
/// # Errors
/// Whatever keeps the experiment from running or its report from being printed or written.
pub fn run_pedestrian(run: &PlainRun) -> Result<(), Error> {
    deliver(|| pedestrian::experiment::run(run.options), pedestrian::chapter::chapter, &run.outputs)
}

/// Runs the robot's experiment and prints its report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_robot(run: &PlainRun) -> Result<(), Error> {
    deliver(|| robot::experiment::run(run.options), robot::chapter::chapter, &run.outputs)
}

/// Runs the drone's experiments, or one cell of them, and prints the report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_drone(run: &drone::options::Run) -> Result<(), Error> {
    deliver(|| drone::experiment::run(run), drone::chapter::chapter, &run.outputs)
}

/// Runs the UAV's experiments and prints the report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_uav(run: &PlainRun) -> Result<(), Error> {
    deliver(|| uav::experiment::run(run.options), uav::chapter::chapter, &run.outputs)
}

/// Runs the GNSS receiver's experiment and prints its report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_gnss(run: &PlainRun) -> Result<(), Error> {
    deliver(|| gnss::experiment::run(run.options), gnss::chapter::chapter, &run.outputs)
}

/// Runs an experiment, writes what was asked for, and prints the rest.
fn deliver<R: Serialize + Display>(
    run: impl FnOnce() -> Result<R, Error>,
    chapter: impl FnOnce(&R) -> Result<Chapter, Error>,
    outputs: &Outputs,
) -> Result<(), Error> {
    outputs.check()?;
    let report = run()?;
    if outputs.any_file() {
        outputs.write(chapter(&report)?)?;
    }
    output::show(&report, outputs.json)
}

/// Runs every system on its synthetic streams, prints the few numbers that matter most, and writes the
/// report into `folder`.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn report(folder: &Path) -> Result<(), Error> {
    let mut chapters = Vec::new();
    for system in System::ALL {
        let chapter = system.chapter()?;
        output::print(&format!("{}\n", chapter.summary))?;
        chapters.push(chapter);
    }
    outputs::say_where(&report::write(folder, &chapters)?);
    Ok(())
}

impl System {
    /// Every system, in the order in which they run.
    pub const ALL: [Self; 5] = [Self::Pedestrian, Self::Robot, Self::Drone, Self::Uav, Self::Gnss];

    /// Runs the system on its synthetic streams.
    fn chapter(self) -> Result<Chapter, Error> {
        let options = RunOptions::default();
        match self {
            Self::Pedestrian => {
                pedestrian::chapter::chapter(&pedestrian::experiment::run(options)?)
            }
            Self::Robot => robot::chapter::chapter(&robot::experiment::run(options)?),
            Self::Drone => {
                drone::chapter::chapter(&drone::experiment::run(&drone::options::Run::default())?)
            }
            Self::Uav => uav::chapter::chapter(&uav::experiment::run(options)?),
            Self::Gnss => gnss::chapter::chapter(&gnss::experiment::run(options)?),
        }
    }

    /// What it is, which scenarios it runs and which logs it reads.
    fn description(self) -> &'static str {
        match self {
            Self::Pedestrian => pedestrian::DESCRIPTION,
            Self::Robot => robot::DESCRIPTION,
            Self::Drone => drone::DESCRIPTION,
            Self::Uav => uav::DESCRIPTION,
            Self::Gnss => gnss::DESCRIPTION,
        }
    }
}

/// The text of `host-sim list`.
pub fn list() -> String {
    System::ALL.map(System::description).join("\n")
}

/// The number type to compute in: the one asked for, or else the `default`.
///
/// # Errors
/// [`Error::Usage`] if the system does not support what was asked for.
pub fn choose_scalar(
    system: &str,
    asked: Option<ScalarKind>,
    supported: &[ScalarKind],
    default: ScalarKind,
) -> Result<ScalarKind, Error> {
    let chosen = asked.unwrap_or(default);
    if supported.contains(&chosen) {
        return Ok(chosen);
    }
    let names: Vec<_> = supported.iter().map(|kind| format!("{kind:?}").to_lowercase()).collect();
    let chosen = format!("{chosen:?}").to_lowercase();
    let names = names.join(" or ");
    Err(Error::Usage(format!("{system} computes in {names}, not in {chosen} (--scalar)")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unsupported_scalar_is_refused_with_a_sentence() {
        let floats = [ScalarKind::F32, ScalarKind::F64];
        let choose = |asked| choose_scalar("robot", asked, &floats, ScalarKind::F32);
        assert_eq!(choose(None).unwrap(), ScalarKind::F32);
        assert_eq!(choose(Some(ScalarKind::F64)).unwrap(), ScalarKind::F64);
        let sentence = choose(Some(ScalarKind::Fixed)).unwrap_err().to_string();
        assert_eq!(sentence, "robot computes in f32 or f64, not in fixed (--scalar)");
    }
}
