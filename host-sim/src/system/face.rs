//! The common interface of all systems.

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

/// A table that a replay can write.
#[derive(Debug, Clone, Copy)]
pub struct OutputField {
    /// The name of the option.
    pub name: &'static str,
    /// The contents of the table, with its columns.
    pub help: &'static str,
    /// The file name endings that select a format, the table's first.
    pub endings: &'static [&'static str],
}

/// How much of a track is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// As much as the account needs.
    Result,
    /// Every moment, to be drawn or written.
    Every,
}

/// A system: its sensors, its estimator, and the questions asked of them.
pub trait System: Sync + 'static {
    /// The name on the command line.
    const NAME: &'static str;
    /// What it does, in a few words.
    const TITLE: &'static str;
    /// The paper that the system is from.
    const PAPER: &'static str;
    /// The files that make up a recording.
    const FILES: &'static [FileField];
    /// Synthetic recordings that need no file: name and description, the default first.
    const SYNTHETIC: &'static [(&'static str, &'static str)];
    /// The tables that a replay can write.
    const OUTPUTS: &'static [OutputField];
    /// Settings that describe the recording itself: its [`check`](Self::check) depends on no others.
    const CHECKED: &'static [&'static str] = &[];
    /// The figures of a live stream; none if no estimator follows one.
    const PANELS: &'static [Panel] = &[];
    /// Whether a live stream consists of the device's own bytes in place of telemetry, which the estimator decodes
    /// itself.
    const HEARS_BYTES: bool = false;
    /// The recordings whose results the report shows; none if there are none.
    const RECORDED: &'static [Study] = &[];

    /// A recording in memory.
    type Recording: Send + Sync;
    /// The estimator's output for a recording.
    type Trace: Send + Sync;
    /// The result of the paper's experiment.
    type Experiment: Serialize + Display;

    /// The available settings: the options of `replay` and `live`, and the page's controls. Ranges that depend on the
    /// recording are narrower if it is known; a default that depends on the recording is `None`.
    fn settings(recording: Option<&Self::Recording>) -> Vec<Setting>;

    /// Why a setting has no effect given the recording and the other settings; `None` if it has one. Without a
    /// recording, the answer holds for all possible ones.
    fn idle(
        _recording: Option<&Self::Recording>,
        _settings: &Settings,
        _name: &str,
    ) -> Option<Idle> {
        None
    }

    /// Why these settings give no tables and no streams to write, in words that complete `--track …`; `None` if they
    /// do.
    fn lacks_output(_settings: &Settings) -> Option<&'static str> {
        None
    }

    /// Reads a recording. The settings affect only how it is read.
    ///
    /// # Errors
    /// An error that names the file, the line, and what was expected there.
    fn read(files: &Files, settings: &Settings) -> Result<Self::Recording, Error>;

    /// Whether a file can be what a field of the [`FILES`](Self::FILES) holds: it is read as such, together with the
    /// `files` that are already known.
    fn fits(field: &str, path: &Path, files: &Files) -> bool;

    /// Generates a synthetic recording by name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    fn synthetic(name: &str) -> Result<Self::Recording, Error>;

    /// Findings about the recording itself, made before any estimator has run: what is measured how often, what is
    /// missing, what is contradictory, the consequences and the remedies.
    fn check(_recording: &Self::Recording, _settings: &Settings) -> Vec<Finding> {
        Vec::new()
    }

    /// Runs the estimator over a recording.
    ///
    /// # Errors
    /// A one-sentence error if the recording and the settings give no result.
    fn track(
        recording: &Self::Recording,
        settings: &Settings,
        detail: Detail,
    ) -> Result<Self::Trace, Error>;

    /// Evaluates a track.
    ///
    /// # Errors
    /// Those of [`track`](Self::track).
    fn account(
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
    ) -> Result<Account, Error>;

    /// Adds the figures of the page to `answer`, and facts about what they compare with: always the same figures in the
    /// same order.
    ///
    /// # Errors
    /// Those of [`track`](Self::track).
    fn figures(
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
        answer: &mut Answer,
    ) -> Result<(), Error>;

    /// The text of one of the [`OUTPUTS`](Self::OUTPUTS) in the format that the file name's ending selects; `None` if
    /// that is the table.
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

    /// The sensor data, the estimate, and the truth as far as it is known, for other programs.
    fn streams(
        recording: &Self::Recording,
        settings: &Settings,
        trace: &Self::Trace,
    ) -> Vec<Stream>;

    /// The equivalent configuration of firmware: a `Config` literal of the system's crate with what differs from the
    /// default. Settings that firmware lacks are left out.
    fn firmware(recording: Option<&Self::Recording>, settings: &Settings) -> String;

    /// The settings of the experiment.
    fn cell() -> Vec<Setting> {
        Vec::new()
    }

    /// Why a setting of the experiment has no effect given the others; `None` if it has one.
    fn cell_idle(_cell: &Settings, _name: &str) -> Option<Idle> {
        None
    }

    /// The trials of the paper's experiment on synthetic streams, or the part of it that the `cell` selects.
    ///
    /// # Errors
    /// [`Error::Usage`] for options that the experiment does not have.
    fn trials(run: &RunOptions, cell: &Settings) -> Result<Vec<Block>, Error>;

    /// Evaluates the samples of the trials.
    ///
    /// # Errors
    /// Those of [`trials`](Self::trials).
    fn experiment(
        run: &RunOptions,
        cell: &Settings,
        samples: &[Samples],
    ) -> Result<Self::Experiment, Error>;

    /// The system's part of the report.
    ///
    /// # Errors
    /// No others than those of the experiment.
    fn chapter(experiment: &Self::Experiment) -> Result<Chapter, Error>;

    /// The plan of an estimator that follows a live stream; `None` if there is none.
    ///
    /// # Errors
    /// Errors in the files and settings.
    fn online(_settings: &Settings, _files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        Ok(None)
    }

    /// The command that determines the positions of a system's stations from measurements between them; `None` if there
    /// is none.
    fn survey() -> Option<Box<dyn Calibration>> {
        None
    }

    /// The command that determines the errors of the sensors; `None` if there is none.
    fn calibration() -> Option<Box<dyn Calibration>> {
        None
    }

    /// The command that identifies the model of the moving object; `None` if there is none.
    fn identification() -> Option<Box<dyn Calibration>> {
        None
    }
}

/// A command that determines the errors of a system's sensors, or how their carrier moves.
pub trait Calibration {
    /// The command line of the command: its description and options.
    fn command(&self) -> clap::Command;

    /// Reads the input, calibrates, writes the result and prints it.
    ///
    /// # Errors
    /// Errors in the options or the files; nothing is then written.
    fn run(&self, matches: &clap::ArgMatches) -> Result<(), Error>;

    /// A plan that follows a live recording made for a calibration, says what to do next, and writes the calibration to
    /// a file at the end; `None` if only a log will do.
    fn watch(&self, _to: &Path) -> Option<Arc<dyn Plan>> {
        None
    }
}
