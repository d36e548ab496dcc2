//! `host-sim replay robot`: recorded ranges become positions.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::accuracy::Accuracy;
use super::feed::Followed;
use super::follow;
use super::options::{self, Dimensions, Setup, TrackerKind, parse_room};
use super::recording::{Files, Recording};
use super::streams::streams;
use super::trace::{Trace, trace};
use crate::system::ScalarKind;
use crate::system::choose_scalar;
use crate::{Error, mcap, output};

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Replay {
    /// Where the anchors are: CSV with columns anchor,x,y,z (m)
    #[arg(long, value_name = "FILE")]
    anchors: PathBuf,
    /// The ranges: CSV with columns t,anchor,range, or with --points point,k,anchor,range (s, m)
    #[arg(long, value_name = "FILE")]
    log: PathBuf,
    /// Marked points of a static recording: CSV with columns point,x,y,z; x and y serve accuracy alone
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// True track of a moving tag: CSV with columns t,x,y; serves accuracy alone
    #[arg(long, value_name = "FILE", conflicts_with = "points")]
    truth: Option<PathBuf>,
    /// IMU: CSV with t and any of qw,qx,qy,qz gx,gy,gz ax,ay,az lax,lay,laz (SI, body)
    #[arg(long, value_name = "FILE", conflicts_with = "points")]
    imu: Option<PathBuf>,
    /// Wheels: CSV with columns `t,v_left,v_right,track` (m/s, m)
    #[arg(long, value_name = "FILE", conflicts_with = "points")]
    odom: Option<PathBuf>,
    /// What the anchors measure too long, as written by `calibrate robot`
    #[arg(long, value_name = "FILE")]
    calibration: Option<PathBuf>,
    /// Dimensions of the position
    #[arg(long, value_enum, default_value_t)]
    dim: Dimensions,
    /// Height of the tag in two dimensions: metres, or CSV with columns t,z (point,z with --points)
    #[arg(long, value_name = "METRES|FILE", allow_hyphen_values = true)]
    height: Option<String>,
    /// Where the tag can be: two opposite corners, m
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = parse_room, allow_hyphen_values = true)]
    room: Option<[f64; 4]>,
    /// Number type of the tracker [default: f32]
    #[arg(long, value_name = "TYPE")]
    scalar: Option<ScalarKind>,
    /// How ranges become positions
    #[arg(long, value_enum, default_value_t)]
    tracker: TrackerKind,
    /// Write t,x,y,z of every epoch (point,x,y,z with --points) to this file
    #[arg(long, value_name = "OUT.csv")]
    track: Option<PathBuf>,
    /// Write ranges, estimate and truth as MCAP, for Foxglove and Rerun
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
        self.refuse_overwriting_input()?;
        let recording = Recording::read(&self.files())?;
        let setup = self.setup(&recording)?;
        let traces = trace(&recording, &setup, follow::build)?;
        let all = || traces.iter().map(|trace| &trace.followed);
        let found = recording.parts.iter().zip(all());
        let mut report = Report { accuracy: recording.accuracy(all()), ..Report::of(all()) };
        if self.height.is_none() && self.dim == Dimensions::Two {
            report.warnings.push(format!(
                "the tag's height is taken to be that of the anchors, {:.2} m (--height)",
                setup.height_m
            ));
        }
        report.warnings.extend(recording.warnings.iter().cloned());
        if self.points.is_some() {
            let found: Vec<_> =
                found.map(|(part, followed)| (part.name.clone(), followed.last())).collect();
            report.take_points(found);
        } else if all().all(|followed| followed.known().next().is_none()) {
            report.warnings.push("no position was found".into());
        }
        self.write_files(&recording, &traces, &report)?;
        Ok(report)
    }

    fn write_files(
        &self,
        recording: &Recording,
        traces: &[Trace],
        report: &Report,
    ) -> Result<(), Error> {
        if let (Some(path), Some(points)) = (&self.track, &report.points) {
            let rows =
                points.iter().map(|point| (point.point.clone(), [point.x, point.y, point.z]));
            write_track(path, "point", rows)?;
        } else if let Some(path) = &self.track {
            let known = traces.iter().flat_map(|trace| trace.followed.known());
            write_track(path, "t", known.map(|(time_us, at)| (seconds(time_us), at)))?;
        }
        match &self.mcap {
            Some(path) => mcap::write(path, &streams(recording, traces)),
            None => Ok(()),
        }
    }

    fn files(&self) -> Files<'_> {
        Files {
            anchors: &self.anchors,
            log: &self.log,
            points: self.points.as_deref(),
            truth: self.truth.as_deref(),
            imu: self.imu.as_deref(),
            odom: self.odom.as_deref(),
            calibration: self.calibration.as_deref(),
            height: self.height.as_deref(),
        }
    }

    fn setup(&self, recording: &Recording) -> Result<Setup, Error> {
        Ok(Setup {
            tracker: self.tracker,
            dimensions: self.dim,
            scalar: choose_scalar("robot", self.scalar, &options::SCALARS, ScalarKind::F32)?,
            room: self.room,
            height_m: recording.anchors.mean_height(),
            anchors: recording.anchors.positions.clone(),
            biases: recording.biases.clone(),
        })
    }

    fn refuse_overwriting_input(&self) -> Result<(), Error> {
        let height = self.height.as_ref().map(PathBuf::from);
        let inputs = [
            Some(&self.anchors),
            Some(&self.log),
            self.points.as_ref(),
            self.truth.as_ref(),
            self.imu.as_ref(),
            self.odom.as_ref(),
            self.calibration.as_ref(),
            height.as_ref(),
        ];
        let inputs = inputs.iter().copied().flatten();
        let outputs = [("--track", self.track.as_deref()), ("--mcap", self.mcap.as_deref())];
        output::refuse_clashes(&outputs, &inputs)
    }
}

