//! The type-erased interface of a system.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use kestirim_sweep::{Block, Samples};
use serde_json::Value;

use super::face::{Calibration, OutputField, System};
use super::files::{FileField, Files, Source};
use super::idle::refuse;
use super::online::{Panel, Plan};
use super::opened::{self, Opened};
use super::recorded::Study;
use super::run::RunOptions;
use super::setting::Setting;
use super::settings::Settings;
use crate::report::Chapter;
use crate::{Error, output};

/// The results of an experiment.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// The object that `--json` prints.
    pub report: Value,
    /// The text that the terminal shows.
    pub text: String,
    /// The system's chapter of the report, if requested.
    pub chapter: Option<Chapter>,
}

/// A type-erased [`System`], as the commands see it.
pub trait AnySystem: Sync {
    /// [`System::NAME`].
    fn name(&self) -> &'static str;
    /// [`System::TITLE`].
    fn title(&self) -> &'static str;
    /// [`System::FILES`].
    fn files(&self) -> &'static [FileField];
    /// [`System::SYNTHETIC`].
    fn synthetic(&self) -> &'static [(&'static str, &'static str)];
    /// [`System::OUTPUTS`].
    fn outputs(&self) -> &'static [OutputField];
    /// [`System::PANELS`].
    fn panels(&self) -> &'static [Panel];
    /// [`System::HEARS_BYTES`].
    fn hears_bytes(&self) -> bool;
    /// [`System::RECORDED`].
    fn recorded(&self) -> &'static [Study];
    /// [`System::settings`] without a particular recording.
    fn settings(&self) -> Vec<Setting>;
    /// [`System::cell`].
    fn cell(&self) -> Vec<Setting>;
    /// [`System::survey`].
    fn survey(&self) -> Option<Box<dyn Calibration>>;
    /// [`System::calibration`].
    fn calibration(&self) -> Option<Box<dyn Calibration>>;
    /// [`System::identification`].
    fn identification(&self) -> Option<Box<dyn Calibration>>;

    /// [`System::fits`].
    fn fits(&self, field: &str, path: &Path, files: &Files) -> bool;

    /// Reads a recording, or generates a synthetic one.
    ///
    /// # Errors
    /// As [`System::read`] and [`System::synthetic`].
    fn open(&self, source: Source, settings: &Settings) -> Result<Box<dyn Opened>, Error>;

    /// Refuses settings that would have no effect.
    ///
    /// # Errors
    /// [`Error::Usage`] with the reason.
    fn refuse_idle(&self, settings: &Settings) -> Result<(), Error>;

    /// [`System::trials`].
    ///
    /// # Errors
    /// Those of [`System::trials`].
    fn trials(&self, run: &RunOptions, cell: &Settings) -> Result<Vec<Block>, Error>;

    /// [`System::experiment`], and the chapter if requested.
    ///
    /// # Errors
    /// Those of [`System::experiment`].
    fn experiment(
        &self,
        run: &RunOptions,
        cell: &Settings,
        samples: &[Samples],
        with_chapter: bool,
    ) -> Result<Experiment, Error>;

    /// [`System::online`].
    ///
    /// # Errors
    /// Those of [`System::online`].
    fn online(&self, settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error>;
}

impl fmt::Debug for dyn AnySystem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl<S: System> AnySystem for S {
    fn name(&self) -> &'static str {
        S::NAME
    }

    fn title(&self) -> &'static str {
        S::TITLE
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

    fn hears_bytes(&self) -> bool {
        S::HEARS_BYTES
    }

    fn recorded(&self) -> &'static [Study] {
        S::RECORDED
    }

    fn settings(&self) -> Vec<Setting> {
        S::settings(None)
    }

    fn cell(&self) -> Vec<Setting> {
        S::cell()
    }

    fn survey(&self) -> Option<Box<dyn Calibration>> {
        S::survey()
    }
    fn calibration(&self) -> Option<Box<dyn Calibration>> {
        S::calibration()
    }

    fn identification(&self) -> Option<Box<dyn Calibration>> {
        S::identification()
    }

    fn fits(&self, field: &str, path: &Path, files: &Files) -> bool {
        S::fits(field, path, files)
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

    fn trials(&self, run: &RunOptions, cell: &Settings) -> Result<Vec<Block>, Error> {
        refuse(cell, |name| S::cell_idle(cell, name))?;
        S::trials(run, cell)
    }

    fn experiment(
        &self,
        run: &RunOptions,
        cell: &Settings,
        samples: &[Samples],
        with_chapter: bool,
    ) -> Result<Experiment, Error> {
        let experiment = S::experiment(run, cell, samples)?;
        let report =
            serde_json::to_value(&experiment).map_err(|error| Error::Stdout(error.into()))?;
        let chapter = with_chapter.then(|| S::chapter(&experiment)).transpose()?;
        Ok(Experiment { report, text: experiment.to_string(), chapter })
    }

    fn online(&self, settings: &Settings, files: &Files) -> Result<Option<Arc<dyn Plan>>, Error> {
        S::online(settings, files)
    }
}

/// Runs all trials on all threads and returns their samples.
///
/// # Errors
/// The sentence of the first trial that fails.
pub fn tried(blocks: &[Block]) -> Result<Vec<Samples>, Error> {
    let bar = output::progress(blocks.iter().map(|block| block.trials).sum(), "trials");
    let samples = blocks.iter().map(|block| block.run(&|| bar.inc(1))).collect::<Result<_, _>>();
    bar.finish_and_clear();
    Ok(samples?)
}

/// Runs a system's experiment completely, from its trials to its result.
///
/// # Errors
/// Those of [`System::trials`].
pub fn experiment<S: System>(run: &RunOptions, cell: &Settings) -> Result<S::Experiment, Error> {
    S::experiment(run, cell, &tried(&S::trials(run, cell)?)?)
}
