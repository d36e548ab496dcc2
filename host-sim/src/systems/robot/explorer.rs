//! A recording among anchors in the browser: ranges, what is left out, ellipses, and what each constant does.

mod controls;
#[cfg(test)]
mod tests;

use super::accuracy::Accuracy;
use super::feed::Followed;
use super::figures::{self, Shown};
use super::follow;
use super::options::{Dimensions, Setup, TrackerKind};
use super::recording::{self, Driven, Recording};
use super::trace::{Trace, trace};
use crate::Error;
use crate::explore::{Answer, Control, Explorer, FileField, Files, Settings, Source};
use crate::figure::{Colour, Mark};

/// Where recordings come from.
pub const SOURCE: Source = Source {
    system: "robot",
    title: "where a tag is, from ranges to ultra-wideband anchors",
    files: &[
        field("anchors", "Anchors: CSV anchor,x,y,z (m)", true),
        field(
            "log",
            "Ranges: CSV t,anchor,range (s, m), or with points point,k,anchor,range",
            true,
        ),
        field("truth", "True track of a moving tag: CSV t,x,y (s, m)", false),
        field("points", "Marked points of a tag put down: CSV point,x,y,z (m)", false),
        field("imu", "IMU: CSV t and ax,ay,az or lax,lay,laz, perhaps qw,qx,qy,qz (SI)", false),
        field("odom", "Wheels: CSV t,v_left,v_right,track (s, m/s, m)", false),
        field("calibration", "What the anchors measure too long: CSV anchor,bias (m)", false),
    ],
    bundled: &[
        ("line", "The paper's office: a straight line"),
        ("points", "The paper's office: fifteen points, 50 epochs each"),
        ("crowded-round", "The paper's office: a round, with somebody before each anchor in turn"),
    ],
    open: |files| Ok(Box::new(Opened { recording: read(files)?, height_is_known: false })),
    open_bundled: |name| Ok(Box::new(Opened { recording: bundled(name)?, height_is_known: true })),
};

const fn field(name: &'static str, label: &'static str, required: bool) -> FileField {
    FileField { name, label, required, several: false }
}

fn read(files: &Files) -> Result<Recording, Error> {
    let points = files.one("points");
    let beside = ["truth", "imu", "odom"];
    if let (true, Some(name)) =
        (points.is_some(), beside.iter().find(|name| files.one(name).is_some()))
    {
        return Err(Error::Usage(format!(
            "points are for a tag put down, {name} is for one that moves"
        )));
    }
    Recording::read(&recording::Files {
        anchors: files.required("anchors")?,
        log: files.required("log")?,
        points,
        truth: files.one("truth"),
        imu: files.one("imu"),
        odom: files.one("odom"),
        calibration: files.one("calibration"),
        height: None,
    })
}

fn bundled(name: &str) -> Result<Recording, Error> {
    let driven = match name {
        "line" => Driven::Line,
        "points" => Driven::Points,
        "crowded-round" => Driven::CrowdedRound,
        _ => return Err(Error::Usage(format!("there is no synthetic recording {name:?}"))),
    };
    Ok(Recording::synthetic(driven, 0))
}

/// A recording that is open.
struct Opened {
    recording: Recording,
    /// Whether the tag is known to be as high as the anchors.
    height_is_known: bool,
}

impl Opened {
    fn warnings(&self, setup: &Setup, traces: &[Trace]) -> Vec<String> {
        let mut warnings = self.recording.warnings.clone();
        if traces.iter().all(|trace| trace.followed.known().next().is_none()) {
            warnings.push("no position was found".to_owned());
        }
        let anchors_m = self.recording.anchors.mean_height();
        let assumed = !self.height_is_known && setup.height_m == anchors_m;
        if assumed && setup.dimensions == Dimensions::Two {
            warnings.push(format!(
                "the tag's height is taken to be that of the anchors, {anchors_m:.2} m"
            ));
        }
        warnings
    }

    fn setup(&self, settings: &Settings) -> Setup {
        let anchors = self.recording.anchors.positions.clone();
        let around = figures::around(anchors.iter().map(|&[x, y, _]| [x, y]));
        Setup {
            tracker: controls::tracker(settings),
            dimensions: controls::dimensions(settings),
            scalar: controls::scalar(settings),
            room: settings.is_on("room").then_some(around),
            height_m: settings.number("height"),
            biases: self.recording.biases.clone().filter(|_| settings.is_on("calibrated")),
            anchors,
        }
    }
}

impl Explorer for Opened {
    fn controls(&self) -> Vec<Control> {
        controls::all(&self.recording)
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let recording = &self.recording;
        let (setup, tuning) = (self.setup(settings), controls::tuning(settings));
        let traces = trace(recording, &setup, |setup| follow::build_tuned(setup, Some(&tuning)))?;
        let unfiltered = Setup { tracker: TrackerKind::Lsq, ..setup.clone() };
        let unfiltered = trace(recording, &unfiltered, follow::build)?;
        let (shown, raw) = (Shown::new(recording, &traces), Shown::new(recording, &unfiltered));
        let positions = raw.track("trilateration alone", Mark::Dots).coloured(Colour::Published);
        let errors = [
            raw.error("trilateration alone").coloured(Colour::Published),
            shown.error("tracker").coloured(Colour::Ours),
        ];
        Ok(Answer {
            facts: facts(recording, &traces),
            warnings: self.warnings(&setup, &traces),
            figures: vec![
                shown.plan("plan", vec![positions]),
                shown.ranges("ranges"),
                shown.health("health"),
                shown.position("position"),
                figures::errors("error", errors),
            ],
        })
    }
}

fn facts(recording: &Recording, traces: &[Trace]) -> Vec<(String, String)> {
    let all = || traces.iter().map(|trace| &trace.followed);
    let of_the_ranges = [
        ("ranges taken in", all().map(|followed| followed.updates).sum::<usize>().to_string()),
        ("ranges left out", all().map(|followed| followed.rejected).sum::<usize>().to_string()),
        ("without a position", format!("{:.1} s", all().map(Followed::lost_s).sum::<f64>())),
    ];
    let accuracy = recording.accuracy(all());
    let of_the_truth = accuracy.iter().flat_map(Accuracy::in_words);
    let facts = of_the_ranges.into_iter().chain(of_the_truth);
    facts.map(|(name, value)| (name.to_owned(), value)).collect()
}
