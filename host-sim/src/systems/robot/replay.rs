//! `host-sim replay robot`: recorded ranges become positions.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::accuracy::Accuracy;
use super::anchors::Anchors;
use super::feed::{self, Company, Followed};
use super::options::{self, Dimensions, Setup, TrackerKind, parse_room};
use super::points::{self, Height, Point};
use super::ranges::RangeLog;
use super::{anchors, calibration, follow, motion, ranges};
use crate::cli::ScalarKind;
use crate::systems::choose_scalar;
use crate::{Error, output};

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
        let anchors = anchors::read(&self.anchors)?;
        let mut warnings = Vec::new();
        let setup = self.setup(&anchors, &mut warnings)?;
        match &self.points {
            Some(points) => self.static_report(points, &anchors, &setup, warnings),
            None => self.moving_report(&anchors, setup, warnings),
        }
    }

    fn moving_report(
        &self,
        anchors: &Anchors,
        mut setup: Setup,
        mut warnings: Vec<String>,
    ) -> Result<Report, Error> {
        let mut log = ranges::read_moving(&self.log, anchors)?;
        let truth =
            self.truth.as_deref().map(|path| points::read_course(path, ["x", "y"])).transpose()?;
        let height = self.height(false)?;
        if let Some(Height::Metres(metres)) = height {
            setup.height_m = metres;
        }
        let mut company = Company {
            inertial: self.imu.as_deref().map_or(Ok(vec![]), motion::read_inertial)?,
            wheels: self.odom.as_deref().map_or(Ok(vec![]), motion::read_wheels)?,
            height: match height {
                Some(Height::Course(course)) => Some(course),
                _ => None,
            },
        };
        if self.imu.is_some() && company.inertial.is_empty() {
            warnings.push("the IMU has no columns ax,ay,az or lax,lay,laz: it is not used".into());
        }
        warn_of_strangers(log.strangers, &mut warnings);
        let ahead = ranges::drop_far_ahead(&mut log.rows, |row| row.time_us)
            + ranges::drop_far_ahead(&mut company.inertial, |sample| sample.time_us)
            + ranges::drop_far_ahead(&mut company.wheels, |sample| sample.time_us);
        if ahead > 0 {
            warnings.push(format!(
                "{ahead} samples are more than 10 s ahead of what follows them: left out"
            ));
        }
        let mut tracker = follow::build(&setup)?;
        let followed = feed::follow(tracker.as_mut(), &log.rows, &company);
        if followed.epochs.iter().all(|epoch| epoch.position.is_none()) {
            warnings.push("no position was found".into());
        }
        let accuracy = truth.and_then(|truth| Accuracy::of_track(&followed.epochs, &truth));
        if let Some(path) = &self.track {
            let known = followed
                .epochs
                .iter()
                .filter_map(|epoch| Some((seconds(epoch.time_us), epoch.position?)));
            write_track(path, "t", known)?;
        }
        Ok(Report { warnings, accuracy, ..Report::of(&[followed]) })
    }

    fn static_report(
        &self,
        points: &Path,
        anchors: &Anchors,
        setup: &Setup,
        mut warnings: Vec<String>,
    ) -> Result<Report, Error> {
        let points = points::read_points(points)?;
        let logs = ranges::read_static(&self.log, anchors)?;
        let height = self.height(true)?;
        warn_of_strangers(logs.values().map(|log| log.strangers).sum(), &mut warnings);
        let nothing = RangeLog::default();
        let (mut found, mut all) = (Vec::new(), Vec::new());
        for point in &points {
            let log = logs.get(&point.name).unwrap_or(&nothing);
            let height_m = height_at(height.as_ref(), point, setup.height_m)?;
            let mut tracker = follow::build(&Setup { height_m, ..setup.clone() })?;
            let followed = feed::follow(tracker.as_mut(), &log.rows, &Company::default());
            found.push((point, followed.epochs.last().and_then(|epoch| epoch.position)));
            all.push(followed);
        }
        let missing = found.iter().filter(|(_, position)| position.is_none()).count();
        if missing > 0 {
            warnings.push(format!("points without ranges enough for a position: {missing}"));
        }
        let pairs: Vec<_> =
            found.iter().filter_map(|(point, position)| Some((*position, point.plane?))).collect();
        let known = || found.iter().filter_map(|(point, position)| Some((point, (*position)?)));
        if let Some(path) = &self.track {
            write_track(path, "point", known().map(|(point, at)| (point.name.clone(), at)))?;
        }
        let points =
            known().map(|(point, [x, y, z])| PointReport { point: point.name.clone(), x, y, z });
        let (points, accuracy) = (Some(points.collect()), Accuracy::of(&pairs));
        Ok(Report { warnings, accuracy, points, ..Report::of(&all) })
    }

    fn setup(&self, anchors: &Anchors, warnings: &mut Vec<String>) -> Result<Setup, Error> {
        let scalar = choose_scalar("robot", self.scalar, &options::SCALARS, ScalarKind::F32)?;
        let height_m = anchors.mean_height();
        if self.height.is_none() && self.dim == Dimensions::Two {
            warnings.push(format!(
                "the tag's height is taken to be that of the anchors, {height_m:.2} m (--height)"
            ));
        }
        let biases = match &self.calibration {
            Some(path) => Some(completed(calibration::read(path, anchors)?, anchors, warnings)),
            None => None,
        };
        Ok(Setup {
            tracker: self.tracker,
            dimensions: self.dim,
            scalar,
            room: self.room,
            height_m,
            anchors: anchors.positions.clone(),
            biases,
        })
    }

    fn height(&self, of_points: bool) -> Result<Option<Height>, Error> {
        let text = self.height.as_deref();
        text.map(|text| points::read_height(text, of_points)).transpose()
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
        output::refuse_overwriting("--track", self.track.as_deref(), inputs.into_iter().flatten())
    }
}

