//! The page's questions and their answers.

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

/// The maximum number of points of a series: about as many as a figure has columns of pixels.
const MOST_POINTS: usize = 700;
/// The maximum number of rows of a table: more would be slow to draw, and nobody would read them.
const MOST_ROWS: usize = 500;

/// The state of the page.
#[derive(Debug, Deserialize)]
pub(super) struct Question {
    pub(super) settings: Map<String, Value>,
    /// The time window that is shown, in seconds.
    #[serde(default)]
    pub(super) window: Option<[f64; 2]>,
    /// The visible ranges of the horizontal axes of zoomed figures without a time axis, by id.
    #[serde(default)]
    windows: BTreeMap<String, [f64; 2]>,
    /// The recording and settings to compare with, if any.
    #[serde(default)]
    a: Option<Compared>,
}

/// Another recording of the same system, or other settings, to compare with.
#[derive(Debug, Deserialize)]
struct Compared {
    recording: String,
    settings: Map<String, Value>,
    how: How,
}

impl Question {
    /// The answer to compare with, if there is one.
    ///
    /// # Errors
    /// Those of [`Asked::new`] for the other answer.
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

    /// The figures of an answer, or of a comparison.
    ///
    /// # Errors
    /// Those of [`other`](Self::other).
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

    /// The visible ranges.
    pub(super) fn windows(&self) -> Windows {
        Windows { time_s: self.window, others: self.windows.clone() }
    }
}

/// The visible ranges of figures.
#[derive(Debug, Clone, Default)]
pub(super) struct Windows {
    time_s: Option<[f64; 2]>,
    others: BTreeMap<String, [f64; 2]>,
}

impl Windows {
    /// The visible range of a figure along its horizontal axis; for a map, of time.
    fn of(&self, figure: &Figure) -> Option<[f64; 2]> {
        match figure.x.seconds {
            Some(seconds) => self.time_s.map(|ends| ends.map(|end| end / seconds)),
            None if figure.equal => self.time_s,
            None => self.others.get(&figure.id).copied(),
        }
    }
}

/// A recording with its settings and the answer to them.
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

    /// The command that reproduces the answer, with uploaded files named as they were on the user's disk.
    pub(super) fn command(&self) -> String {
        let Some(folder) = self.recording.folder() else { return self.answer.command.clone() };
        let folder = format!("{}/", folder.display());
        let mut pieces = self.answer.command.split(&folder);
        let first = pieces.next().unwrap_or_default().to_owned();
        // Each file lies in a folder named after its field.
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

/// An answer in the form that the page reads, with its own figures or those of a comparison, and its own tables.
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

/// Findings in the form that the page reads: whether it is a fault, its subject, and the sentence.
pub(super) fn findings(findings: &[Finding]) -> Vec<(bool, &'static str, String)> {
    findings.iter().map(|it| (it.is_fault(), it.about, it.sentence())).collect()
}
