//! Recordings of a tag, with the truth where it is known, from files or synthetic.

pub mod anchors;
pub mod calibration;
mod clocks;
pub mod motion;
pub mod points;
pub mod ranges;

use std::path::{Path, PathBuf};

use kestirim_import::Options;
use kestirim_replay::robot::{self, Anchors, Course, Event, Sensors};

use self::ranges::RangeLog;
use super::height::FoundOnce;
use super::simulate::scenario::{self, EPOCH_US, EPOCHS, Office, office_anchors};
use crate::Error;
use crate::random::stream;
use crate::system::Files;
use crate::table::{self, Found};
use crate::text::printable_path;

/// A recording of a tag.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    /// The path of the ranges; `None` for a synthetic recording.
    pub path: Option<PathBuf>,
    /// The positions of the anchors.
    pub anchors: Anchors,
    /// The single track of a moving tag, or every point at which it was put down; each is tracked separately.
    pub parts: Vec<Part>,
    /// The bias of each anchor's ranges (m), if known.
    pub biases: Option<Vec<f64>>,
    /// The knowledge of the tag's height.
    pub heights: Heights,
    /// The conclusions about columns and units of logs.
    pub import: Vec<String>,
    /// Warnings about readable but suspicious contents.
    pub warnings: Vec<String>,
    /// The tag's height as found from the ranges, if it is not given.
    pub(super) found_height: FoundOnce,
}

/// The knowledge of a tag's height.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Heights {
    /// The height is unknown.
    #[default]
    Unknown,
    /// The height is the anchors' mean height.
    OfAnchors,
    /// The height was read from a file.
    Read,
}

/// A part of a recording that is tracked by itself.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// The name of the point; empty for a moving tag.
    pub name: String,
    /// The sensor events, in the order in which trackers process them.
    pub events: Vec<Event>,
    /// The true position of the tag, if known.
    pub truth: Option<Truth>,
    /// The height of the tag at the point (m), if it was read.
    pub height_m: Option<f64>,
}

impl Part {
    /// Whether there is wheel odometry.
    pub fn has_wheels(&self) -> bool {
        self.events.iter().any(|event| matches!(event, Event::Wheels(_)))
    }
}

/// The true position of a tag.
#[derive(Debug, Clone, PartialEq)]
pub enum Truth {
    /// A marked point (m).
    Point([f64; 2]),
    /// A path over time.
    Course(Course<2>),
}

impl Truth {
    /// The position at a time of the log's clock (m).
    pub fn at(&self, time_us: i64) -> Option<[f64; 2]> {
        match self {
            Self::Point(point) => Some(*point),
            Self::Course(course) => course.within(time_us),
        }
    }
}

/// The motion of a synthetic robot in the paper's office.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// It stands at the fifteen points.
    Points,
    /// It drives along the straight line.
    Line,
    /// It drives a round, with a person in front of each anchor in turn.
    CrowdedRound,
}

impl Recording {
    /// Reads the files.
    ///
    /// # Errors
    /// An error that names the file, the line, and what was expected there.
    pub fn read(files: &Files) -> Result<Self, Error> {
        files.exclude("points", &["truth", "imu", "odom"])?;
        let (anchors, log) = (files.required("anchors")?, files.required("log")?);
        let height = files.one("height");
        let is_number = |path: &Path| path.to_str().is_some_and(|it| it.parse::<f64>().is_ok());
        if let Some(path) = height.filter(|path| is_number(path) || !path.exists()) {
            return Err(Error::Usage(format!(
                "--height: expected metres above the floor, such as 0.6, or a file, found {}",
                printable_path(path)
            )));
        }
        let mut recording = Self {
            path: Some(log.to_path_buf()),
            anchors: anchors::read(anchors)?,
            heights: if height.is_some() { Heights::Read } else { Heights::Unknown },
            ..Self::default()
        };
        if let Some(path) = files.one("calibration") {
            let (biases, warnings) = calibration::of(path, &recording.anchors)?;
            (recording.biases, recording.warnings) = (Some(biases), warnings);
        }
        match files.one("points") {
            Some(points) => recording.read_static(log, points, height, files.reading.tables()?)?,
            None => recording.read_moving(log, files)?,
        }
        Ok(recording)
    }

    /// Whether a file can be what a field holds.
    pub fn fits(field: &str, path: &Path, files: &Files) -> bool {
        match field {
            "anchors" => anchors::read(path).is_ok(),
            "log" => {
                let anchors = files.one("anchors").map(anchors::read);
                let anchors = anchors.and_then(Result::ok).unwrap_or_default();
                files.reading.tables().is_ok_and(|options| {
                    ranges::read_moving(path, &anchors, options).is_ok()
                        || ranges::read_static(path, &anchors, options).is_ok()
                })
            }
            "calibration" => table::has(path, ["anchor", "bias"]),
            // For a tag that is put down, the log names the point.
            _ if files.one("log").is_some_and(|log| table::has(log, ["point"])) => match field {
                "points" => table::has(path, ["point", "x", "y", "z"]),
                "height" => table::has(path, ["point", "z"]) && !table::has(path, ["x"]),
                _ => false,
            },
            "truth" => table::has(path, ["t", "x", "y"]),
            "imu" => ["qw", "gx", "ax", "lax"].iter().any(|name| table::has(path, ["t", name])),
            "odom" => table::has(path, ["t", "v_left", "v_right", "track"]),
            "height" => table::has(path, ["t", "z"]) && !table::has(path, ["x"]),
            _ => false,
        }
    }

