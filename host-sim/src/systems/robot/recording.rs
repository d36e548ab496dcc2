//! What was recorded of a tag, with its truth where that is known: from files or synthetic.

use std::path::Path;

use super::accuracy::Accuracy;
use super::anchors::{self, Anchors};
use super::feed::{Company, Followed};
use super::points::{self, Course, Height, Point};
use super::ranges::{self, RangeLog, RangeRow};
use super::scenario::{self, ANCHORS, EPOCH_US, EPOCHS, Office};
use super::{calibration, motion};
use crate::Error;
use crate::random::stream;

/// The files of a recording.
#[derive(Debug, Clone, Copy)]
pub struct Files<'a> {
    /// Where the anchors are.
    pub anchors: &'a Path,
    /// The ranges.
    pub log: &'a Path,
    /// Marked points, if the tag was put down.
    pub points: Option<&'a Path>,
    /// The true track, if it moved.
    pub truth: Option<&'a Path>,
    /// Samples of the IMU.
    pub imu: Option<&'a Path>,
    /// Samples of the wheels.
    pub odom: Option<&'a Path>,
    /// What the anchors measure too long.
    pub calibration: Option<&'a Path>,
    /// Metres, or a file of heights.
    pub height: Option<&'a str>,
}

/// What was recorded.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    /// Where the anchors are.
    pub anchors: Anchors,
    /// The one way of a moving tag, or every point at which it was put down: each is tracked by itself.
    pub parts: Vec<Part>,
    /// What a moving tag recorded beside its ranges.
    pub company: Company,
    /// What the anchors measure too long, m, if that is known.
    pub biases: Option<Vec<f64>>,
    /// What is suspicious but readable.
    pub warnings: Vec<String>,
}

/// Ranges that belong together.
#[derive(Debug, Clone, Default)]
pub struct Part {
    /// Name of the point; empty of a moving tag.
    pub name: String,
    /// In the order of the log.
    pub rows: Vec<RangeRow>,
    /// Where the tag was, if anybody knows.
    pub truth: Option<Truth>,
    /// The height of the tag, m, if it is known.
    pub height_m: Option<f64>,
}

/// Where the tag was.
#[derive(Debug, Clone, PartialEq)]
pub enum Truth {
    /// At a marked point, m.
    Point([f64; 2]),
    /// Along a way.
    Course(Course<2>),
}

impl Truth {
    /// Where it was at a time of the log's clock, m.
    pub fn at(&self, time_us: i64) -> Option<[f64; 2]> {
        match self {
            Self::Point(point) => Some(*point),
            Self::Course(course) => course.within(time_us),
        }
    }
}

/// What a robot did in the paper's office.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// It stood at the fifteen points.
    Points,
    /// It drove the straight line.
    Line,
    /// It drove a round, with somebody before each anchor in turn.
    CrowdedRound,
}

