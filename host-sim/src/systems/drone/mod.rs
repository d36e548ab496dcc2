//! A drone base station that locates and follows a user on the ground.
//!
//! [`recording`] → [`track`] → [`account`]; the [`paper`]'s experiment tracks the flights that [`simulate`] generates.
//!
//! Frame: a plane in metres (such as east and north), heights above the user.

pub mod account;
pub mod figures;
mod online;
pub mod paper;
mod recorded;
pub mod recording;
pub mod settings;
pub mod track;

pub use kestirim_simulate::drone as simulate;
use std::path::Path;
use std::sync::Arc;

use self::paper::{experiment, report::Report};
use self::recording::Recording;
use crate::Error;
use crate::report::Chapter;
use crate::stream::Stream;
use crate::system::{
    Account, Answer, Detail, FileField, Files, Finding, Idle, OutputField, Panel, Plan, RunOptions,
    Setting, Settings, Study, System, Table,
};
use kestirim_replay::drone::{self, Track};
use kestirim_sweep::{Block, Samples};

/// The drone system.
#[derive(Debug, Clone, Copy)]
pub struct Drone;

impl System for Drone {
    const NAME: &'static str = "drone";
    const TITLE: &'static str = "where a user on the ground is, from the path loss to a drone";
    const PAPER: &'static str = "RSSI localisation of a user by a drone base station with a particle filter, MSc thesis in \
                                 Turkish (MATLAB)";
    const FILES: &'static [FileField] = &[
        FileField::required(
            "log",
            "Flight: CSV with columns t,x,y,h and path_loss_db or rssi_db (s, m, dB), or lat,lon (°) instead of x,y; or a ROS 1 bag or \
             MCAP file with sensor_msgs/NavSatFix and a number that is called rssi",
        )
        .imported(),
        FileField::optional(
            "truth",
            "Where the user really is: CSV with columns x,y and one line (m), of a user who moves t,x,y, of several user,x,y; serves \
             accuracy alone",
        ),
        FileField::optional(
            "area",
            "Where the user can be: CSV with columns x,y, the corners of a polygon (m)",
        )
        .live(),
    ];
    const SYNTHETIC: &'static [(&'static str, &'static str)] = &[
        ("moving", "A user who walks a circle in 4000 m × 4000 m, followed by the drone"),
        ("staying", "A user who stays in 2000 m × 2000 m, measured from a circle or a grid"),
    ];
    const OUTPUTS: &'static [OutputField] = &[OutputField {
        name: "track",
        help: "Write t,x,y,sd and health of each measurement to this file",
        endings: &["csv"],
    }];
    const PANELS: &'static [Panel] = &[Panel::Map, Panel::Losses];
    const RECORDED: &'static [Study] = recorded::STUDIES;

    type Recording = Recording;
    type Trace = Track;
    type Experiment = Report;

    fn settings(recording: Option<&Recording>) -> Vec<Setting> {
        settings::table(recording)
    }

    fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
        settings::idle(recording, settings, name)
    }

    fn read(files: &Files, _: &Settings) -> Result<Recording, Error> {
        Recording::read(files)
    }

    fn fits(field: &str, path: &Path, files: &Files) -> bool {
        match field {
            "log" => {
                let options = files.reading.tables();
                options.is_ok_and(|options| recording::flight::read(path, options).is_ok())
            }
            "truth" => recording::truth::Truth::read(path, None).is_ok(),
            _ => recording::area::read(path, None).is_ok(),
        }
    }

    fn synthetic(name: &str) -> Result<Recording, Error> {
        Recording::synthetic(name)
    }

    fn check(recording: &Recording, _: &Settings) -> Vec<Finding> {
        let Recording::Flight(recorded) = recording else {
            return vec![Finding::note("log", "a synthetic flight: nothing is wrong with it")];
        };
        let flight = &recorded.flight;
        drone::check(&flight.stops, flight.quantity, flight.unusable)
    }

    fn track(recording: &Recording, settings: &Settings, detail: Detail) -> Result<Track, Error> {
        track::track(recording, settings, detail)
    }

    fn account(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
    ) -> Result<Account, Error> {
        account::account(recording, settings, track)
    }

    fn figures(
        recording: &Recording,
        settings: &Settings,
        track: &Track,
        answer: &mut Answer,
    ) -> Result<(), Error> {
        figures::draw(recording, settings, track, answer);
        Ok(())
    }

    fn table(_: &str, recording: &Recording, settings: &Settings, track: &Track) -> Table {
        account::table(recording, settings, track)
    }

    fn streams(_: &Recording, _: &Settings, track: &Track) -> Vec<Stream> {
        figures::streams::streams(track)
    }

    fn firmware(recording: Option<&Recording>, settings: &Settings) -> String {
        settings::firmware(recording, settings)
    }

    fn cell() -> Vec<Setting> {
        settings::cell::table()
    }

    fn cell_idle(cell: &Settings, name: &str) -> Option<Idle> {
        settings::cell::idle(cell, name)
    }

    fn trials(run: &RunOptions, cell: &Settings) -> Result<Vec<Block>, Error> {
        experiment::trials(run, cell)
    }

    fn experiment(run: &RunOptions, cell: &Settings, samples: &[Samples]) -> Result<Report, Error> {
        experiment::report(run, cell, samples)
    }

    fn chapter(report: &Report) -> Result<Chapter, Error> {
        paper::chapter::chapter(report)
    }

    fn online(settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        Ok(Some(Arc::new(online::Listening::read(settings, files)?)))
    }
}

#[cfg(test)]
mod tests;
