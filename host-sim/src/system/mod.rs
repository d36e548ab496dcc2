//! What a system is to the program: one face, which every command knows and no system writes twice.
//!
//! A [`System`] says once which files it reads, what can be set, how a recording is tracked and what came of it.
//! The command line, the page and a live stream are made from that, for any system.

mod account;
mod files;
mod literal;
mod online;
mod opened;
mod outputs;
mod run;
mod setting;
mod settings;

use std::fmt::Display;
use std::sync::Arc;

use serde::Serialize;
use serde_json::Value;

pub use account::{Account, Answer, Table};
pub use files::{FileField, Files, Source};
pub use literal::Literal;
pub use online::{Online, Outcome, Panel, Plan};
pub use opened::{Opened, Wanted};
pub use outputs::{Outputs, say_where};
pub use run::{RunOptions, ScalarKind, choose_scalar};
pub use setting::Value as SettingValue;
pub use setting::{Given, Kind, Named, Number, Setting, Shorthand};
pub use settings::Settings;

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
    /// Figures of a stream that is followed while it comes; none if no estimator follows one.
    const PANELS: &'static [Panel] = &[];

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

    /// A synthetic recording by name.
    ///
    /// # Errors
    /// [`Error::Usage`] if there is none of that name.
    fn synthetic(name: &str) -> Result<Self::Recording, Error>;

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

    /// Runs the paper's experiment on synthetic streams, or what of it the `cell` asks for.
    ///
    /// # Errors
    /// [`Error::Usage`] for options that it does not have.
    fn experiment(run: &RunOptions, cell: &Settings) -> Result<Self::Experiment, Error>;

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

    /// The command that finds what the sensors measure wrong; none if there is none.
    fn calibration() -> Option<Box<dyn Calibration>> {
        None
    }
}

/// A command that finds what a system's sensors measure wrong.
pub trait Calibration {
    /// Its options, and what it does.
    fn command(&self) -> clap::Command;

    /// Reads, calibrates, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is written.
    fn run(&self, matches: &clap::ArgMatches) -> Result<(), Error>;
}

/// What came of an experiment.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// What `--json` prints.
    pub report: Value,
    /// What the terminal shows.
    pub text: String,
    /// The part of the report, if it was asked for.
    pub chapter: Option<Chapter>,
}

/// A [`System`] of which the commands know no more than its face.
pub trait AnySystem: Sync {
    /// [`System::NAME`].
    fn name(&self) -> &'static str;
    /// [`System::TITLE`].
    fn title(&self) -> &'static str;
    /// [`System::PAPER`].
    fn paper(&self) -> &'static str;
    /// [`System::FILES`].
    fn files(&self) -> &'static [FileField];
    /// [`System::SYNTHETIC`].
    fn synthetic(&self) -> &'static [(&'static str, &'static str)];
    /// [`System::OUTPUTS`].
    fn outputs(&self) -> &'static [OutputField];
    /// [`System::PANELS`].
    fn panels(&self) -> &'static [Panel];
    /// [`System::settings`] of any recording.
    fn settings(&self) -> Vec<Setting>;
    /// [`System::cell`].
    fn cell(&self) -> Vec<Setting>;
    /// [`System::calibration`].
    fn calibration(&self) -> Option<Box<dyn Calibration>>;

    /// Reads a recording, or makes a synthetic one.
    ///
    /// # Errors
    /// As [`System::read`] and [`System::synthetic`].
    fn open(&self, source: Source, settings: &Settings) -> Result<Box<dyn Opened>, Error>;

    /// Refuses settings that would change nothing.
    ///
    /// # Errors
    /// [`Error::Usage`] with the reason.
    fn refuse_idle(&self, settings: &Settings) -> Result<(), Error>;

    /// [`System::experiment`], and the chapter if it is asked for.
    ///
    /// # Errors
    /// As there.
    fn experiment(
        &self,
        run: &RunOptions,
        cell: &Settings,
        with_chapter: bool,
    ) -> Result<Experiment, Error>;

    /// [`System::online`].
    ///
    /// # Errors
    /// As there.
    fn online(&self, settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error>;

    /// [`System::firmware`] of any recording.
    fn firmware(&self, settings: &Settings) -> String;
}

impl<S: System> AnySystem for S {
    fn name(&self) -> &'static str {
        S::NAME
    }

    fn title(&self) -> &'static str {
        S::TITLE
    }

    fn paper(&self) -> &'static str {
        S::PAPER
    }

    fn files(&self) -> &'static [FileField] {
        S::FILES
    }

    fn synthetic(&self) -> &'static [(&'static str, &'static str)] {
        S::SYNTHETIC
    }

    fn outputs(&self) -> &'static [OutputField] {
        S::OUTPUTS
    }

    fn panels(&self) -> &'static [Panel] {
        S::PANELS
    }

    fn settings(&self) -> Vec<Setting> {
        S::settings(None)
    }

    fn cell(&self) -> Vec<Setting> {
        S::cell()
    }

    fn calibration(&self) -> Option<Box<dyn Calibration>> {
        S::calibration()
    }

    fn open(&self, source: Source, settings: &Settings) -> Result<Box<dyn Opened>, Error> {
        let recording = match &source {
            Source::Files(files) => S::read(files, settings)?,
            Source::Synthetic(name) => S::synthetic(name)?,
        };
        Ok(opened::open::<S>(recording, source))
    }

    fn refuse_idle(&self, settings: &Settings) -> Result<(), Error> {
        refuse(settings, |name| S::idle(None, settings, name))
    }

    fn experiment(
        &self,
        run: &RunOptions,
        cell: &Settings,
        with_chapter: bool,
    ) -> Result<Experiment, Error> {
        refuse(cell, |name| S::cell_idle(cell, name))?;
        let experiment = S::experiment(run, cell)?;
        let report =
            serde_json::to_value(&experiment).map_err(|error| Error::Stdout(error.into()))?;
        let chapter = with_chapter.then(|| S::chapter(&experiment)).transpose()?;
        Ok(Experiment { report, text: experiment.to_string(), chapter })
    }

    fn online(&self, settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        S::online(settings, files)
    }

    fn firmware(&self, settings: &Settings) -> String {
        S::firmware(None, settings)
    }
}

/// Why a setting has no effect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Idle {
    /// It belongs to something else, and is refused: `is for --mode kinematic`.
    Foreign(String),
    /// It is so anyway.
    Implied(String),
}

impl Idle {
    /// It belongs to something else.
    pub fn foreign(reason: impl Into<String>) -> Self {
        Self::Foreign(reason.into())
    }

    /// It is so anyway.
    pub fn implied(reason: impl Into<String>) -> Self {
        Self::Implied(reason.into())
    }

    /// Why.
    pub fn reason(&self) -> &str {
        let (Self::Foreign(reason) | Self::Implied(reason)) = self;
        reason
    }
}

/// Refuses the first given setting that belongs to something else.
fn refuse(settings: &Settings, idle: impl Fn(&str) -> Option<Idle>) -> Result<(), Error> {
    for setting in settings.table().iter().filter(|setting| settings.is_given(setting.name)) {
        if let Some(Idle::Foreign(reason)) = idle(setting.name) {
            return Err(Error::Usage(format!("--{} {reason}", setting.option())));
        }
    }
    Ok(())
}