impl Recording {
    /// Reads the files.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(files: &Files<'_>) -> Result<Self, Error> {
        let mut recording = Self { anchors: anchors::read(files.anchors)?, ..Self::default() };
        if let Some(path) = files.calibration {
            let known = calibration::read(path, &recording.anchors)?;
            recording.calibrate(&known);
        }
        match files.points {
            Some(points) => recording.read_static(files, points)?,
            None => recording.read_moving(files)?,
        }
        Ok(recording)
    }

    fn read_moving(&mut self, files: &Files<'_>) -> Result<(), Error> {
        let mut log = ranges::read_moving(files.log, &self.anchors)?;
        let truth = files.truth.map(|path| points::read_course(path, ["x", "y"])).transpose()?;
        let height = files.height.map(|text| points::read_height(text, false)).transpose()?;
        let mut company = Company {
            inertial: files.imu.map_or(Ok(vec![]), motion::read_inertial)?,
            wheels: files.odom.map_or(Ok(vec![]), motion::read_wheels)?,
            height: None,
        };
        if files.imu.is_some() && company.inertial.is_empty() {
            self.warn("the IMU has no columns ax,ay,az or lax,lay,laz: it is not used");
        }
        self.warn_of_strangers(log.strangers);
        let ahead = ranges::drop_far_ahead(&mut log.rows, |row| row.time_us)
            + ranges::drop_far_ahead(&mut company.inertial, |sample| sample.time_us)
            + ranges::drop_far_ahead(&mut company.wheels, |sample| sample.time_us);
        if ahead > 0 {
            self.warn(format!(
                "{ahead} samples are more than 10 s ahead of what follows them: left out"
            ));
        }
        let mut part = Part { rows: log.rows, truth: truth.map(Truth::Course), ..Part::default() };
        match height {
            Some(Height::Metres(metres)) => part.height_m = Some(metres),
            Some(Height::Course(course)) => company.height = Some(course),
            Some(Height::Points(_)) | None => {}
        }
        (self.parts, self.company) = (vec![part], company);
        Ok(())
    }

    fn read_static(&mut self, files: &Files<'_>, points: &Path) -> Result<(), Error> {
        let points = points::read_points(points)?;
        let mut logs = ranges::read_static(files.log, &self.anchors)?;
        let height = files.height.map(|text| points::read_height(text, true)).transpose()?;
        self.warn_of_strangers(logs.values().map(|log| log.strangers).sum());
        for point in points {
            let RangeLog { rows, .. } = logs.remove(&point.name).unwrap_or_default();
            let height_m = height_at(height.as_ref(), &point)?;
            let truth = point.plane.map(Truth::Point);
            self.parts.push(Part { name: point.name, rows, truth, height_m });
        }
        Ok(())
    }

    /// What a robot in the paper's office records on one day.
    pub fn synthetic(driven: Driven, seed: u64) -> Self {
        let mut rng = stream(seed, 0);
        let office = Office::draw(&mut rng);
        let along = |way: &[[f64; 2]]| {
            let rows = way.iter().enumerate().map(|(i, &at)| (i as i64 * EPOCH_US, at)).collect();
            Some(Truth::Course(Course::new(rows)))
        };
        let parts = match driven {
            Driven::Points => scenario::points()
                .iter()
                .enumerate()
                .map(|(i, &place)| Part {
                    name: format!("P{}", i + 1),
                    rows: office.measure(&mut rng, &[place; EPOCHS]),
                    truth: Some(Truth::Point(place)),
                    height_m: None,
                })
                .collect(),
            Driven::Line => {
                let way = scenario::line();
                let rows = office.measure(&mut rng, &way);
                vec![Part { rows, truth: along(&way), ..Part::default() }]
            }
            Driven::CrowdedRound => {
                let way = scenario::round();
                let rows = office.measure_in_a_crowd(&mut rng, &way);
                vec![Part { rows, truth: along(&way), ..Part::default() }]
            }
        };
        let names = (1..=ANCHORS.len()).map(|number| format!("A{number}")).collect();
        let anchors = Anchors { names, positions: ANCHORS.to_vec() };
        let biases = Some(office.calibrate(&mut rng));
        Self { anchors, parts, biases, ..Self::default() }
    }

    /// How far what came out is from the truth: at every epoch of a moving tag, at the last of each point.
    pub fn accuracy<'a>(&self, all: impl IntoIterator<Item = &'a Followed>) -> Option<Accuracy> {
        let mut pairs = Vec::new();
        for (part, followed) in self.parts.iter().zip(all) {
            match &part.truth {
                Some(Truth::Course(course)) => return Accuracy::of_track(&followed.epochs, course),
                Some(Truth::Point(point)) => pairs.push((followed.last(), *point)),
                None => {}
            }
        }
        Accuracy::of(&pairs)
    }

    /// Biases of all anchors: one that the calibration does not know is taken to be like the others.
    fn calibrate(&mut self, known: &[Option<f64>]) {
        let found: Vec<f64> = known.iter().flatten().copied().collect();
        let mean = crate::metrics::mean(&found);
        for (bias, name) in known.iter().zip(&self.anchors.names) {
            if bias.is_none() {
                self.warnings.push(format!(
                    "the calibration does not know anchor {name}: the others' mean bias is assumed"
                ));
            }
        }
        self.biases = Some(known.iter().map(|bias| bias.unwrap_or(mean)).collect());
    }

    fn warn_of_strangers(&mut self, strangers: usize) {
        if strangers > 0 {
            self.warn(format!("{strangers} ranges are from anchors that are not listed: left out"));
        }
    }

    fn warn(&mut self, warning: impl Into<String>) {
        self.warnings.push(warning.into());
    }
}

fn height_at(height: Option<&Height>, point: &Point) -> Result<Option<f64>, Error> {
    match height {
        Some(Height::Metres(metres)) => Ok(Some(*metres)),
        Some(Height::Points(heights)) => match heights.get(&point.name) {
            Some(metres) => Ok(Some(*metres)),
            None => Err(Error::Usage(format!("--height: point {} has no height", point.name))),
        },
        Some(Height::Course(_)) | None => Ok(None),
    }
}
