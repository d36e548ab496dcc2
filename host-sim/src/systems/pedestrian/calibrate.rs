//! `host-sim calibrate pedestrian`: determines the errors of the IMU from a log in which it is held in several
//! positions.

mod found;
mod watched;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use kestirim_imu_calibration::{AccelerometerModel, Error as Refused, GyroscopeModel, Side};
use kestirim_replay::pedestrian;
use serde::Serialize;

use self::found::{Found, HOLD_S, Refusal, SHORTEST_S};
use self::watched::Watching;
use super::Pedestrian;
use super::recording::calibration::{self, Parameter};
use super::recording::log;
use crate::system::{Calibration, Finding, Plan, Reading, System};
use crate::{Error, output};

/// The command for the calibration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Calibrate;

impl Calibration for Calibrate {
    fn command(&self) -> Command {
        let file = |name: &'static str, help: &'static str| {
            let arg = Arg::new(name).long(name).value_name("FILE").help(help);
            arg.required(true).value_parser(value_parser!(PathBuf))
        };
        Command::new(Pedestrian::NAME)
            .about("What the IMU measures wrong, held still in six to twelve positions")
            .arg(file("log", "The log of the positions: of any device, as for replay"))
            .arg(file("out", "Where to write the calibration: CSV parameter,value,sigma,unit"))
            .args(Reading::arguments())
            .arg(
                Arg::new("json")
                    .long("json")
                    .help("Print one JSON object instead of a table")
                    .action(ArgAction::SetTrue),
            )
    }

    fn run(&self, matches: &ArgMatches) -> Result<(), Error> {
        let path = |name: &str| {
            let path = matches.get_one::<PathBuf>(name);
            path.ok_or_else(|| Error::Usage(format!("a file is needed: --{name}")))
        };
        let (from, to) = (path("log")?, path("out")?);
        output::refuse_overwriting("--out", Some(to), [from])?;
        let reading = Reading::matched(matches)?;
        let log = log::read(from, reading.options())?;
        let found = found::find(&log.samples)
            .map_err(|refusal| Error::File { path: from.clone(), problem: sentence(&refusal) })?;
        let parameters = calibration::parameters(&found.calibration, found.sigmas);
        calibration::write(to, &parameters)?;
        let faults = pedestrian::check(&log.samples).into_iter().filter(Finding::is_fault);
        let mut warnings = log.warnings;
        warnings.extend(faults.map(|finding| finding.sentence()));
        warnings.extend((found.clipped > 0).then(|| {
            let all = found.clipped + found.turns;
            format!(
                "in {} of {all} turns an axis reached the end of its range: left out; turn slower",
                found.clipped
            )
        }));
        output::warn_of(from, &warnings);
        let report = Report::new(&found, parameters, log.import, warnings);
        output::show(&report, matches.get_flag("json"))
    }

    fn watch(&self, to: &Path) -> Option<Arc<dyn Plan>> {
        Some(Arc::new(Watching { to: to.to_path_buf() }))
    }
}

/// Explains why there is no calibration, and what to do.
fn sentence(Refusal { error, poses, missing }: &Refusal) -> String {
    let next = in_words(missing);
    let expected = format!("positions held still for {SHORTEST_S:.0} s or more");
    match error {
        Refused::TooFew { needed, .. } => {
            let next = next.unwrap_or_else(|| "turn the sensor onto its edges".to_owned());
            format!("expected at least {needed} {expected}, found {poses}: {next}")
        }
        Refused::NotObservable => {
            let next =
                next.unwrap_or_else(|| "turn the sensor onto its sides and edges".to_owned());
            format!(
                "expected {expected} on all sides, found {poses} that are too much alike: {next}"
            )
        }
        _ => format!(
            "expected {expected} in which an accelerometer shows gravity, found {poses} that no scale and offset explain"
        ),
    }
}

/// Instructions for the sides that were not shown.
fn in_words(missing: &[Side]) -> Option<String> {
    let side = |(place, side): (usize, &Side)| {
        let axis = ["x", "y", "z"].get(usize::from(side.axis)).unwrap_or(&"z");
        let points = if place == 0 { " points" } else { "" };
        format!("{axis}{points} {}", if side.is_up { "up" } else { "down" })
    };
    let sides: Vec<_> = missing.iter().enumerate().map(side).collect();
    let each = if sides.len() > 1 { " each time" } else { "" };
    let sides = sides.join(", ");
    (!missing.is_empty())
        .then(|| format!("turn the sensor so that {sides}, and hold it {HOLD_S:.0} s{each}"))
}

fn edges() -> String {
    format!(
        "for the accelerometer's misalignments, hold the sensor {HOLD_S:.0} s on each of six edges as well"
    )
}

fn turns() -> String {
    "for the gyroscope's scales and misalignments, turn the sensor from position to position about each of its axes".to_owned()
}

/// The report that the command prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    poses: usize,
    turns: usize,
    accelerometer: &'static str,
    gyroscope: &'static str,
    residual_m_s2: f64,
    turn_residual_rad: Option<f64>,
    parameters: Vec<Parameter>,
    advice: Vec<String>,
    import: Vec<String>,
    warnings: Vec<String>,
    firmware: String,
}

impl Report {
    fn new(
        found: &Found,
        parameters: Vec<Parameter>,
        import: Vec<String>,
        warnings: Vec<String>,
    ) -> Self {
        let mut advice: Vec<_> = in_words(&found.missing).into_iter().collect();
        if found.accelerometer != AccelerometerModel::Full {
            advice.push(edges());
        }
        if found.gyroscope != Some(GyroscopeModel::Full) {
            advice.push(turns());
        }
        Self {
            system: Pedestrian::NAME,
            poses: found.poses,
            turns: found.turns,
            accelerometer: match found.accelerometer {
                AccelerometerModel::Full => "offset, scale and misalignment",
                _ => "offset and scale",
            },
            gyroscope: match found.gyroscope {
                Some(GyroscopeModel::Full) => "bias, scale and misalignment",
                Some(_) => "bias and scale of the axes it was turned about",
                None => "bias",
            },
            residual_m_s2: found.residual,
            turn_residual_rad: found.astray,
            parameters,
            advice,
            import,
            warnings,
            firmware: calibration::firmware(&found.calibration),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        for said in &self.import {
            table.add_row(["log", said]);
        }
        table.add_row(["positions", &self.poses.to_string()]);
        table.add_row(["turns between them", &self.turns.to_string()]);
        let left = format!("{}, {:.3} m/s² left", self.accelerometer, self.residual_m_s2);
        table.add_row(["accelerometer", &left]);
        let left = self.turn_residual_rad.map(|left| format!(", {:.2}° left", left.to_degrees()));
        table.add_row(["gyroscope", &format!("{}{}", self.gyroscope, left.unwrap_or_default())]);
        for advice in &self.advice {
            table.add_row(["what is missing", advice]);
        }
        writeln!(f, "{table}")?;
        let mut table = output::table();
        table.set_header(["parameter", "value", "σ", "unit"]);
        for Parameter { name, value, sigma, unit } in &self.parameters {
            let sigma = sigma.map_or_else(|| "not looked for".to_owned(), |it| format!("{it:.5}"));
            table.add_row([name.clone(), format!("{value:+.5}"), sigma, (*unit).to_owned()]);
        }
        write!(f, "{table}\n\n{}", self.firmware)
    }
}
