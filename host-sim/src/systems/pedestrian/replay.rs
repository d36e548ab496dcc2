//! `host-sim replay pedestrian`: a recorded walk becomes a path.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::accuracy::Accuracy;
use super::options::{
    DetectorKind, Options, SensorClass, TrackerKind, parse_contact_height, parse_detector,
};
use super::recording::Recording;
use super::run::{self, Walk};
use super::streams::streams;
use super::trace::trace;
use super::track::TrackPoint;
use super::{log, options};
use crate::cli::ScalarKind;
use crate::systems::choose_scalar;
use crate::{Error, mcap, output};

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Replay {
    /// The recorded walk: CSV or Razor text (see `host-sim list`)
    #[arg(long, value_name = "FILE")]
    log: PathBuf,
    /// Measured footprints: CSV with columns t,x,y; replaces a truth that the log carries
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Average the log down to this rate first
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Architecture of the tracker
    #[arg(long, value_enum, default_value_t)]
    tracker: TrackerKind,
    /// How stance is recognised: adaptive, magnitude, variance, angular-rate or shoe; the
    /// threshold of magnitude is in g, those of the others in SI
    #[arg(long, value_name = "NAME[:THRESHOLD]", value_parser = parse_detector, default_value = "adaptive")]
    detector: DetectorKind,
    /// Class of the sensor
    #[arg(long, value_enum, default_value_t)]
    sensor: SensorClass,
    /// Height of the sensor above the ball of the foot, about which the foot rolls in stance; 0 takes
    /// it for motionless [default: 0.07, and 0 with the detector magnitude, as in the paper]
    #[arg(long, value_name = "METRES", value_parser = parse_contact_height)]
    contact_height: Option<f64>,
    /// Look only backwards, as firmware must
    #[arg(long)]
    causal: bool,
    /// Number type of the tracker [default: f32]
    #[arg(long, value_name = "TYPE")]
    scalar: Option<ScalarKind>,
    /// Write t,x,y,z of every (averaged) sample to this file
    #[arg(long, value_name = "OUT.csv")]
    track: Option<PathBuf>,
    /// Write sensor, estimate and truth as MCAP, for Foxglove and Rerun
    #[arg(long, value_name = "OUT.mcap")]
    mcap: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

impl Replay {
    /// Reads, tracks, compares, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is printed.
    pub fn run(&self) -> Result<(), Error> {
        let report = self.report()?;
        output::warn_of(&self.log, &report.warnings);
        output::show(&report, self.json)
    }

    fn report(&self) -> Result<Report, Error> {
        let options = self.options()?;
        let inputs = [Some(&self.log), self.truth.as_ref()].into_iter().flatten();
        let outputs = [("--track", self.track.as_deref()), ("--mcap", self.mcap.as_deref())];
        output::refuse_clashes(&outputs, &inputs)?;
        let recorded = Recording::read(&self.log, self.truth.as_deref())?;
        let recording = match self.rate {
            Some(rate_hz) => recorded.at_rate(rate_hz)?,
            None => recorded,
        };
        let walk = self.walk(&recording, &options)?;
        let accuracy = recording.accuracy(&walk);
        if let Some(path) = &self.track {
            write_track(path, &walk.track)?;
        }
        Ok(Report::new(&recording.log, walk, accuracy))
    }

    /// Tracks the walk; its moments are kept only where they are asked for.
    fn walk(&self, recording: &Recording, options: &Options) -> Result<Walk, Error> {
        let refused = |source| Error::Walk { path: self.log.clone(), source };
        let samples = &recording.log.samples;
        let Some(path) = &self.mcap else { return run::walk(samples, options).map_err(refused) };
        let trace = trace(samples, options).map_err(refused)?;
        mcap::write(path, &streams(samples, &trace, &recording.truth()))?;
        Ok(trace.walk)
    }

    fn options(&self) -> Result<Options, Error> {
        let scalar =
            choose_scalar("pedestrian", self.scalar, &options::SCALARS, Options::default().scalar)?;
        Ok(Options {
            tracker: self.tracker,
            detector: self.detector,
            sensor: self.sensor,
            contact_height_m: self.contact_height,
            causal: self.causal,
            scalar,
        })
    }
}

fn write_track(path: &Path, track: &[TrackPoint]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["t", "x", "y", "z"])?;
        for point in track {
            let time = format!("{}.{:06}", point.time_us / 1_000_000, point.time_us % 1_000_000);
            let [x, y, z] = point.position.map(|metres| format!("{metres:.6}"));
            table.write_record([time, x, y, z])?;
        }
        table.flush()
    })
}

/// What the command prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    samples: usize,
    duration_s: f64,
    path_length_m: f64,
    closure_m: f64,
    strides: Vec<StrideReport>,
    warnings: Vec<String>,
    accuracy: Option<Accuracy>,
}

#[derive(Debug, Clone, Serialize)]
struct StrideReport {
    t: f64,
    x: f64,
    y: f64,
    z: f64,
    length_m: f64,
}

impl Report {
    fn new(log: &log::Log, walk: Walk, accuracy: Option<Accuracy>) -> Self {
        let strides = walk.strides.iter().map(|stride| {
            let [x, y, z] = stride.position;
            StrideReport { t: stride.time_us as f64 / 1e6, x, y, z, length_m: stride.length_m }
        });
        Self {
            system: "pedestrian",
            samples: log.samples.len(),
            duration_s: log.duration_s(),
            path_length_m: walk.path_length_m,
            closure_m: walk.closure_m,
            strides: strides.collect(),
            warnings: log.warnings.iter().cloned().chain(walk.warnings).collect(),
            accuracy,
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        row("samples", format!("{} in {:.1} s", self.samples, self.duration_s));
        row("strides", self.strides.len().to_string());
        row("path length", format!("{:.2} m", self.path_length_m));
        row("start to end", format!("{:.2} m", self.closure_m));
        if let Some(accuracy) = self.accuracy {
            for (name, value) in accuracy.in_words() {
                row(name, value);
            }
        }
        table.fmt(f)
    }
}
