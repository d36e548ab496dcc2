//! A foot-mounted IMU with zero-velocity updates.
//!
//! [`recording`] → [`track`] → [`account`]; the [`paper`]'s experiment tracks the walks that [`simulate`] generates,
//! and `calibrate` determines the errors of the IMU.
//!
//! Frames: *body* is the sensor's own, as mounted on the foot; *room* is right-handed with z up, its
//! origin at the start of the walk.

pub mod account;
mod calibrate;
pub mod figures;
mod online;
pub mod paper;
mod recorded;
pub mod recording;
pub mod settings;
pub mod strides;
pub mod track;

pub use kestirim_simulate::pedestrian as simulate;
use std::path::Path;
use std::sync::Arc;

use kestirim_replay::pedestrian;
pub use kestirim_replay::pedestrian::Sample;
use kestirim_sweep::{Block, Samples};

use self::calibrate::Calibrate;
use self::figures::streams;
use self::paper::experiment;
use self::recording::{Recording, Walked, calibration};
use self::settings::options;
use self::track::{Track, class_of};
use crate::Error;
use crate::report::Chapter;
use crate::stream::Stream;
use crate::system::{
    Account, Answer, Calibration, Detail, FileField, Files, Finding, Idle, OutputField, Panel,
    Plan, RunOptions, Setting, Settings, Study, System, Table,
};
use crate::table;

/// The pedestrian system.
#[derive(Debug, Clone, Copy)]
pub struct Pedestrian;

impl System for Pedestrian {
    const NAME: &'static str = "pedestrian";
    const TITLE: &'static str = "where a foot walked, from a foot-mounted IMU";
    const PAPER: &'static str = "Aydın and Erken, JESD, doi:10.21923/jesd.450256";
    const FILES: &'static [FileField] = &[
        FileField::required(
            "log",
            "Recorded walk: text of any device with time, acceleration and angular rate, whose units and columns are \
             found; gt_x,gt_y,gt_z in m = truth",
        )
        .imported(),
        FileField::optional(
            "truth",
            "Measured footprints: CSV t,x,y (s, m); replaces a truth that the log carries",
        ),
        FileField::optional(
            "other-foot",
            "Log of the other foot, or of a second sensor on this one, on the same clock and read as --log: both paths stay \
             together; not causally",
        ),
        FileField::optional(
            "calibration",
            "What the IMU measures wrong: CSV parameter,value, as calibrate pedestrian writes it",
        )
        .live(),
    ];
    const SYNTHETIC: &'static [(&'static str, &'static str)] = &[
        ("route-50", "The paper's route of 12.60 m, 50 Hz"),
        ("route-100", "The paper's route of 12.60 m, 100 Hz"),
        ("two-minutes", "Two minutes through the same flat, 200 Hz"),
    ];
    const OUTPUTS: &'static [OutputField] = &[
        OutputField {
            name: "track",
            help: "Write t,x,y,z, standard deviations and health of every (averaged) sample to this file",
            endings: &["csv"],
        },
        OutputField {
            name: "strides",
            help: "Write number, time (s), length, height change (m), duration (s), speed (m/s) and heading (°, anticlockwise \
                   from how the foot pointed at the start) of every stride to this file",
            endings: &["csv"],
        },
    ];
    const PANELS: &'static [Panel] = &[Panel::Map, Panel::Forces, Panel::Rates];
    const RECORDED: &'static [Study] = recorded::STUDIES;

    type Recording = Recording;
    type Trace = Track;
    type Experiment = experiment::Report;

    fn settings(recording: Option<&Recording>) -> Vec<Setting> {
        settings::table(recording.map(Recording::rates_hz))
    }

    fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
        settings::idle(recording.map(|it| it.log.field.is_some()), settings, name)
    }

    fn read(files: &Files, _: &Settings) -> Result<Recording, Error> {
        let calibration = files.one("calibration").map(calibration::read).transpose()?;
        let options = files.reading.options();
        let mut recording = Recording::read(files.required("log")?, files.one("truth"), options)?;
        if let Some(calibration) = calibration {
            recording = recording.calibrated(calibration);
        }
        if let Some(path) = files.one("other-foot") {
            recording.other_foot = Some(Box::new(Recording::read(path, None, options)?));
        }
        Ok(recording)
    }

    fn fits(field: &str, path: &Path, files: &Files) -> bool {
        match field {
            "log" | "other-foot" => recording::log::read(path, files.reading.options()).is_ok(),
            "truth" => table::has(path, ["t", "x", "y"]),
            _ => calibration::read(path).is_ok(),
        }
    }

    fn synthetic(name: &str) -> Result<Recording, Error> {
        let (walked, rate_hz) = match name {
            "route-50" => (Walked::Route, 50.0),
            "route-100" => (Walked::Route, 100.0),
            "two-minutes" => (Walked::Rounds(7), 200.0),
            _ => return Err(Error::Usage(format!("there is no synthetic walk {name:?}"))),
        };
        Recording::synthetic(walked, rate_hz, 0, 0)
    }

    fn check(recording: &Recording, _: &Settings) -> Vec<Finding> {
        pedestrian::check(recording.measured())
    }

    fn track(recording: &Recording, settings: &Settings, detail: Detail) -> Result<Track, Error> {
        Track::of(recording, settings, detail)
    }

    fn account(recording: &Recording, _: &Settings, track: &Track) -> Result<Account, Error> {
        account::account(track.tracked(recording), &track.trace.walk)
    }

    fn figures(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
        answer: &mut Answer,
    ) -> Result<(), Error> {
        let recording = track.tracked(recording);
        let options = options(settings).with_sensor(|| class_of(recording));
        figures::draw(recording, &options, &track.trace, answer)
    }

    fn table(output: &str, _: &Recording, _: &Settings, track: &Track) -> Table {
        match output {
            "strides" => strides::table(&track.trace.walk),
            _ => account::table(&track.trace.walk),
        }
    }

    fn streams(recording: &Recording, _: &Settings, track: &Track) -> Vec<Stream> {
        let recording = track.tracked(recording);
        streams::streams(&recording.log.samples, &track.trace, &recording.truth())
    }

    fn firmware(recording: Option<&Recording>, settings: &Settings) -> String {
        let options = options(settings);
        let options = recording.map_or(options, |it| options.with_sensor(|| class_of(it)));
        let firmware = settings::firmware(&options);
        match recording.and_then(Recording::calibration) {
            Some(known) => format!("{firmware}\n\n{}", calibration::firmware(known)),
            None => firmware,
        }
    }

    fn trials(run: &RunOptions, _: &Settings) -> Result<Vec<Block>, Error> {
        experiment::trials(*run)
    }

    fn experiment(
        run: &RunOptions,
        _: &Settings,
        samples: &[Samples],
    ) -> Result<experiment::Report, Error> {
        experiment::report(*run, samples)
    }

    fn chapter(experiment: &experiment::Report) -> Result<Chapter, Error> {
        paper::chapter::chapter(experiment)
    }

    fn online(settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        let calibration = files.one("calibration").map(calibration::read).transpose()?;
        Ok(Some(Arc::new(online::Walking { options: options(settings), calibration })))
    }

    fn calibration() -> Option<Box<dyn Calibration>> {
        Some(Box::new(Calibrate))
    }
}

#[cfg(test)]
mod tests;
