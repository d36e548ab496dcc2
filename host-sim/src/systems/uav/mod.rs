//! The longitudinal motion of a fixed-wing aircraft, estimated by Luenberger observers and Kalman filters.
//!
//! [`recording`] → [`track`] → [`account`]; the [`paper`]'s experiments track the flights that [`simulate`] generates.
//!
//! The states α, q, V, θ and inputs δe, δt are deviations from the flight about which the model was linearised; rad,
//! rad/s, m/s.

#![expect(
    clippy::missing_panics_doc,
    reason = "the designs of the experiment are for the plants of the experiment"
)]

pub mod account;
pub mod figures;
pub mod identify;
mod online;
pub mod paper;
pub mod recording;
pub mod settings;
pub mod track;

pub use kestirim_simulate::uav as simulate;
use kestirim_sweep::{Block, Samples};
use std::path::Path;
use std::sync::Arc;

use kestirim_replay::uav::{self, STATE_COLUMNS};

use self::figures::streams;
use self::paper::{experiment, report};
use self::recording::Recording;
use self::settings::firmware;
use self::track::Track;
use crate::Error;
use crate::report::Chapter;
use crate::stream::Stream;
use crate::system::{
    Account, Answer, Calibration, Detail, FileField, Files, Finding, Idle, OutputField, Panel,
    Plan, RunOptions, Setting, Settings, System, Table,
};

/// The UAV system.
#[derive(Debug, Clone, Copy)]
pub struct Uav;

impl System for Uav {
    const NAME: &'static str = "uav";
    const TITLE: &'static str =
        "angle of attack, pitch rate, airspeed and pitch angle of a fixed-wing aircraft";
    const PAPER: &'static str = "Longitudinal states of a fixed-wing UAV by Luenberger observer and Kalman filter, MSc \
                                 thesis in Turkish, 2020";
    const FILES: &'static [FileField] = &[
        FileField::required(
            "log",
            "Flight: CSV with columns t,delta_e,delta_t and some of alpha,q,V,theta (s, rad, rad/s, m/s); an empty \
             field was not measured; or the log of ArduPilot or PX4, with --units delta_e=",
        )
        .imported(),
        FileField::optional(
            "model",
            "JSON: A (4 × 4), B (4 × 2), perhaps C with the names of its outputs, trim {x, u}, h (s) if A and B are of \
             discrete time, and whatever is known of noise, biases, gusts, wind, trim (the book's chapter on the UAV)",
        )
        .live(),
        FileField::optional(
            "truth",
            "What was really flown: CSV with columns t and some of alpha,q,V,theta; serves accuracy alone",
        ),
    ];
    const SYNTHETIC: &'static [(&'static str, &'static str)] = &[
        ("constant", "Constant inputs, from a wrong start"),
        ("sine", "Sine inputs, from a wrong start"),
    ];
    const OUTPUTS: &'static [OutputField] = &[OutputField {
        name: "track",
        help: "Write t,alpha,q,V,theta, standard deviations and health of each line to this file",
        endings: &["csv"],
    }];
    const PANELS: &'static [Panel] = &[Panel::Angles, Panel::Airspeed];

    type Recording = Recording;
    type Trace = Track;
    type Experiment = report::Report;

    fn settings(_: Option<&Recording>) -> Vec<Setting> {
        settings::table()
    }

    fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
        settings::idle(recording, settings, name)
    }

    fn read(files: &Files, _: &Settings) -> Result<Recording, Error> {
        Recording::read(files)
    }

    fn fits(field: &str, path: &Path, files: &Files) -> bool {
        match field {
            "log" => recording::log::read(path, &STATE_COLUMNS, files.reading.options()).is_ok(),
            "model" => recording::model::read(path).is_ok(),
            _ => recording::log::read_truth(path).is_ok(),
        }
    }

    fn synthetic(name: &str) -> Result<Recording, Error> {
        Recording::synthetic(name)
    }

    fn check(recording: &Recording, _: &Settings) -> Vec<Finding> {
        let Recording::Logged(logged) = recording else {
            return vec![Finding::note("log", "a synthetic flight: nothing is wrong with it")];
        };
        uav::check(&logged.log, logged.model.as_ref())
    }

    fn track(recording: &Recording, settings: &Settings, _: Detail) -> Result<Track, Error> {
        Track::of(recording, settings)
    }

    fn account(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
    ) -> Result<Account, Error> {
        account::account(recording, settings.chosen("estimator"), track)
    }

    fn figures(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
        answer: &mut Answer,
    ) -> Result<(), Error> {
        figures::draw(recording, settings, track, answer)
    }

    fn table(_: &str, recording: &Recording, _: &Settings, track: &Track) -> Table {
        account::table(recording, track)
    }

    fn streams(_: &Recording, _: &Settings, track: &Track) -> Vec<Stream> {
        streams::streams(track)
    }

    fn firmware(recording: Option<&Recording>, settings: &Settings) -> String {
        firmware::firmware(recording, settings)
    }

    fn trials(run: &RunOptions, _: &Settings) -> Result<Vec<Block>, Error> {
        experiment::trials(*run)
    }

    fn experiment(
        run: &RunOptions,
        _: &Settings,
        samples: &[Samples],
    ) -> Result<report::Report, Error> {
        experiment::report(*run, samples)
    }

    fn chapter(experiment: &report::Report) -> Result<Chapter, Error> {
        paper::chapter::chapter(experiment)
    }

    fn identification() -> Option<Box<dyn Calibration>> {
        Some(Box::new(identify::Identify))
    }

    fn online(settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        Ok(Some(Arc::new(online::Flying::new(settings, files)?)))
    }
}

#[cfg(test)]
mod tests;
