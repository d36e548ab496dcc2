use std::fmt;

use serde::Serialize;

use super::value::Value;
use crate::output;

/// The width in columns if no terminal states its own.
const WIDTH: u16 = 120;

/// A table of a paper: published values, ours and the limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The identifier in file names and on the page: lower case, with hyphens.
    pub id: String,
    /// Which table of the paper, and what it shows.
    pub title: String,
    /// The quantities.
    pub rows: Vec<Row>,
    /// An explanation of differences; may be empty.
    pub note: String,
    /// The numbers in the rows, and further ones that the rows omit, for other programs.
    pub values: Vec<Value>,
}

/// A quantity with its unit and its value by each source; an empty cell is unknown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    /// The quantity, its circumstances and its unit.
    pub quantity: String,
    /// The value as printed in the paper.
    pub published: String,
    /// The value by the published method, as run here.
    pub theirs: String,
    /// The value by this library's own method.
    pub ours: String,
    /// The theoretical bound, or the requirement.
    pub limit: String,
}

impl Row {
    /// The cells as shown: a dash for an unknown value.
    pub fn cells(&self) -> [&str; 5] {
        let Self { quantity, published, theirs, ours, limit } = self;
        [quantity, published, theirs, ours, limit]
            .map(|text| if text.is_empty() { "—" } else { text })
    }
}

impl Comparison {
    /// A table without rows.
    pub fn new(id: impl Into<String>, title: impl Into<String>) -> Self {
        let (rows, values) = (Vec::new(), Vec::new());
        Self { id: id.into(), title: title.into(), rows, note: String::new(), values }
    }

    /// Adds a row whose number is by this library's own method.
    pub fn row(
        self,
        quantity: impl Into<String>,
        published: impl Into<String>,
        ours: impl Into<String>,
        limit: impl Into<String>,
    ) -> Self {
        self.beside(quantity, published, "", ours, limit)
    }

    /// Adds a row whose number is by the published method, as run here.
    pub fn repeated(
        self,
        quantity: impl Into<String>,
        published: impl Into<String>,
        theirs: impl Into<String>,
        limit: impl Into<String>,
    ) -> Self {
        self.beside(quantity, published, theirs, "", limit)
    }

    /// Adds a row with the numbers of both methods.
    pub fn beside(
        mut self,
        quantity: impl Into<String>,
        published: impl Into<String>,
        theirs: impl Into<String>,
        ours: impl Into<String>,
        limit: impl Into<String>,
    ) -> Self {
        self.rows.push(Row {
            quantity: quantity.into(),
            published: published.into(),
            theirs: theirs.into(),
            ours: ours.into(),
            limit: limit.into(),
        });
        self
    }

    /// Adds numbers for other programs.
    pub fn values(mut self, values: impl IntoIterator<Item = Value>) -> Self {
        self.values.extend(values);
        self
    }

    /// The names of the columns after that of the quantities, each with whether any row has a value in it.
    pub fn columns(&self) -> [(&'static str, bool); 4] {
        let any = |of: fn(&Row) -> &String| self.rows.iter().any(|row| !of(row).is_empty());
        [
            ("published", any(|row| &row.published)),
            ("published method, run here", any(|row| &row.theirs)),
            ("ours", any(|row| &row.ours)),
            ("limit", any(|row| &row.limit)),
        ]
    }

    /// Sets the explanation of differences.
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
        let columns = self.columns();
        let names = columns.iter().filter(|(_, is_shown)| *is_shown).map(|(name, _)| *name);
        table.set_header(std::iter::once("").chain(names));
        for row in &self.rows {
            let [quantity, cells @ ..] = row.cells();
            let cells = cells.into_iter().zip(columns).filter(|(_, (_, is_shown))| *is_shown);
            table.add_row(std::iter::once(quantity).chain(cells.map(|(cell, _)| cell)));
        }
        write!(f, "{table}")?;
        if self.note.is_empty() { Ok(()) } else { write!(f, "\n{}", self.note) }
    }
}
