//! `host-sim replay drone`: a recorded flight becomes a place.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::scenario::EnvironmentKind;
use super::search::Estimate;
use super::survey::Survey;
use crate::metrics::distance;
use crate::stream::Stream;
use crate::{Error, mcap, output};

/// Errors are told after each of these, s.
const MINUTE_S: f64 = 60.0;

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Replay {
    /// The flight: CSV with columns t,x,y,h and `path_loss_db` or `rssi_db` (s, m, dB)
    #[arg(long, value_name = "FILE")]
    pub log: PathBuf,
    /// Where the user really is: CSV with columns x,y and one line (m); serves accuracy alone
    #[arg(long, value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// What is built on the ground: the thesis' channel at 2 GHz
    #[arg(long, value_name = "NAME", value_enum, conflicts_with = "free_space")]
    pub environment: Option<EnvironmentKind>,
    /// Nothing is built on the ground, and what antennas there are is unknown: the default
    #[arg(long)]
    pub free_space: bool,
    /// Where the user can be: CSV with columns x,y, the corners of a polygon (m)
    #[arg(long, value_name = "FILE")]
    pub area: Option<PathBuf>,
    /// Write t,x,y,sd of each measurement to this file
    #[arg(long, value_name = "OUT.csv")]
    pub track: Option<PathBuf>,
    /// Write measurements, estimates and truth to this MCAP file, for viewers such as Foxglove and Rerun
    #[arg(long, value_name = "OUT.mcap")]
    pub mcap: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

impl Replay {
    /// Reads, locates, compares, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is printed.
    pub fn run(&self) -> Result<(), Error> {
        let report = self.report()?;
        output::warn_of(&self.log, &report.warnings);
        output::show(&report, self.json)
    }

    /// What [`Replay::run`] prints.
    ///
    /// # Errors
    /// As there.
    pub fn report(&self) -> Result<Report, Error> {
        let inputs =
            [Some(&self.log), self.truth.as_ref(), self.area.as_ref()].into_iter().flatten();
        let outputs = [("--track", self.track.as_deref()), ("--mcap", self.mcap.as_deref())];
        output::refuse_clashes(&outputs, &inputs)?;
        let survey =
            Survey::read(&self.log, self.truth.as_deref(), self.area.as_deref(), self.environment)?;
        // What comes in between takes as long as the end, each time.
        let only_last = survey.truth.is_none() && self.track.is_none() && self.mcap.is_none();
        let estimates = survey.find(&survey.search(only_last));
        let mut warnings = survey.warnings.clone();
        let every = self.environment.is_some() || !only_last;
        if every && estimates.len() < survey.flight.stops.len() {
            warnings.push("some measurements are explained by no place: left out".to_owned());
        }
        let Some(last) = estimates.last() else { return Err(survey.nowhere()) };
        if let Some(path) = &self.track {
            write_track(path, &estimates)?;
        }
        if let Some(path) = &self.mcap {
            mcap::write(path, &streams(&survey, &estimates))?;
        }
        Ok(Report {
            system: "drone",
            measurements: survey.flight.stops.len(),
            estimate: Place { x: last.place[0], y: last.place[1] },
            sd_m: last.sd_m,
            level_db: last.level_db,
            level_name: if self.environment.is_some() {
                "level of the transmitter"
            } else {
                "level at one metre"
            },
            warnings,
            accuracy: survey.truth.map(|truth| Accuracy::of(&estimates, truth)),
        })
    }
}

/// Measurements, estimates and, where it is known, the truth.
fn streams(survey: &Survey, estimates: &[Estimate]) -> Vec<Stream> {
    let stops = &survey.flight.stops;
    let measured = stops.iter().map(|stop| {
        let [x, y] = stop.place;
        (stop.t, vec![x, y, stop.height, stop.loss])
    });
    let found = estimates.iter().map(|found| {
        let [x, y] = found.place;
        (found.t, vec![x, y, found.sd_m])
    });
    let columns = ["x_m", "y_m", "z_m", "loss_db"];
    let mut streams = vec![
        Stream::new("/drone/measurements", &columns, measured.collect()),
        Stream::new("/drone/estimate", &["x_m", "y_m", "sd_m"], found.collect()),
    ];
    streams.extend(survey.truth.map(|truth| {
        let rows = stops.iter().map(|stop| (stop.t, truth.to_vec())).collect();
        Stream::new("/drone/truth", &["x_m", "y_m"], rows)
    }));
    streams
}

fn write_track(path: &Path, estimates: &[Estimate]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["t", "x", "y", "sd"])?;
        for Estimate { t, place: [x, y], sd_m, .. } in estimates {
            table.write_record([t, x, y, sd_m].map(|number| format!("{number:.3}")))?;
        }
        table.flush()
    })
}

/// What the command prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Always `drone`.
    pub system: &'static str,
    /// How many were used.
    pub measurements: usize,
    /// Where the user is.
    pub estimate: Place,
    /// Root mean square distance from the estimate that the filter expects, m.
    pub sd_m: f64,
    /// Where the level was not known, what the transmitter sends, dB (received level = this − path loss); over
    /// open ground, where no frequency is known either, what is received at one metre.
    pub level_db: Option<f64>,
    #[serde(skip)]
    level_name: &'static str,
    /// What a reader should know.
    pub warnings: Vec<String>,
    /// How far that is from the truth, if it is known.
    pub accuracy: Option<Accuracy>,
}

/// A place, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Place {
    /// As x in the log.
    pub x: f64,
    /// As y in the log.
    pub y: f64,
}

/// How good an estimate is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Distance of the last estimate from the truth, m.
    pub error_m: f64,
    /// The same after each minute since the first measurement.
    pub error_after_s: Vec<ErrorAfter>,
    /// Whether the last 90 % region holds the truth.
    pub in_90_percent_region: Option<bool>,
}

/// An error at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorAfter {
    /// Time since the first measurement, s.
    pub s: f64,
    /// Distance of the estimate from the truth, m.
    pub error_m: f64,
}

impl Accuracy {
    fn of(estimates: &[Estimate], truth: [f64; 2]) -> Self {
        let error = |estimate: &Estimate| distance(estimate.place, truth);
        let begin = estimates.first().map_or(0.0, |first| first.t);
        let end = estimates.last().map_or(0.0, |last| last.t);
        let minutes = ((end - begin) / MINUTE_S).ceil().clamp(1.0, 1000.0) as u32;
        let error_after_s = (1..=minutes)
            .filter_map(|minute| {
                let s = f64::from(minute) * MINUTE_S;
                let last = estimates.iter().rev().find(|estimate| estimate.t - begin <= s)?;
                Some(ErrorAfter { s, error_m: error(last) })
            })
            .collect();
        Self {
            error_m: estimates.last().map_or(f64::NAN, error),
            error_after_s,
            in_90_percent_region: estimates.last().and_then(|last| last.covered),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        row("measurements", self.measurements.to_string());
        row("place", format!("{:.1} m, {:.1} m", self.estimate.x, self.estimate.y));
        row("standard deviation", format!("{:.1} m", self.sd_m));
        if let Some(level) = self.level_db {
            row(self.level_name, format!("{level:.1} dB"));
        }
        if let Some(accuracy) = &self.accuracy {
            row("error", format!("{:.1} m", accuracy.error_m));
            for ErrorAfter { s, error_m } in &accuracy.error_after_s {
                row(&format!("error after {s} s"), format!("{error_m:.1} m"));
            }
            if let Some(inside) = accuracy.in_90_percent_region {
                row("in the 90 % region", if inside { "yes" } else { "no" }.to_owned());
            }
        }
        table.fmt(f)
    }
}
