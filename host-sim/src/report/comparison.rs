use std::fmt;

use serde::Serialize;

use crate::output;

/// Columns where no terminal says its own.
const WIDTH: u16 = 120;

/// A table of a paper: published, ours, limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Names its files and its place on the page: lower case, with hyphens.
    pub id: String,
    /// Which table of the paper, and what it shows.
    pub title: String,
    /// The quantities.
    pub rows: Vec<Row>,
    /// What explains a difference; may be empty.
    pub note: String,
}

/// A quantity, with its unit, and what everyone says of it; an empty cell is unknown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    /// What is measured, where and in which unit.
    pub quantity: String,
    /// As printed.
    pub published: String,
    /// As measured by this run.
    pub ours: String,
    /// What nothing can be better than, or what was asked for.
    pub limit: String,
}

impl Row {
    /// As it is shown: a dash for what is unknown.
    pub fn cells(&self) -> [&str; 4] {
        let Self { quantity, published, ours, limit } = self;
        [quantity, published, ours, limit].map(|text| if text.is_empty() { "—" } else { text })
    }
}

impl Comparison {
    /// A table without rows.
    pub fn new(id: impl Into<String>, title: impl Into<String>) -> Self {
        Self { id: id.into(), title: title.into(), rows: Vec::new(), note: String::new() }
    }

    /// With another row.
    pub fn row(
        mut self,
        quantity: impl Into<String>,
        published: impl Into<String>,
        ours: impl Into<String>,
        limit: impl Into<String>,
    ) -> Self {
        let (quantity, published) = (quantity.into(), published.into());
        self.rows.push(Row { quantity, published, ours: ours.into(), limit: limit.into() });
        self
    }

    /// With a sentence on what explains a difference.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        let mut table = output::table();
        table.set_width(output::width().unwrap_or(WIDTH));
        table.set_header(["", "published", "ours", "limit"]);
        for row in &self.rows {
            table.add_row(row.cells());
        }
        write!(f, "{table}")?;
        if self.note.is_empty() { Ok(()) } else { write!(f, "\n{}", self.note) }
    }
}