    fn read_moving(&mut self, log: &Path, files: &Files) -> Result<(), Error> {
        let options = files.reading.tables()?;
        let (RangeLog { rows: ranges, differences, unlisted, without }, found) =
            ranges::read_moving(log, &self.anchors, options)?;
        self.tell("ranges", &found);
        let truth = files.one("truth").map(|path| points::read_course(path, ["x", "y"]));
        let height = files.one("height").map(|path| points::read_course(path, ["z"]));
        let (mut truth, height) = (truth.transpose()?, height.transpose()?);
        let mut sensors = Sensors { ranges, differences, height, ..Sensors::default() };
        if let Some(path) = files.one("imu") {
            let (samples, found) = motion::read_inertial(path, options)?;
            sensors.inertial = samples;
            self.tell("IMU", &found);
        }
        if let Some(path) = files.one("odom") {
            let (samples, found) = motion::read_wheels(path, options)?;
            sensors.wheels = samples;
            self.tell("wheels", &found);
        }
        if files.one("imu").is_some() && sensors.inertial.is_empty() {
            self.warn("the IMU has no columns ax,ay,az or lax,lay,laz: it is not used");
        }
        clocks::align(&mut sensors, &mut truth);
        let span = clocks::span_us(&sensors);
        let of_truth = truth.as_ref().and_then(|truth| clocks::doubt("truth", truth, span));
        let height = sensors.height.as_ref();
        let of_height = height.and_then(|height| clocks::doubt("height", height, span));
        self.warnings.extend(of_truth.into_iter().chain(of_height));
        self.warn_of_left_out(unlisted, without);
        if let Some(order) = sensors.put_in_order() {
            self.warn(order);
        }
        let dropped = sensors.drop_wrong_times();
        let refused = |error: robot::Error| Error::File {
            path: log.to_path_buf(),
            problem: error.to_string(),
        };
        if let Some(dropped) = dropped.map_err(refused)? {
            self.warn(dropped);
        }
        let truth = truth.map(Truth::Course);
        self.parts = vec![Part { events: sensors.events(), truth, ..Part::default() }];
        Ok(())
    }

    fn read_static(
        &mut self,
        log: &Path,
        points: &Path,
        height: Option<&Path>,
        options: &Options,
    ) -> Result<(), Error> {
        let points = points::read_points(points)?;
        let (mut logs, found) = ranges::read_static(log, &self.anchors, options)?;
        self.tell("ranges", &found);
        let heights = height.map(points::read_heights).transpose()?;
        let sum = |of: fn(&RangeLog) -> usize| -> usize { logs.values().map(of).sum() };
        self.warn_of_left_out(sum(|log| log.unlisted), sum(|log| log.without));
        for point in points {
            let RangeLog { rows, .. } = logs.remove(&point.name).unwrap_or_default();
            let height_m = heights.as_ref().map(|heights| {
                let height = heights.get(&point.name).copied();
                height.ok_or_else(|| {
                    Error::Usage(format!("--height: point {} has no height", point.name))
                })
            });
            let (events, truth) = (Sensors::ranges(rows).events(), point.plane.map(Truth::Point));
            self.parts.push(Part {
                name: point.name.clone(),
                events,
                truth,
                height_m: height_m.transpose()?,
            });
        }
        Ok(())
    }

    /// Adds the conclusions and warnings about a log.
    fn tell(&mut self, log: &str, found: &Found) {
        self.import.extend(found.import.iter().map(|line| format!("{log}: {line}")));
        self.warnings.extend(found.warnings.iter().map(|line| format!("{log}: {line}")));
    }

    /// Generates the recording of a robot in the paper's office on one day.
    pub fn synthetic(driven: Driven, seed: u64) -> Self {
        let mut rng = stream(seed, 0);
        let office = Office::draw(&mut rng);
        let along = |path: &[[f64; 2]], rows| {
            let at = path.iter().enumerate().map(|(i, &at)| (i as i64 * EPOCH_US, at));
            let truth = Some(Truth::Course(Course::new(at.collect())));
            vec![Part { events: Sensors::ranges(rows).events(), truth, ..Part::default() }]
        };
        let parts = match driven {
            Driven::Points => scenario::points()
                .iter()
                .enumerate()
                .map(|(i, &place)| Part {
                    name: format!("P{}", i + 1),
                    events: Sensors::ranges(office.measure(&mut rng, &[place; EPOCHS])).events(),
                    truth: Some(Truth::Point(place)),
                    height_m: None,
                })
                .collect(),
            Driven::Line => {
                let path = scenario::line();
                along(&path, office.measure(&mut rng, &path))
            }
            Driven::CrowdedRound => {
                let path = scenario::round();
                along(&path, office.measure_in_a_crowd(&mut rng, &path))
            }
        };
        let anchors = office_anchors();
        let biases = Some(office.calibrate(&mut rng));
        Self { anchors, parts, biases, heights: Heights::OfAnchors, ..Self::default() }
    }

    /// Whether the tag was put down at points.
    pub fn is_static(&self) -> bool {
        !matches!(self.parts.as_slice(), [part] if part.name.is_empty())
    }

    fn warn_of_left_out(&mut self, unlisted: usize, without: usize) {
        if unlisted > 0 {
            self.warn(format!("{unlisted} ranges are from anchors that are not listed: left out"));
        }
        if without > 0 {
            self.warn(format!("{without} ranges are zero or less, which is no distance: left out"));
        }
    }

    fn warn(&mut self, warning: impl Into<String>) {
        self.warnings.push(warning.into());
    }
}