fn seconds(time_us: i64) -> String {
    let sign = if time_us < 0 { "-" } else { "" };
    let size = time_us.unsigned_abs();
    format!("{sign}{}.{:06}", size / 1_000_000, size % 1_000_000)
}

fn write_track(
    path: &Path,
    first: &str,
    rows: impl Iterator<Item = (String, [f64; 3])>,
) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record([first, "x", "y", "z"])?;
        for (label, position) in rows {
            let [x, y, z] = position.map(|metres| format!("{metres:.6}"));
            table.write_record([label, x, y, z])?;
        }
        table.flush()
    })
}

/// What the command prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    updates: usize,
    rejected: usize,
    lost_s: f64,
    warnings: Vec<String>,
    accuracy: Option<Accuracy>,
    #[serde(skip_serializing_if = "Option::is_none")]
    points: Option<Vec<PointReport>>,
}

/// Where the tag was found at a marked point, m.
#[derive(Debug, Clone, Serialize)]
struct PointReport {
    point: String,
    x: f64,
    y: f64,
    z: f64,
}

impl Report {
    fn of<'a>(followed: impl Iterator<Item = &'a Followed> + Clone) -> Self {
        Self {
            system: "robot",
            updates: followed.clone().map(|followed| followed.updates).sum(),
            rejected: followed.clone().map(|followed| followed.rejected).sum(),
            lost_s: followed.map(Followed::lost_s).sum(),
            warnings: Vec::new(),
            accuracy: None,
            points: None,
        }
    }

    /// Takes the points at which there is a position, and warns of the others.
    fn take_points(&mut self, found: Vec<(String, Option<[f64; 3]>)>) {
        let missing = found.iter().filter(|(_, position)| position.is_none()).count();
        if missing > 0 {
            self.warnings.push(format!("points without ranges enough for a position: {missing}"));
        }
        let known = found.into_iter().filter_map(|(point, position)| Some((point, position?)));
        self.points =
            Some(known.map(|(point, [x, y, z])| PointReport { point, x, y, z }).collect());
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        row("ranges taken in", self.updates.to_string());
        row("ranges left out", self.rejected.to_string());
        row("without a position", format!("{:.1} s", self.lost_s));
        if let Some(points) = &self.points {
            row("points found", points.len().to_string());
        }
        if let Some(accuracy) = self.accuracy {
            for (name, value) in accuracy.in_words() {
                row(name, value);
            }
        }
        table.fmt(f)
    }
}