fn height_at(height: Option<&Height>, point: &Point, else_m: f64) -> Result<f64, Error> {
    match height {
        Some(Height::Metres(metres)) => Ok(*metres),
        Some(Height::Points(heights)) => heights
            .get(&point.name)
            .copied()
            .ok_or_else(|| Error::Usage(format!("--height: point {} has no height", point.name))),
        _ => Ok(else_m),
    }
}

/// Biases of all anchors: one that the calibration does not know is taken to be like the others.
fn completed(known: Vec<Option<f64>>, anchors: &Anchors, warnings: &mut Vec<String>) -> Vec<f64> {
    let found: Vec<f64> = known.iter().flatten().copied().collect();
    let mean = crate::metrics::mean(&found);
    for (bias, name) in known.iter().zip(&anchors.names) {
        if bias.is_none() {
            warnings.push(format!(
                "the calibration does not know anchor {name}: the others' mean bias is assumed"
            ));
        }
    }
    known.into_iter().map(|bias| bias.unwrap_or(mean)).collect()
}

fn warn_of_strangers(strangers: usize, warnings: &mut Vec<String>) {
    if strangers > 0 {
        warnings.push(format!("{strangers} ranges are from anchors that are not listed: left out"));
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
    fn of(followed: &[Followed]) -> Self {
        Self {
            system: "robot",
            updates: followed.iter().map(|followed| followed.updates).sum(),
            rejected: followed.iter().map(|followed| followed.rejected).sum(),
            lost_s: followed.iter().map(Followed::lost_s).sum(),
            warnings: Vec::new(),
            accuracy: None,
            points: None,
        }
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
            row("positions compared", accuracy.positions.to_string());
            let centimetres = |metres: f64| format!("{:.1} cm", 100.0 * metres);
            row("RMSE", centimetres(accuracy.rmse_m));
            row("mean error", centimetres(accuracy.mean_m));
            row("95 % below", centimetres(accuracy.p95_m));
            row("largest error", centimetres(accuracy.max_m));
        }
        table.fmt(f)
    }
}
