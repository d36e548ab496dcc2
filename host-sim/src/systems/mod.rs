//! The systems, one folder each.

pub mod drone;
pub mod gnss;
pub mod pedestrian;
pub mod robot;
pub mod uav;

use crate::Error;
use crate::cli::{PlainRun, RunOptions, ScalarKind};
use crate::output;

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

/// Runs the pedestrian's experiment and prints its report.
///
/// # Errors
/// Whatever keeps the experiment from running or its report from being printed.
pub fn run_pedestrian(run: PlainRun) -> Result<(), Error> {
    output::show(&pedestrian::experiment::run(run.options)?, run.json)
}

/// Runs the robot's experiment and prints its report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_robot(run: PlainRun) -> Result<(), Error> {
    output::show(&robot::experiment::run(run.options)?, run.json)
}

/// Runs the drone's experiments, or one cell of them, and prints the report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_drone(run: drone::options::Run) -> Result<(), Error> {
    output::show(&drone::experiment::run(run)?, run.json)
}

/// Runs the UAV's experiments and prints the report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_uav(run: PlainRun) -> Result<(), Error> {
    output::show(&uav::experiment::run(run.options)?, run.json)
}

/// Runs the GNSS receiver's experiment and prints its report.
///
/// # Errors
/// As [`run_pedestrian`].
pub fn run_gnss(run: PlainRun) -> Result<(), Error> {
    output::show(&gnss::experiment::run(run.options)?, run.json)
}

impl System {
    /// Every system, in the order in which they run.
    pub const ALL: [Self; 5] = [Self::Pedestrian, Self::Robot, Self::Drone, Self::Uav, Self::Gnss];

    /// Runs the system on its synthetic streams and prints the report.
    ///
    /// # Errors
    /// As [`run_pedestrian`].
    pub fn run_by_default(self) -> Result<(), Error> {
        let plain = PlainRun { options: RunOptions::default(), json: false };
        match self {
            Self::Pedestrian => run_pedestrian(plain),
            Self::Robot => run_robot(plain),
            Self::Drone => run_drone(drone::options::Run::default()),
            Self::Uav => run_uav(plain),
            Self::Gnss => run_gnss(plain),
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
