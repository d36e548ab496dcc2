//! What the page asks, and what is answered.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::Shared;
use super::api::Refusal;
use super::compare::{self, How};
use super::sessions::Recording;
use crate::figure::{Figure, View, plotly};
use crate::system::{Answer, AnySystem, Finding, Settings, Wanted};

/// As many as a figure of the page has columns of pixels, about.
const MOST_POINTS: usize = 700;
/// Rows of a table of the page: more would be drawn slowly, and nobody reads them.
const MOST_ROWS: usize = 500;

/// How the page stands.
#[derive(Debug, Deserialize)]
pub(super) struct Question {
    pub(super) settings: Map<String, Value>,
    /// The stretch of time that is looked at, s.
    #[serde(default)]
    pub(super) window: Option<[f64; 2]>,
    /// Stretches of the horizontal axes of figures that are zoomed in and have no time.
    #[serde(default)]
    windows: BTreeMap<String, [f64; 2]>,
    /// What it is compared with.
    #[serde(default)]
    a: Option<Compared>,
}

/// Another recording of the same system, or other settings.
#[derive(Debug, Deserialize)]
struct Compared {
    recording: String,
    settings: Map<String, Value>,
    how: How,
}

impl Question {
    /// What it is compared with, if it is.
    ///
    /// # Errors
    /// As [`Asked::new`], of the other one.
    pub(super) fn other(
        &self,
        shared: &Shared,
        system: &'static dyn AnySystem,
    ) -> Result<Option<(Asked, How)>, Refusal> {
        let Some(Compared { recording, settings, how }) = &self.a else { return Ok(None) };
        let other = Asked::new(shared, system, recording, settings);
        let other = other.map_err(|Refusal(code, text)| Refusal(code, format!("A: {text}")))?;
        Ok(Some((other, *how)))
    }

    /// The figures of an answer, or of its comparison.
    ///
    /// # Errors
    /// As [`other`](Self::other).
    pub(super) fn figures<'a>(
        &self,
        shared: &Shared,
        system: &'static dyn AnySystem,
        asked: &'a Asked,
    ) -> Result<Cow<'a, [Figure]>, Refusal> {
        Ok(match self.other(shared, system)? {
            Some((other, how)) => compare::figures(&other.answer, &asked.answer, how).into(),
            None => asked.answer.figures.as_slice().into(),
        })
    }

    /// What is looked at.
    pub(super) fn windows(&self) -> Windows {
        Windows { time_s: self.window, others: self.windows.clone() }
    }
}

/// What is looked at of figures.
#[derive(Debug, Clone, Default)]
pub(super) struct Windows {
    time_s: Option<[f64; 2]>,
    others: BTreeMap<String, [f64; 2]>,
}

impl Windows {
    /// What is looked at of a figure, along its axis.
    fn of(&self, figure: &Figure) -> Option<[f64; 2]> {
        match figure.x.seconds {
            Some(seconds) => self.time_s.map(|ends| ends.map(|end| end / seconds)),
            None if figure.equal => self.time_s,
            None => self.others.get(&figure.id).copied(),
        }
    }
}

/// A recording with its settings, and what came of them.
pub(super) struct Asked {
    recording: Recording,
    pub(super) settings: Settings,
    pub(super) answer: Arc<Answer>,
}

impl Asked {
    pub(super) fn new(
        shared: &Shared,
        system: &'static dyn AnySystem,
        recording: &str,
        settings: &Map<String, Value>,
    ) -> Result<Self, Refusal> {
        let recording = shared.sessions.get(system, recording)?;
        let settings = Settings::sent(recording.opened.settings(), settings)?;
        let answer = recording.opened.answer(&settings);
        let answer = answer.map_err(|error| recording.naming_files(error))?;
        Ok(Self { recording, settings, answer })
    }

    /// The command that gives the same again, with uploaded files named as they were on the user's disk.
    pub(super) fn command(&self) -> String {
        let Some(folder) = self.recording.folder() else { return self.answer.command.clone() };
        let folder = format!("{}/", folder.display());
        let mut pieces = self.answer.command.split(&folder);
        let first = pieces.next().unwrap_or_default().to_owned();
        // Each file lies in a folder that is called like its field.
        let names = pieces.map(|piece| piece.split_once('/').map_or(piece, |(_, name)| name));
        names.fold(first, |command, name| command + name)
    }

    /// Writes the same files as `host-sim replay`.
    pub(super) fn write(&self, wanted: &Wanted) -> Result<(), Refusal> {
        let opened = &self.recording.opened;
        let written = opened.replay(&opened.effective(&self.settings), wanted);
        written.map(drop).map_err(|error| self.recording.naming_files(error).into())
    }
}

/// An answer as the page takes it, with its figures or those of a comparison, and its own tables.
pub(super) fn page(answer: &Answer, figures: &[Figure], windows: &Windows) -> Value {
    let drawn = figures.iter().map(|figure| {
        plotly::figure(figure, View { most_points: MOST_POINTS, window: windows.of(figure) })
    });
    let tables = answer.tables.iter().map(|it| it.excerpt(windows.time_s, MOST_ROWS).to_json());
    json!({
        "facts": answer.facts,
        "warnings": answer.warnings,
        "figures": drawn.collect::<Vec<_>>(),
        "tables": tables.collect::<Vec<_>>(),
        "disabled": answer.disabled,
        "command": answer.command,
        "firmware": answer.firmware,
        "findings": findings(&answer.findings),
    })
}

/// Findings as the page takes them: whether it is a fault, what it is about, and the sentence.
pub(super) fn findings(findings: &[Finding]) -> Vec<(bool, &'static str, String)> {
    findings.iter().map(|it| (it.is_fault(), it.about, it.sentence())).collect()
}
