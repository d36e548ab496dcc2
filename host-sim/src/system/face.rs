//! The one face of a system.

use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

use kestirim_replay::Finding;
use kestirim_sweep::{Block, Samples};
use serde::Serialize;

use super::account::{Account, Answer, Table};
use super::files::{FileField, Files};
use super::idle::Idle;
use super::online::{Panel, Plan};
use super::recorded::Study;
use super::run::RunOptions;
use super::setting::Setting;
use super::settings::Settings;
use crate::Error;
use crate::report::Chapter;
use crate::stream::Stream;

/// A table that a replay writes where it is asked to.
#[derive(Debug, Clone, Copy)]
pub struct OutputField {
    /// The option's name.
    pub name: &'static str,
    /// What stands in it, with its columns.
    pub help: &'static str,
    /// Endings of a file that say what it is written as, the table's first.
    pub endings: &'static [&'static str],
}

/// How much of a track is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// What the account needs.
    Result,
    /// Every moment, to be drawn or written.
    Every,
}

/// A system: sensors, estimator, and what is asked of them.
pub trait System: Sync + 'static {
    /// Its name on the command line.
    const NAME: &'static str;
    /// What it does, in a few words.
    const TITLE: &'static str;
    /// The paper it is from.
    const PAPER: &'static str;
    /// The files that make a recording.
    const FILES: &'static [FileField];
    /// Synthetic recordings that need no file: name and what people call it, the default first.
    const SYNTHETIC: &'static [(&'static str, &'static str)];
    /// Tables that a replay writes where it is asked to.
    const OUTPUTS: &'static [OutputField];
    /// Settings that say something about the recording itself: its [`check`](Self::check) depends on no others.
    const CHECKED: &'static [&'static str] = &[];
    /// Figures of a stream that is followed while it comes; none if no estimator follows one.
    const PANELS: &'static [Panel] = &[];
    /// Whether the stream that is followed is the device's own, in place of telemetry: its estimator hears the bytes.
    const HEARS_BYTES: bool = false;
    /// Recordings that its results are told of, for the report; none if there are none.
    const RECORDED: &'static [Study] = &[];

    /// What is read.
    type Recording: Send + Sync;
    /// What the estimator made of it.
    type Trace: Send + Sync;
    /// What came of the paper's experiment.
    type Experiment: Serialize + Display;

    /// What can be set: the options of `replay` and `live`, and the page's controls. What depends on the
    /// recording is narrower where that is known; a default that depends on it is none.
    fn settings(recording: Option<&Self::Recording>) -> Vec<Setting>;

    /// Why a setting has no effect as the recording and the others are; none if it has. Without a recording all
    /// that could be read are meant.
    fn idle(
        _recording: Option<&Self::Recording>,
        _settings: &Settings,
        _name: &str,
    ) -> Option<Idle> {
        None
    }

    /// Why these settings give no tables and no streams to write, in words that complete `--track …`; none if
    /// they do.
    fn lacks_output(_settings: &Settings) -> Option<&'static str> {
        None
    }

    /// Reads a recording. Settings tell no more than how to read.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    fn read(files: &Files, settings: &Settings) -> Result<Self::Recording, Error>;

    /// Whether a file can be what a field of the [`FILES`](Self::FILES) holds: it is read as that, beside the `files` that
    /// are known already.
    fn fits(field: &str, path: &Path, files: &Files) -> bool;

    /// A synthetic recording by name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    fn synthetic(name: &str) -> Result<Self::Recording, Error>;

    /// What the recording shows before an estimator has seen it: what is measured how often, what is missing, what
    /// contradicts itself, what comes of that and what to do.
    fn check(_recording: &Self::Recording, _settings: &Settings) -> Vec<Finding> {
        Vec::new()
    }

    /// Feeds the estimator.
    ///
    /// # Errors
    /// One sentence, if recording and settings give nothing.
    fn track(
        recording: &Self::Recording,
        settings: &Settings,
        detail: Detail,
    ) -> Result<Self::Trace, Error>;

    /// What came of it.
    ///
    /// # Errors
    /// As [`track`](Self::track).
    fn account(
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
    ) -> Result<Account, Error>;

    /// Figures for the page, and facts of what they compare with. Always the same figures in the same order.
    ///
    /// # Errors
    /// As [`track`](Self::track).
    fn figures(
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
        answer: &mut Answer,
    ) -> Result<(), Error>;

    /// The text of one of the [`OUTPUTS`](Self::OUTPUTS) as the ending of its file asks for; none: the table.
    fn text(
        _output: &str,
        _ending: &str,
        _recording: &Self::Recording,
        _trace: &Self::Trace,
    ) -> Option<String> {
        None
    }

    /// The table of one of the [`OUTPUTS`](Self::OUTPUTS).
    fn table(
        output: &str,
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
    ) -> Table;

    /// What the sensors said, the estimate, and the truth as far as it is known, for other programs.
    fn streams(
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
    ) -> Vec<Stream>;

    /// The same settings in firmware: a `Config` literal of the system's crate that says what differs from the
    /// default. What firmware has no setting for is left out.
    fn firmware(recording: Option<&Self::Recording>, settings: &Settings) -> String;

    /// What can be set of the experiment.
    fn cell() -> Vec<Setting> {
        Vec::new()
    }

    /// Why a setting of the experiment has no effect as the others are; none if it has.
    fn cell_idle(_cell: &Settings, _name: &str) -> Option<Idle> {
        None
    }

    /// What the paper's experiment tries on synthetic streams, or what of it the `cell` asks for.
    ///
    /// # Errors
    /// [`Error::Usage`] for options that it does not have.
    fn trials(run: &RunOptions, cell: &Settings) -> Result<Vec<Block>, Error>;

    /// What comes of the numbers of these trials.
    ///
    /// # Errors
    /// As [`trials`](Self::trials).
    fn experiment(
        run: &RunOptions,
        cell: &Settings,
        samples: &[Samples],
    ) -> Result<Self::Experiment, Error>;

    /// The system's part of the report.
    ///
    /// # Errors
    /// None that the experiment itself did not have.
    fn chapter(experiment: &Self::Experiment) -> Result<Chapter, Error>;

    /// What follows a stream while it comes; none if no estimator does.
    ///
    /// # Errors
    /// Whatever is wrong with files and settings.
    fn online(_settings: &Settings, _files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        Ok(None)
    }

    /// The command that finds where a system's stations are, from what they measure of each other; none if there is none.
    fn survey() -> Option<Box<dyn Calibration>> {
        None
    }

    /// The command that finds what the sensors measure wrong; none if there is none.
    fn calibration() -> Option<Box<dyn Calibration>> {
        None
    }

    /// The command that finds the model of what moves; none if there is none.
    fn identification() -> Option<Box<dyn Calibration>> {
        None
    }
}

/// A command that finds what a system's sensors measure wrong, or how what carries them moves.
pub trait Calibration {
    /// Its options, and what it does.
    fn command(&self) -> clap::Command;

    /// Reads, calibrates, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is written.
    fn run(&self, matches: &clap::ArgMatches) -> Result<(), Error>;

    /// What looks at a stream while it is made for a calibration, tells what to do next, and writes the calibration to a
    /// file at its end; none if only a log will do.
    fn watch(&self, _to: &Path) -> Option<Arc<dyn Plan>> {
        None
    }
}
