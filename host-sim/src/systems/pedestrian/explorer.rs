//! The paper's interface in the browser: a walk, a threshold, and what becomes of the path.

use clap::ValueEnum;

use super::accuracy::Accuracy;
use super::figures::{self, Placed};
use super::options::{DetectorKind, Options, SensorClass, TrackerKind};
use super::recording::{Recording, Walked};
use super::run::RunError;
use super::trace::{Trace, trace, without_updates};
use super::track::TrackPoint;
use super::{STANDARD_GRAVITY, Sample};
use crate::Error;
use crate::cli::ScalarKind;
use crate::explore::{Answer, Control, Explorer, FileField, Files, Settings, Source};
use crate::figure::{Colour, Figure};

/// Where walks come from.
pub const SOURCE: Source = Source {
    system: "pedestrian",
    title: "Where a foot walked, from a foot-mounted IMU",
    files: &[
        FileField {
            name: "log",
            label: "Recorded walk: CSV t,ax,ay,az,gx,gy,gz (s, m/s², rad/s), or Razor text (ms, 3 × g, 3 × °/s)",
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
        let [low, high] = [0.05, 0.5];
        vec![
            Control::choice(
                "tracker",
                "tracker",
                &[("ekf", "error-state Kalman filter"), ("lite", "the paper's architecture")],
            ),
            Control::choice(
                "detector",
                "stance detector",
                &[
                    ("adaptive", "adaptive, no threshold"),
                    ("magnitude", "magnitude |a|, the paper's"),
                    ("variance", "variance of |a|"),
                    ("angular-rate", "angular rate"),
                    ("shoe", "SHOE, fixed threshold"),
                ],
            ),
            Control::slider("threshold", "threshold of |a| about 1 g", "g", [low, high, 0.01], 0.1),
            Control::decades(
                "factor",
                "thresholds of variance, angular rate and SHOE, times their defaults",
                "",
                [0.1, 10.0],
                1.0,
            ),
            Control::choice(
                "sensor",
                "class of the sensor",
                &[("consumer", "consumer: bare chips"), ("industrial", "industrial: calibrated")],
            ),
            Control::slider(
                "contact_height",
                "sensor above the ball of the foot; 0 takes the foot for motionless, as the paper does",
                "m",
                [0.0, 0.2, 0.01],
                0.07,
            ),
            Control::switch("causal", "look only backwards, as firmware must", false),
            Control::choice(
                "scalar",
                "number type",
                &[("f32", "f32"), ("f64", "f64"), ("fixed", "fixed point, Q12.20")],
            ),
        ]
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let options = options(settings);
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
        answer.fact("stance", threshold_in_words(options.detector));
        answer.fact(
            "path by the paper's method, literally",
            format!("{:.2} m", paper.walk.path_length_m),
        );
        Ok(answer)
    }
}

fn options(settings: &Settings) -> Options {
    let default = Options::default();
    let factor = settings.number("factor");
    let detector = match settings.choice("detector") {
        "magnitude" => DetectorKind::Magnitude(settings.number("threshold") * STANDARD_GRAVITY),
        "variance" => DetectorKind::Variance(factor * DetectorKind::VARIANCE_THRESHOLD),
        "angular-rate" => DetectorKind::AngularRate(factor * DetectorKind::ANGULAR_RATE_THRESHOLD),
        "shoe" => DetectorKind::Shoe(factor * DetectorKind::SHOE_THRESHOLD),
        _ => DetectorKind::Adaptive,
    };
    let exactly = false;
    Options {
        tracker: TrackerKind::from_str(settings.choice("tracker"), exactly).unwrap_or_default(),
        detector,
        sensor: SensorClass::from_str(settings.choice("sensor"), exactly).unwrap_or_default(),
        contact_height_m: Some(settings.number("contact_height")),
        causal: settings.is_on("causal"),
        scalar: ScalarKind::from_str(settings.choice("scalar"), exactly).unwrap_or(default.scalar),
    }
}

fn threshold_in_words(detector: DetectorKind) -> String {
    match detector {
        DetectorKind::Adaptive => "near the quietest moments around".to_owned(),
        DetectorKind::Magnitude(value) => {
            format!("|a| within {:.2} g of 1 g", value / STANDARD_GRAVITY)
        }
        DetectorKind::Variance(value) => format!("variance of |a| below {value:.3} (m/s²)²"),
        DetectorKind::AngularRate(value) => format!("mean |ω|² below {value:.3} (rad/s)²"),
        DetectorKind::Shoe(value) => format!("SHOE's T below {value:.3} (rad/s)²"),
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

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    fn answer(explorer: &dyn Explorer, sent: &Value) -> Answer {
        let sent = sent.as_object().cloned().unwrap_or_default();
        explorer.answer(&Settings::sent(&explorer.controls(), &sent).unwrap()).unwrap()
    }

    fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
        answer.figures.iter().find(|figure| figure.id == id).unwrap()
    }

    fn fact<'a>(answer: &'a Answer, name: &str) -> &'a str {
        &answer.facts.iter().find(|(found, _)| found == name).unwrap().1
    }

    #[test]
    fn every_bundled_walk_opens_with_the_same_figures_and_is_walked_well() {
        for (name, _) in SOURCE.bundled {
            let opened = (SOURCE.open_bundled)(name).unwrap();
            let answer = answer(&*opened, &json!({}));
            let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
            let expected =
                ["path", "accelerometer", "gyroscope", "magnitude", "velocity", "position"];
            assert_eq!(ids, expected, "{name}");
            let rmse: f64 = fact(&answer, "RMSE").trim_end_matches(" m").parse().unwrap();
            assert!(rmse < 1.0, "{name}: {rmse} m");
            assert!(answer.warnings.is_empty(), "{name}: {:?}", answer.warnings);
        }
    }

    #[test]
    fn the_threshold_moves_its_lines_and_the_path() {
        let opened = (SOURCE.open_bundled)("route-50").unwrap();
        let at = |threshold| {
            answer(&*opened, &json!({ "detector": "magnitude", "threshold": threshold }))
        };
        let (low, high) = (at(0.1), at(0.4));
        for id in ["path", "magnitude", "velocity", "position"] {
            assert_ne!(figure(&low, id), figure(&high, id), "{id}");
        }
        for id in ["accelerometer", "gyroscope"] {
            assert_eq!(figure(&low, id), figure(&high, id), "{id}");
        }
        assert_ne!(fact(&low, "path length"), fact(&high, "path length"));
    }

    #[test]
    fn every_other_control_changes_the_path() {
        let opened = (SOURCE.open_bundled)("route-100").unwrap();
        let path = |sent: Value| figure(&answer(&*opened, &sent), "path").clone();
        let initial = path(json!({}));
        for sent in [
            json!({ "tracker": "lite" }),
            json!({ "detector": "shoe" }),
            json!({ "sensor": "industrial" }),
            json!({ "contact_height": 0.0 }),
            json!({ "causal": true }),
            json!({ "scalar": "fixed" }),
        ] {
            assert_ne!(initial, path(sent.clone()), "{sent}");
        }
        let fixed = |factor: f64| path(json!({ "detector": "variance", "factor": factor }));
        assert_ne!(fixed(1.0), fixed(5.0));
    }

    #[test]
    fn the_initial_settings_are_those_of_the_command_line() {
        let opened = (SOURCE.open_bundled)("route-100").unwrap();
        let initial = options(&Settings::initial(&opened.controls()));
        let default = Options { contact_height_m: Some(0.07), ..Options::default() };
        assert_eq!(initial, default);
    }

    #[test]
    fn what_cannot_be_walked_is_refused_in_one_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("walk.txt");
        let mut files = Files::default();
        files.add("log", &path);
        for (text, expected) in [
            ("", "found an empty file"),
            ("0 0 0 1 0 0 0\n10 0 0 1 0 0\n", "line 2: expected 7 blank-separated fields"),
            ("0 0 0 1 0 0 0\n", "expected a log of at least 2 samples, found 1"),
        ] {
            std::fs::write(&path, text).unwrap();
            let refusal = (SOURCE.open)(&files).err().unwrap().to_string();
            assert!(refusal.contains(expected) && !refusal.contains('\n'), "{refusal}");
        }
        assert!((SOURCE.open)(&Files::default()).is_err());
        assert!((SOURCE.open_bundled)("the moon").is_err());
    }
}
