//! `host-sim calibrate robot`: determines the range bias of each anchor.

use std::fmt;
use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command, FromArgMatches};
use kestirim_import::Options as Reading;
use kestirim_replay::robot::Anchors;
use serde::Serialize;

use super::Robot;
use super::recording::anchors;
use super::recording::calibration::{self, AnchorCalibration, Residuals};
use super::recording::{points, ranges};
use crate::system::{Calibration, System};
use crate::{Error, output};

/// The command for the calibration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Calibrate;

impl Calibration for Calibrate {
    fn command(&self) -> Command {
        Options::augment_args(Command::new(Robot::NAME)).about("What each anchor measures too long")
    }

    fn run(&self, matches: &ArgMatches) -> Result<(), Error> {
        let options = Options::from_arg_matches(matches);
        options.map_err(|error| Error::Usage(error.to_string()))?.run()
    }
}

/// Options of the command.
#[derive(Debug, Clone, Args)]
struct Options {
    /// Where the anchors are: CSV with columns anchor,x,y,z (m)
    #[arg(long, value_name = "FILE")]
    anchors: PathBuf,
    /// The ranges: CSV with columns t,anchor,range, or with --points point,k,anchor,range (s, m)
    #[arg(long, value_name = "FILE")]
    log: PathBuf,
    /// Where the tag was put down: CSV with columns point,x,y,z
    #[arg(long, value_name = "FILE", required_unless_present = "truth")]
    points: Option<PathBuf>,
    /// Where the tag moved: CSV with columns t,x,y,z
    #[arg(long, value_name = "FILE", conflicts_with = "points")]
    truth: Option<PathBuf>,
    /// Where to write the calibration
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

impl Options {
    fn run(&self) -> Result<(), Error> {
        let inputs =
            [Some(&self.anchors), Some(&self.log), self.points.as_ref(), self.truth.as_ref()];
        output::refuse_overwriting("--out", Some(&self.out), inputs.into_iter().flatten())?;
        let calibrations = self.write()?;
        output::show(&Report { system: Robot::NAME, anchors: calibrations }, self.json)
    }

    fn write(&self) -> Result<Vec<AnchorCalibration>, Error> {
        let anchors = anchors::read(&self.anchors)?;
        let residuals = self.residuals(&anchors)?;
        if residuals.is_doubtful() {
            let problem = "expected ranges from -1 to 200 m, found most of them outside: are they in another unit?".to_owned();
            return Err(Error::File { path: self.log.clone(), problem });
        }
        let calibrations = residuals.calibrations(&anchors);
        if calibrations.is_empty() {
            return Err(Error::File {
                path: self.log.clone(),
                problem: "expected ranges from places that are known, found none".to_owned(),
            });
        }
        output::warn_of(&self.log, &doubts(&calibrations));
        calibration::write(&self.out, &calibrations)?;
        Ok(calibrations)
    }

    fn residuals(&self, anchors: &Anchors) -> Result<Residuals, Error> {
        let mut residuals = Residuals::new(anchors);
        if let Some(path) = &self.truth {
            let truth = points::read_course(path, ["x", "y", "z"])?;
            let (log, found) = ranges::read_moving(&self.log, anchors, &Reading::default())?;
            output::warn_of(&self.log, &found.warnings);
            for row in log.rows {
                if let (Some(range), Some(place)) = (row.range, truth.within(row.time_us)) {
                    residuals.add(anchors, row.anchor, range, place);
                }
            }
        }
        if let Some(path) = &self.points {
            let (logs, found) = ranges::read_static(&self.log, anchors, &Reading::default())?;
            output::warn_of(&self.log, &found.warnings);
            for point in points::read_points(path)? {
                let (Some([x, y]), Some(z)) = (point.plane, point.height) else {
                    return Err(Error::File {
                        path: path.clone(),
                        problem: "expected columns x, y and z".to_owned(),
                    });
                };
                for row in logs.get(&point.name).iter().flat_map(|log| &log.rows) {
                    if let Some(range) = row.range {
                        residuals.add(anchors, row.anchor, range, [x, y, z]);
                    }
                }
            }
        }
        Ok(residuals)
    }
}

/// The bias and the standard deviation of ranges (m) beyond which a calibration is doubtful: those of radios in sight of
/// each other are below 0.5 and 0.15 m.
const LARGEST_BIAS_M: f64 = 2.0;
const LARGEST_SIGMA_M: f64 = 0.3;

/// A warning about anchors whose calibration may do more harm than good.
fn doubts(calibrations: &[AnchorCalibration]) -> Vec<String> {
    let is_doubtful = |anchor: &&AnchorCalibration| {
        anchor.bias_m.abs() > LARGEST_BIAS_M || anchor.sigma_m > LARGEST_SIGMA_M
    };
    let names: Vec<_> =
        calibrations.iter().filter(is_doubtful).map(|it| it.anchor.as_str()).collect();
    if names.is_empty() {
        return Vec::new();
    }
    let names = names.join(", ");
    vec![format!(
        "ranges of {names} are off by more than {LARGEST_BIAS_M} m or scatter by more than {LARGEST_SIGMA_M} m: links through walls, \
         anchors in each other's place, another unit, or clocks that differ; their calibration may do more harm than good"
    )]
}

/// Writes the calibration from a folder whose recording has a known truth.
pub(super) fn from_truth(folder: &Path, to: &Path) -> Result<(), Error> {
    let [anchors, log, truth] =
        ["anchors.csv", "ranges.csv", "truth.csv"].map(|it| folder.join(it));
    let options = Options {
        anchors,
        log,
        points: None,
        truth: Some(truth),
        out: to.to_path_buf(),
        json: false,
    };
    options.write().map(drop)
}

/// The report that the command prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    anchors: Vec<AnchorCalibration>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        table.set_header(["anchor", "bias", "spread", "ranges"]);
        for anchor in &self.anchors {
            table.add_row([
                anchor.anchor.clone(),
                format!("{:+.1} cm", 100.0 * anchor.bias_m),
                format!("{:.1} cm", 100.0 * anchor.sigma_m),
                anchor.ranges.to_string(),
            ]);
        }
        table.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_that_no_radio_measures_so_are_named() {
        let of = |anchor: &str, bias_m, sigma_m| AnchorCalibration {
            anchor: anchor.to_owned(),
            bias_m,
            sigma_m,
            ranges: 100,
        };
        assert!(doubts(&[of("A0", 0.4, 0.1), of("A1", -0.2, 0.29)]).is_empty());
        let told = doubts(&[of("A0", -2.1, 0.1), of("A1", 0.1, 0.1), of("A2", 0.1, 0.31)]);
        assert!(told.len() == 1 && told[0].starts_with("ranges of A0, A2 are off"), "{told:?}");
    }
}
