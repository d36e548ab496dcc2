//! What came of a recording.

use std::path::PathBuf;

use kestirim_health::{Health, Reason, State};
use kestirim_replay::Finding;
use serde::Serialize;
use serde_json::Value;

use super::sheet::Sheet;
use crate::Error;
use crate::figure::Figure;

/// What came of a recording: for programs, for people, and what a user should know.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Account {
    /// What `--json` prints.
    pub report: Value,
    /// Numbers with their units, by name.
    pub facts: Vec<(String, String)>,
    /// What the terminal shows instead of the facts.
    pub text: Option<String>,
    /// What a user should know.
    pub warnings: Vec<String>,
    /// Which file the warnings are about; none if each says so itself.
    pub about: Option<PathBuf>,
    /// Whether it can be relied upon.
    pub health: Health,
}

impl Account {
    /// Of a report, with its warnings.
    ///
    /// # Errors
    /// [`Error::Stdout`] for a report that is no JSON.
    pub fn new(report: &impl Serialize, warnings: Vec<String>) -> Result<Self, Error> {
        let report = serde_json::to_value(report).map_err(|error| Error::Stdout(error.into()))?;
        Ok(Self { report, warnings, ..Self::default() })
    }

    /// With another fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }

    /// With another warning.
    pub fn warn(&mut self, sentence: String) {
        if let Some(warnings) = self.report.get_mut("warnings").and_then(Value::as_array_mut) {
            warnings.push(Value::String(sentence.clone()));
        }
        self.warnings.push(sentence);
    }

    /// With a reason to rely upon it less.
    pub fn doubt(&mut self, reason: Reason) {
        self.health.add(reason);
    }

    /// The health is told where everybody looks.
    pub(super) fn tell_health(&mut self) {
        let health = serde_json::to_value(self.health);
        if let (Some(report), Ok(health)) = (self.report.as_object_mut(), health) {
            report.insert("health".to_owned(), health);
        }
        self.fact("health", self.health.to_string());
    }

    /// With what was concluded about the log.
    pub fn understood(&mut self, conclusions: &[String]) {
        for conclusion in conclusions {
            self.fact("log", conclusion);
        }
    }
}

/// What the page shows.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Answer {
    /// Numbers with their units, by name.
    pub facts: Vec<(String, String)>,
    /// What a user should know.
    pub warnings: Vec<String>,
    /// Always the same ones in the same order for a recording, whatever the settings.
    pub figures: Vec<Figure>,
    /// Always the same ones in the same order for a recording, whatever the settings.
    pub tables: Vec<Sheet>,
    /// Settings that have no effect as the others are, and why.
    pub disabled: Vec<(&'static str, String)>,
    /// The command that gives the same again.
    pub command: String,
    /// The same settings in firmware, in Rust.
    pub firmware: String,
    /// What the recording shows before an estimator has seen it.
    pub findings: Vec<Finding>,
}

impl Answer {
    /// With another fact.
    pub fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.facts.push((name.into(), value.into()));
    }

    /// Points of all figures, and cells of all tables.
    pub(super) fn points(&self) -> usize {
        let series = self.figures.iter().flat_map(|figure| &figure.series);
        let cells = self.tables.iter().map(|table| table.rows.len() * table.header.len());
        series.map(|series| series.x.len()).chain(cells).sum()
    }
}

/// Rows of a file that an option asks for.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub header: Vec<String>,
    /// A field a column.
    pub rows: Vec<Vec<String>>,
    /// Of a track: how far each row can be relied upon, as the estimator tells; the last column, when it is written.
    pub health: Vec<State>,
}

impl Table {
    /// Without rows.
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(|&name| name.to_owned()).collect(), ..Self::default() }
    }

    /// With the health of each row as its last column, no better than `of_all`.
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
