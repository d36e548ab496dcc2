//! The paper's interface in the browser: a walk, a threshold, and what becomes of the path.

mod controls;
#[cfg(test)]
mod tests;

use super::accuracy::Accuracy;
use super::figures::{self, Placed};
use super::options::{DetectorKind, Options};
use super::recording::{Recording, Walked};
use super::run::RunError;
use super::trace::{Trace, trace, without_updates};
use super::track::TrackPoint;
use super::{STANDARD_GRAVITY, Sample};
use crate::Error;
use crate::explore::{Answer, Control, Explorer, FileField, Files, Settings, Source};
use crate::figure::{Colour, Figure};

/// Where walks come from.
pub const SOURCE: Source = Source {
    system: "pedestrian",
    title: "where a foot walked, from a foot-mounted IMU",
    files: &[
        FileField {
            name: "log",
            label: "Recorded walk: CSV t,ax,ay,az,gx,gy,gz (s, m/s², rad/s), or Razor text separated by blanks (ms, 3 × g, 3 × °/s)",
            required: true,
            several: false,
        },
        FileField {
            name: "truth",
            label: "Measured footprints: CSV t,x,y (s, m)",
            required: false,
            several: false,
        },
    ],
    bundled: &[
        ("route-50", "The paper's route of 12.60 m, 50 Hz"),
        ("route-100", "The paper's route of 12.60 m, 100 Hz"),
        ("two-minutes", "Two minutes through the same flat, 200 Hz"),
    ],
    open: |files| Opened::explorer(read(files)?),
    open_bundled: |name| Opened::explorer(bundled(name)?),
};

fn read(files: &Files) -> Result<Recording, Error> {
    Recording::read(files.required("log")?, files.one("truth"))
}

fn bundled(name: &str) -> Result<Recording, Error> {
    let (walked, rate_hz) = match name {
        "route-50" => (Walked::Route, 50.0),
        "route-100" => (Walked::Route, 100.0),
        "two-minutes" => (Walked::Rounds(7), 200.0),
        _ => return Err(Error::Usage(format!("there is no synthetic walk {name:?}"))),
    };
    Recording::synthetic(walked, rate_hz, 0, 0)
}

/// A walk that is open, with what does not depend on any setting.
struct Opened {
    recording: Recording,
    truth: Vec<TrackPoint>,
    accelerometer: Figure,
    gyroscope: Figure,
    magnitude: Figure,
}

impl Opened {
    fn explorer(recording: Recording) -> Result<Box<dyn Explorer>, Error> {
        let samples = &recording.log.samples;
        let opened = Self {
            truth: recording.truth(),
            accelerometer: figures::accelerometer("accelerometer", samples),
            gyroscope: figures::gyroscope("gyroscope", samples),
            magnitude: figures::magnitude("magnitude", samples),
            recording,
        };
        // What no tracker takes is refused when it is opened, not when a slider is moved.
        opened.traced(trace, &Options::default())?;
        Ok(Box::new(opened))
    }

    fn traced(
        &self,
        tracker: fn(&[Sample], &Options) -> Result<Trace, RunError>,
        options: &Options,
    ) -> Result<Trace, Error> {
        let refused = |source| Error::Walk { path: self.recording.path.clone(), source };
        tracker(&self.recording.log.samples, options).map_err(refused)
    }
}

impl Explorer for Opened {
    fn controls(&self) -> Vec<Control> {
        controls::all()
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let options = controls::options(settings);
        let threshold_g = settings.number("threshold");
        let paper = Options {
            detector: DetectorKind::Magnitude(threshold_g * STANDARD_GRAVITY),
            sensor: options.sensor,
            scalar: options.scalar,
            ..Options::of_the_paper()
        };
        let (ours, (paper, drifting)) = rayon::join(
            || self.traced(trace, &options),
            || (self.traced(trace, &paper), self.traced(without_updates, &options)),
        );
        let (ours, paper, drifting) = (ours?, paper?, drifting?);
        let samples = &self.recording.log.samples;
        let placed = |trace| Placed::new(trace, &self.truth);
        let (with, by_paper) = (placed(&ours), placed(&paper));
        // Without updates the track leaves the plan, and no turn would fit: it lies as ours does.
        let without = Placed { trace: &drifting, placement: with.placement };
        let others = vec![
            by_paper.path("the paper's method, literally").coloured(Colour::Published),
            without.path("without updates").coloured(Colour::Alarm).hidden(),
        ];
        let magnitude = self
            .magnitude
            .clone()
            .with(figures::threshold(samples, threshold_g))
            .with(by_paper.stance("within the threshold").coloured(Colour::Published).hidden())
            .with(with.stance("standing, as detected").coloured(Colour::Ours));
        let mut answer = Answer {
            facts: facts(&ours, self.recording.accuracy(&ours.walk)),
            warnings: self
                .recording
                .log
                .warnings
                .iter()
                .chain(&ours.walk.warnings)
                .cloned()
                .collect(),
            figures: vec![
                figures::path("path", &self.truth, &with, others),
                self.accelerometer.clone(),
                self.gyroscope.clone(),
                magnitude,
                figures::velocity("velocity", &with, &without),
                figures::position("position", &with, &self.truth),
            ],
        };
        answer.fact("stance", controls::in_words(options.detector));
        answer.fact(
            "path by the paper's method, literally",
            format!("{:.2} m", paper.walk.path_length_m),
        );
        Ok(answer)
    }
}

fn facts(trace: &Trace, accuracy: Option<Accuracy>) -> Vec<(String, String)> {
    let walk = &trace.walk;
    let of_the_walk = [
        ("path length", format!("{:.2} m", walk.path_length_m)),
        ("strides", walk.strides.len().to_string()),
        ("start to end", format!("{:.2} m", walk.closure_m)),
    ];
    let of_the_truth = accuracy.iter().flat_map(Accuracy::in_words);
    let facts = of_the_walk.into_iter().chain(of_the_truth);
    facts.map(|(name, value)| (name.trim().to_owned(), value)).collect()
}
