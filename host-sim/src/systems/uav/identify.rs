//! `host-sim identify uav`: determines the linear model of an aircraft from logs of its manoeuvres.

use std::fmt;
use std::path::{Path, PathBuf};

use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use kestirim_uav_identification::{Airplane, Flight, Identified, identify};
use serde::Serialize;

use super::Uav;
use super::recording::log;
use crate::system::{Calibration, Reading, System};
use crate::table::Found;
use crate::{Error, output};

/// The columns used if a log has them.
const COLUMNS: [&str; 9] = ["alpha", "q", "V", "theta", "az", "ax", "qbar", "climb", "V_ground"];
/// The options needed for coefficients, with their help.
const SIZE: [(&str, &str); 4] = [
    ("mass", "Mass, kg; with the other three, coefficients are told as well"),
    ("inertia", "Moment of inertia about the wings' axis, kg m²"),
    ("area", "Wing area, m²"),
    ("chord", "Mean chord, m"),
];
/// The default air density: the standard atmosphere at sea level, kg/m³.
const DENSITY: &str = "1.225";

/// The command for the identification.
#[derive(Debug, Clone, Copy)]
pub(super) struct Identify;

impl Calibration for Identify {
    fn command(&self) -> Command {
        let file = |name: &'static str, help: &'static str| {
            let arg = Arg::new(name).long(name).value_name("FILE").help(help);
            arg.required(true).value_parser(value_parser!(PathBuf))
        };
        let number = |(name, help): (&'static str, &'static str)| {
            let others = SIZE.map(|(other, _)| other).into_iter().filter(move |it| *it != name);
            let arg = Arg::new(name).long(name).value_name("NUMBER").help(help);
            arg.value_parser(value_parser!(f64)).requires_all(others)
        };
        let density =
            Arg::new("density").long("density").value_name("NUMBER").default_value(DENSITY);
        Command::new(Uav::NAME)
            .about("Derivatives, trim and noise from flights with a 3-2-1-1 of the elevator")
            .arg(
                file("log", "Flight, as for replay, with q, V, theta and alpha or az or both; ax tells more. May be given again")
                    .action(ArgAction::Append),
            )
            .arg(file("out", "Where to write the model: JSON, as replay takes it with --model"))
            .args(SIZE.map(number))
            .arg(
                density
                    .help("Density of the air, kg/m³, for a log without qbar")
                    .value_parser(value_parser!(f64)),
            )
            .args(Reading::arguments())
            .arg(
                Arg::new("json")
                    .long("json")
                    .help("Print one JSON object instead of tables")
                    .action(ArgAction::SetTrue),
            )
    }

    fn run(&self, matches: &ArgMatches) -> Result<(), Error> {
        let logs: Vec<_> = matches.get_many::<PathBuf>("log").into_iter().flatten().collect();
        let out = matches.get_one::<PathBuf>("out").map(PathBuf::as_path);
        output::refuse_overwriting("--out", out, logs.iter().copied())?;
        out.map_or(Ok(()), output::refuse_unwritable)?;
        let reading = Reading::matched(matches)?;
        let (mut flights, mut said) = (Vec::new(), Found::default());
        for path in &logs {
            let (flight, found) = read(path, &reading)?;
            output::warn_of(path, &found.warnings);
            said.import.extend(found.import);
            said.warnings.extend(found.warnings);
            flights.push(flight);
        }
        let airplane = airplane(matches);
        said.warnings.extend(density(matches, airplane.as_ref(), &flights));
        let found = identify(&flights, airplane.as_ref()).map_err(|error| {
            let path = logs.first().copied().cloned().unwrap_or_default();
            Error::File { path, problem: error.to_string() }
        })?;
        if let Some(out) = out {
            let model = serde_json::to_string_pretty(&found.model);
            let model = model.map_err(|error| Error::Stdout(error.into()))?;
            output::write_file(out, |file| writeln!(file, "{model}"))?;
        }
        let Found { import, warnings } = said;
        let report = Report { system: Uav::NAME, notes: found.notes(), found, import, warnings };
        output::show(&report, matches.get_flag("json"))
    }
}

/// Reads a flight for the identification.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn flight(path: &Path) -> Result<Flight, Error> {
    Ok(read(path, &Reading::default())?.0)
}

fn airplane(matches: &ArgMatches) -> Option<Airplane> {
    let number = |name: &str| matches.get_one::<f64>(name).copied();
    let [mass, inertia, area, chord] = SIZE.map(|(name, _)| number(name));
    let (mass, inertia, area, chord) = (mass?, inertia?, area?, chord?);
    Some(Airplane { mass, inertia, area, chord, density: number("density")? })
}

/// Warns about the choice of the air density, where there is more than one possibility.
fn density(
    matches: &ArgMatches,
    airplane: Option<&Airplane>,
    flights: &[Flight],
) -> Option<String> {
    let is_said = matches.value_source("density") == Some(ValueSource::CommandLine);
    let has_pressure = |it: &Flight| it.columns.iter().any(|(name, _)| name == "qbar");
    let is_logged = flights.iter().all(has_pressure);
    match (airplane, is_said) {
        (None, true) => {
            Some("--density is used for coefficients alone: --mass and the others are missing")
        }
        (Some(_), true) if is_logged => Some("--density is not used: the log has qbar"),
        (Some(_), false) if !is_logged => {
            Some("the air's density is taken for 1.225 kg/m³: --density says another")
        }
        _ => None,
    }
    .map(|said| {
        output::warn(&format!("warning: {said}"));
        said.to_owned()
    })
}

fn read(path: &Path, reading: &Reading) -> Result<(Flight, Found), Error> {
    let (log, found) = log::read(path, &COLUMNS, reading.tables()?)?;
    let column = |(place, output): (usize, &usize)| {
        let values = log.samples.iter().map(|sample| sample.measured[place]);
        (COLUMNS[*output].to_owned(), values.collect())
    };
    let first = log.samples.first().map_or(0, |sample| sample.t_us);
    let flight = Flight {
        times: log.samples.iter().map(|sample| (sample.t_us - first) as f64 / 1e6).collect(),
        inputs: log.samples.iter().map(|sample| sample.input).collect(),
        columns: log.outputs.iter().enumerate().map(column).collect(),
    };
    Ok((flight, found))
}

/// The report that the command prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    #[serde(flatten)]
    found: Identified,
    notes: Vec<String>,
    import: Vec<String>,
    warnings: Vec<String>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.import.iter().try_for_each(|said| writeln!(f, "log: {said}"))?;
        write!(f, "{}", self.found)
    }
}
