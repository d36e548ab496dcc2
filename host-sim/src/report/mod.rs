//! What a run shows: comparisons with the papers, figures, streams, and how each was made.

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
    /// The paper it is from.
    pub paper: &'static str,
    /// What a reader should know before the numbers, in a sentence or three.
    pub about: String,
    /// The few numbers that matter most: what the terminal shows.
    pub summary: Comparison,
    /// Tables and figures in the paper's order, then our own.
    pub items: Vec<Item>,
    /// What can be looked at in other programs.
    pub streams: Vec<Stream>,
    /// What the first page says of it.
    pub headlines: Vec<Headline>,
    /// The figure that the first page shows; nothing if it is not there.
    pub picture: &'static str,
    /// What recordings gave, if there is a folder of them.
    pub recorded: Option<Recorded>,
}

/// A row of the report's first table: one quantity, by everyone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Headline {
    /// What is measured, on what.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// As printed.
    pub published: Option<f64>,
    /// By the published method, as it is run here.
    pub theirs: Option<f64>,
    /// By this library's own.
    pub ours: Option<f64>,
    /// What nothing can be better than.
    pub limit: Option<f64>,
}

/// A table or figure of a chapter.
#[derive(Debug, Clone, PartialEq)]
pub struct Item {
    /// What is shown.
    pub content: Content,
    /// How it came about.
    pub made: Made,
}

/// What an [`Item`] shows.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// Published, ours and limit.
    Comparison(Comparison),
    /// A diagram.
    Figure(Figure),
}

/// How numbers were made: enough to make them again.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Made {
    /// What to type.
    pub command: String,
    /// Seed of the randomness.
    pub seed: u64,
    /// How many repetitions of what: `20 × 7 walks`.
    pub trials: String,
}

#[cfg(test)]
impl Chapter {
    /// Without anything in it.
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

    /// Fails if a table has no number for programs, or the first page nothing to say.
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
    /// The tables, without the summary, and how each was made.
    pub fn tables(&self) -> impl Iterator<Item = (&Comparison, &Made)> {
        self.items.iter().filter_map(|item| match &item.content {
            Content::Comparison(comparison) => Some((comparison, &item.made)),
            Content::Figure(_) => None,
        })
    }

    /// The tables, without the summary.
    pub fn comparisons(&self) -> impl Iterator<Item = &Comparison> {
        self.tables().map(|(comparison, _)| comparison)
    }

    /// The figures, those of recordings at the end.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        let figures = self.items.iter().filter_map(|item| match &item.content {
            Content::Figure(figure) => Some(figure),
            Content::Comparison(_) => None,
        });
        figures.chain(self.recorded.iter().flat_map(Recorded::figures))
    }

    /// Each number of a table, the table's name, and the command that makes it again; those of recordings at the end.
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
    /// As an item of a chapter.
    pub fn item(&self, content: impl Into<Content>) -> Item {
        Item { content: content.into(), made: self.clone() }
    }
}
