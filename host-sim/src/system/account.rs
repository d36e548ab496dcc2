//! The results of a recording.

use std::path::PathBuf;

use kestirim_health::{Health, Reason, State};
use kestirim_replay::Finding;
use serde::Serialize;
use serde_json::Value;

use super::sheet::Sheet;
use crate::Error;
use crate::figure::Figure;

/// The results of a recording: for other programs, for people, and warnings for the user.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Account {
    /// The object that `--json` prints.
    pub report: Value,
    /// Results by name, with their units.
    pub facts: Vec<(String, String)>,
    /// The text that the terminal shows in place of the facts.
    pub text: Option<String>,
    /// Warnings for the user, one sentence each.
    pub warnings: Vec<String>,
    /// The file that the warnings are about; `None` if each names its own.
    pub about: Option<PathBuf>,
    /// Whether the result can be relied upon.
    pub health: Health,
}

impl Account {
    /// An account of a report, with its warnings.
    ///
    /// # Errors
    /// [`Error::Stdout`] if the report cannot be represented as JSON.
    pub fn new(report: &impl Serialize, warnings: Vec<String>) -> Result<Self, Error> {
        let report = serde_json::to_value(report).map_err(|error| Error::Stdout(error.into()))?;
        Ok(Self { report, warnings, ..Self::default() })
    }

    /// Adds a fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }

    /// Adds a warning, to the report's list as well if it has one.
    pub fn warn(&mut self, sentence: String) {
        if let Some(warnings) = self.report.get_mut("warnings").and_then(Value::as_array_mut) {
            warnings.push(Value::String(sentence.clone()));
        }
        self.warnings.push(sentence);
    }

    /// Adds a reason to rely on the result less.
    pub fn doubt(&mut self, reason: Reason) {
        self.health.add(reason);
    }

    /// Inserts the health wherever the account is read.
    pub(super) fn tell_health(&mut self) {
        let health = serde_json::to_value(self.health);
        if let (Some(report), Ok(health)) = (self.report.as_object_mut(), health) {
            report.insert("health".to_owned(), health);
        }
        self.fact("health", self.health.to_string());
    }

    /// Adds what was concluded about the log as facts.
    pub fn understood(&mut self, conclusions: &[String]) {
        for conclusion in conclusions {
            self.fact("log", conclusion);
        }
    }
}

/// The results that the page shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Answer {
    /// Results by name, with their units.
    pub facts: Vec<(String, String)>,
    /// Warnings for the user, one sentence each.
    pub warnings: Vec<String>,
    /// The figures: for a given recording always the same ones in the same order, whatever the settings.
    pub figures: Vec<Figure>,
    /// The tables: for a given recording always the same ones in the same order, whatever the settings.
    pub tables: Vec<Sheet>,
    /// Settings that have no effect given the others, and why.
    pub disabled: Vec<(&'static str, String)>,
    /// The command that reproduces the answer.
    pub command: String,
    /// The equivalent configuration of firmware, in Rust.
    pub firmware: String,
    /// Findings about the recording itself, made before any estimator has run.
    pub findings: Vec<Finding>,
}

impl Answer {
    /// Adds a fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }

    /// The number of points of all figures and cells of all tables.
    pub(super) fn points(&self) -> usize {
        let series = self.figures.iter().flat_map(|figure| &figure.series);
        let cells = self.tables.iter().map(|table| table.rows.len() * table.header.len());
        series.map(|series| series.x.len()).chain(cells).sum()
    }
}

/// The rows of a file that an option asks for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    /// The names of the columns.
    pub header: Vec<String>,
    /// The rows, with a field per column.
    pub rows: Vec<Vec<String>>,
    /// For a track, how far each row can be relied upon according to the estimator; written as the last column.
    pub health: Vec<State>,
}

impl Table {
    /// A table without rows.
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(|&name| name.to_owned()).collect(), ..Self::default() }
    }

    /// Appends the health of each row as the last column, limited to no better than `of_all`.
    pub(super) fn with_health(mut self, of_all: State) -> Self {
        if !self.health.is_empty() {
            self.header.push("health".to_owned());
            for (row, health) in self.rows.iter_mut().zip(self.health.drain(..)) {
                row.push(health.max(of_all).word().to_owned());
            }
        }
        self
    }
}
