//! A robot among ultra-wideband anchors.
//!
//! [`recording`] → [`track`] → [`account`]; the [`paper`]'s experiment tracks what [`simulate`] generates, and
//! `calibrate` determines the biases of the anchors.
//!
//! Frame: *room*, right-handed with z up, as the anchors are given.

pub mod account;
mod calibrate;
pub mod figures;
mod height;
pub mod links;
mod online;
pub mod paper;
mod recorded;
pub mod recording;
pub mod settings;
mod survey;
pub mod track;

pub use kestirim_simulate::robot as simulate;
use std::path::Path;
use std::sync::Arc;

use kestirim_replay::robot;
use kestirim_sweep::{Block, Samples};

use self::calibrate::Calibrate;
use self::figures::streams;
use self::online::Tag;
use self::paper::experiment;
use self::recording::{Driven, Recording};
use self::simulate::scenario::office_anchors;
use self::track::Tracks;
use crate::Error;
use crate::report::Chapter;
use crate::stream::Stream;
use crate::system::{
    Account, Answer, Calibration, Detail, FileField, Files, Finding, Idle, OutputField, Panel,
    Plan, RunOptions, Setting, Settings, Study, System, Table,
};

/// The robot system.
#[derive(Debug, Clone, Copy)]
pub struct Robot;

impl System for Robot {
    const NAME: &'static str = "robot";
    const TITLE: &'static str =
        "where a tag is, from ranges to ultra-wideband anchors, with or without IMU and wheels";
    const PAPER: &'static str = "Ultra-wideband ranging and an IMU on an ESP32 (in Turkish)";
    const FILES: &'static [FileField] = &[
        FileField::required("anchors", "Anchors: CSV anchor,x,y,z (m)").live(),
        FileField::required(
            "log",
            "Ranges: CSV t,anchor,range (s, m) of a moving tag, stamps t,anchor,t1,…,t6, differences \
             t,anchor_a,anchor_b,difference, or with --points point,k,anchor,range (m) of a tag \
             put down, epochs k 0.1 s apart; or a ROS 1 bag or MCAP file with messages of ranges",
        )
        .imported(),
        FileField::optional(
            "truth",
            "True track of a moving tag: CSV t,x,y (s, m); serves accuracy alone",
        ),
        FileField::optional(
            "points",
            "Marked points of a tag put down: CSV point,x,y,z (m); x and y serve accuracy alone",
        ),
        FileField::optional(
            "imu",
            "IMU: CSV t and any of qw,qx,qy,qz gx,gy,gz ax,ay,az lax,lay,laz (SI, body)",
        ),
        FileField::optional("odom", "Wheels: CSV t,v_left,v_right,track (s, m/s, m)"),
        FileField::optional(
            "calibration",
            "What the anchors measure too long: CSV anchor,bias (m), as calibrate robot writes it",
        )
        .live(),
        FileField::optional(
            "height",
            "Heights of the tag: CSV t,z, or with --points point,z (s, m)",
        ),
    ];
    const SYNTHETIC: &'static [(&'static str, &'static str)] = &[
        ("line", "The paper's office: a straight line"),
        ("points", "The paper's office: fifteen points, 50 epochs each"),
        ("crowded-round", "The paper's office: a round, with somebody before each anchor in turn"),
    ];
    const OUTPUTS: &'static [OutputField] = &[OutputField {
        name: "track",
        help: "Write t,x,y,z (point,x,y,z with --points), standard deviations and health of every epoch to this file, with --smooth the smoothed ones",
        endings: &["csv"],
    }];
    const CHECKED: &'static [&'static str] = &["height", "dim", "calibrated", "room"];
    const PANELS: &'static [Panel] = &[Panel::Map, Panel::Ranges];
    const RECORDED: &'static [Study] = recorded::STUDIES;

    type Recording = Recording;
    type Trace = Tracks;
    type Experiment = experiment::Report;

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
        Recording::fits(field, path, files)
    }

    fn synthetic(name: &str) -> Result<Recording, Error> {
        let driven = match name {
            "line" => Driven::Line,
            "points" => Driven::Points,
            "crowded-round" => Driven::CrowdedRound,
            _ => return Err(Error::Usage(format!("there is no synthetic recording {name:?}"))),
        };
        Ok(Recording::synthetic(driven, 0))
    }

    fn check(recording: &Recording, settings: &Settings) -> Vec<Finding> {
        let parts = recording.parts.iter().map(|part| part.events.as_slice());
        let height = settings::known_height(recording, settings);
        let setup = settings::of(settings, &recording.anchors, recording.biases.as_deref());
        let (room_is_known, biases) = (setup.room.is_some(), setup.biases.as_deref());
        robot::check(&recording.anchors, parts, height, room_is_known, biases)
    }

    fn track(recording: &Recording, settings: &Settings, _: Detail) -> Result<Tracks, Error> {
        let setup = settings::of_recording(recording, settings)?;
        if settings.is_on("smooth") {
            return Tracks::smoothed_too(recording, &setup);
        }
        Ok(Tracks { traces: track::track(recording, &setup)?, smoothed: None })
    }

    fn account(
        recording: &Recording,
        settings: &Settings,
        tracks: &Tracks,
    ) -> Result<Account, Error> {
        account::account(recording, settings, tracks)
    }

    fn figures(
        recording: &Recording,
        settings: &Settings,
        tracks: &Tracks,
        answer: &mut Answer,
    ) -> Result<(), Error> {
        figures::draw(recording, &settings::of_recording(recording, settings)?, tracks, answer)
    }

    fn table(_: &str, recording: &Recording, _: &Settings, tracks: &Tracks) -> Table {
        account::table(recording, tracks)
    }

    fn streams(recording: &Recording, _: &Settings, tracks: &Tracks) -> Vec<Stream> {
        streams::streams(recording, tracks)
    }

    fn firmware(recording: Option<&Recording>, settings: &Settings) -> String {
        let setup = match recording {
            Some(recording) => settings::of_recording(recording, settings),
            None => Ok(settings::of(settings, &office_anchors(), None)),
        };
        let said = |setup| settings::firmware::firmware(&setup, recording.is_some());
        setup.map_or_else(|error| format!("// {error}"), said)
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
        Ok(Some(Arc::new(Tag::read(settings, files)?)))
    }

    fn survey() -> Option<Box<dyn Calibration>> {
        Some(Box::new(survey::Survey))
    }

    fn calibration() -> Option<Box<dyn Calibration>> {
        Some(Box::new(Calibrate))
    }
}

#[cfg(test)]
mod tests;
