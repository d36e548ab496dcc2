//! The results of a run: comparisons with the papers, figures, streams, and how each was made.

mod comparison;
pub mod csv;
mod document;
mod folder;
mod page;
mod recorded;
mod session;
mod value;

pub use comparison::{Comparison, Row};
pub use folder::write;
pub use recorded::{Recorded, Replayed, Studied};
pub use session::Session;
pub use value::{Value, printed, rounded};

use serde::Serialize;

use crate::figure::Figure;
use crate::stream::Stream;

/// A system's part of the report.
#[derive(Debug, Clone, PartialEq)]
pub struct Chapter {
    /// The system's name on the command line.
    pub system: &'static str,
    /// What the system does, in a few words.
    pub title: &'static str,
    /// The paper that the system is from.
    pub paper: &'static str,
    /// What a reader should know before the numbers, in one to three sentences.
    pub about: String,
    /// The few most important numbers, which the terminal shows.
    pub summary: Comparison,
    /// Tables and figures in the paper's order, followed by our own.
    pub items: Vec<Item>,
    /// Streams for inspection in other programs.
    pub streams: Vec<Stream>,
    /// The rows of this system in the report's first table.
    pub headlines: Vec<Headline>,
    /// The id of the figure shown on the first page; no picture is shown if there is no such figure.
    pub picture: &'static str,
    /// The results of recordings, if a folder of them was given.
    pub recorded: Option<Recorded>,
}

/// A row of the report's first table: one quantity, by each source.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Headline {
    /// The quantity, and what it is measured on.
    pub quantity: String,
    /// The unit of the quantity.
    pub unit: &'static str,
    /// The value as printed in the paper.
    pub published: Option<f64>,
    /// The value by the published method, as run here.
    pub theirs: Option<f64>,
    /// The value by this library's own method.
    pub ours: Option<f64>,
    /// The theoretical bound.
    pub limit: Option<f64>,
}

/// A table or figure of a chapter.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// What is shown.
    pub content: Content,
    /// How the content was made.
    pub made: Made,
}

/// The content of an [`Item`].
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A table of published values, ours and the limit.
    Comparison(Comparison),
    /// A diagram.
    Figure(Figure),
}

/// How numbers were made: enough to reproduce them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Made {
    /// The command to type.
    pub command: String,
    /// The seed of all randomness.
    pub seed: u64,
    /// The number and kind of repetitions: `20 × 7 walks`.
    pub trials: String,
}

#[cfg(test)]
impl Chapter {
    /// An empty chapter.
    fn of(system: &'static str) -> Self {
        Self {
            system,
            title: "",
            paper: "",
            about: String::new(),
            summary: Comparison::new("summary", ""),
            items: Vec::new(),
            streams: Vec::new(),
            headlines: Vec::new(),
            picture: "",
            recorded: None,
        }
    }

    /// Fails if a table has no number for other programs, or the chapter no headlines.
    pub(crate) fn assert_complete(&self) {
        for table in self.comparisons() {
            let mut values = table.values.iter();
            assert!(values.any(|it| it.value.is_some()), "{} has no numbers", table.id);
        }
        assert!(self.figures().any(|figure| figure.id == self.picture), "{}", self.picture);
        assert!(!self.headlines.is_empty());
    }
}

impl Chapter {
    /// The tables except the summary, each with how it was made.
    pub fn tables(&self) -> impl Iterator<Item = (&Comparison, &Made)> {
        self.items.iter().filter_map(|item| match &item.content {
            Content::Comparison(comparison) => Some((comparison, &item.made)),
            Content::Figure(_) => None,
        })
    }

    /// The tables except the summary.
    pub fn comparisons(&self) -> impl Iterator<Item = &Comparison> {
        self.tables().map(|(comparison, _)| comparison)
    }

    /// The figures, followed by those of recordings.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        let figures = self.items.iter().filter_map(|item| match &item.content {
            Content::Figure(figure) => Some(figure),
            Content::Comparison(_) => None,
        });
        figures.chain(self.recorded.iter().flat_map(Recorded::figures))
    }

    /// Each number with the name of its table and the command that reproduces it; those of recordings come last.
    pub fn numbers(&self) -> impl Iterator<Item = (&str, &Value, &str)> {
        let numbers = self.tables().flat_map(|(table, made)| {
            table.values.iter().map(|value| (table.id.as_str(), value, made.command.as_str()))
        });
        numbers.chain(self.recorded.iter().flat_map(Recorded::numbers))
    }
}

impl From<Comparison> for Content {
    fn from(comparison: Comparison) -> Self {
        Self::Comparison(comparison)
    }
}

impl From<Figure> for Content {
    fn from(figure: Figure) -> Self {
        Self::Figure(figure)
    }
}

impl Made {
    /// Wraps content as an item of a chapter.
    pub fn item(&self, content: impl Into<Content>) -> Item {
        Item { content: content.into(), made: self.clone() }
    }
}
