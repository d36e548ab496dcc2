//! `host-sim survey robot`: determines the positions of anchors from the ranges between them.

use std::fmt;
use std::path::PathBuf;

use clap::{ArgMatches, Args, Command, FromArgMatches};
use kestirim_import::Options as Reading;
use kestirim_replay::robot::survey::{self, Pair};
use kestirim_replay::robot::{Dimensions, MOST};
use serde::Serialize;

use super::Robot;
use crate::system::{Calibration, System};
use crate::table::{self, Log};
use crate::{Error, output};

/// The command for the survey.
#[derive(Debug, Clone, Copy)]
pub(super) struct Survey;

impl Calibration for Survey {
    fn command(&self) -> Command {
        let about = "Where the anchors are, from the ranges between them";
        Options::augment_args(Command::new(Robot::NAME)).about(about)
    }

    fn run(&self, matches: &ArgMatches) -> Result<(), Error> {
        let options = Options::from_arg_matches(matches);
        options.map_err(|error| Error::Usage(error.to_string()))?.run()
    }
}

/// Options of the command.
#[derive(Debug, Clone, Args)]
struct Options {
    /// The ranges between the anchors, each pair as often as one likes: CSV with columns `anchor_a,anchor_b,range` (m)
    #[arg(long, value_name = "FILE")]
    ranges: PathBuf,
    /// Where to write the anchors, as replay takes them: CSV with columns anchor,x,y,z (m)
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Dimensions: 2 if all anchors are at one height
    #[arg(long, value_enum, default_value = "3")]
    dim: Dimensions,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

impl Options {
    fn run(&self) -> Result<(), Error> {
        output::refuse_overwriting("--out", Some(&self.out), [&self.ranges])?;
        let (names, pairs) = self.read()?;
        let file = |problem: String| Error::File { path: self.ranges.clone(), problem };
        if names.len() > MOST {
            return Err(file(format!("expected at most {MOST} anchors, found {}", names.len())));
        }
        let dimensions = if self.dim == Dimensions::Two { 2 } else { 3 };
        let found = survey::survey(names.len(), &pairs, dimensions);
        let found = found.map_err(|error| file(named(&error, &names)))?;
        let anchors = names.iter().zip(found.places.iter().zip(&found.sigmas));
        let anchors = anchors.map(|(anchor, (&place, &sigmas))| Place {
            anchor: anchor.clone(),
            position_m: place,
            sigmas_m: sigmas,
        });
        let pair = |[one, other]: [usize; 2]| format!("{}-{}", names[one], names[other]);
        let left_out = found.left_out.iter();
        let report = Report {
            system: Robot::NAME,
            anchors: anchors.collect(),
            range_sigma_m: found.range_sigma,
            left_out: left_out.map(|(it, excess)| (pair(it.anchors), *excess)).collect(),
            ambiguous: found.ambiguous.iter().map(|&anchor| names[anchor].clone()).collect(),
        };
        output::write_file(&self.out, |file| {
            let mut table = csv::Writer::from_writer(file);
            table.write_record(["anchor", "x", "y", "z"])?;
            for Place { anchor, position_m, .. } in &report.anchors {
                let place = position_m.iter().map(|metres| format!("{metres:.4}"));
                table.write_record(std::iter::once(anchor.clone()).chain(place))?;
            }
            table.flush()
        })?;
        output::show(&report, self.json)
    }

    /// The names of the anchors in the order of their first occurrence, and the ranges between them.
    fn read(&self) -> Result<(Vec<String>, Vec<Pair>), Error> {
        let (mut names, mut ranges) = (Vec::<String>::new(), Vec::new());
        let options = Reading::default();
        let log = Log { what: "ranges between anchors", usual_step_s: None, options: &options };
        let found = table::read_log(
            &self.ranges,
            &log,
            |header| header.require(["anchor_a", "anchor_b", "range"]),
            |&[one, other, range], row| {
                let metres = row.number("range", range)?;
                let anchors = [one, other].map(|column| {
                    let name = row.text(column);
                    names.iter().position(|known| *known == name).unwrap_or_else(|| {
                        names.push(name.into_owned());
                        names.len() - 1
                    })
                });
                ranges.push((anchors, metres));
                Ok(())
            },
        )?;
        output::warn_of(&self.ranges, &found.warnings);
        Ok((names, survey::pairs(ranges)))
    }
}

/// The error message, with the names of the anchors.
fn named(error: &survey::Unplaced, names: &[String]) -> String {
    match error {
        survey::Unplaced::Loose(anchors) => {
            let names: Vec<_> = anchors.iter().map(|&anchor| names[anchor].as_str()).collect();
            format!(
                "expected ranges that determine every anchor, found too few of {}",
                names.join(", ")
            )
        }
        survey::Unplaced::Flat { dimensions: 3 } => {
            format!("{error}; --dim 2 finds the other two")
        }
        other => other.to_string(),
    }
}

/// The estimated position of an anchor (m).
#[derive(Debug, Clone, Serialize)]
struct Place {
    anchor: String,
    position_m: [f64; 3],
    sigmas_m: [f64; 3],
}

/// The report that the command prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    anchors: Vec<Place>,
    range_sigma_m: Option<f64>,
    /// The pairs that do not fit, and the excess of their ranges (m).
    left_out: Vec<(String, f64)>,
    /// The anchors with more than one possible position.
    ambiguous: Vec<String>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        table.set_header(["anchor", "x", "y", "z", "± x", "± y", "± z"]);
        for Place { anchor, position_m, sigmas_m } in &self.anchors {
            let places = position_m.iter().map(|metres| format!("{metres:.3} m"));
            let sigmas = sigmas_m.iter().map(|metres| format!("{:.1} cm", 100.0 * metres));
            table.add_row(std::iter::once(anchor.clone()).chain(places).chain(sigmas));
        }
        writeln!(f, "{table}")?;
        match self.range_sigma_m {
            Some(sigma) => writeln!(f, "ranges err by {:.1} cm", 100.0 * sigma)?,
            None => writeln!(f, "no range is to spare: ± 10 cm each is assumed")?,
        }
        for (pair, excess) in &self.left_out {
            writeln!(f, "{pair} does not fit: {excess:+.2} m")?;
        }
        if !self.ambiguous.is_empty() {
            writeln!(f, "may as well stand elsewhere: {}", self.ambiguous.join(", "))?;
        }
        write!(f, "the mirror image fits as well: compare with the room")
    }
}
