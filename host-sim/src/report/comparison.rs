use std::fmt;

use serde::Serialize;

use super::value::Value;
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
    /// The numbers in the rows, and those that the rows leave out, for programs.
    pub values: Vec<Value>,
}

/// A quantity, with its unit, and what everyone says of it; an empty cell is unknown.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Row {
    /// What is measured, where and in which unit.
    pub quantity: String,
    /// As printed.
    pub published: String,
    /// By the published method, as it is run here.
    pub theirs: String,
    /// By this library's own.
    pub ours: String,
    /// What nothing can be better than, or what was asked for.
    pub limit: String,
}

impl Row {
    /// As it is shown: a dash for what is unknown.
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

    /// With another row, whose number is by this library's own method.
    pub fn row(
        self,
        quantity: impl Into<String>,
        published: impl Into<String>,
        ours: impl Into<String>,
        limit: impl Into<String>,
    ) -> Self {
        self.beside(quantity, published, "", ours, limit)
    }

    /// With another row, whose number is by the published method as it is run here.
    pub fn repeated(
        self,
        quantity: impl Into<String>,
        published: impl Into<String>,
        theirs: impl Into<String>,
        limit: impl Into<String>,
    ) -> Self {
        self.beside(quantity, published, theirs, "", limit)
    }

    /// With another row, of both methods.
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

    /// With more numbers for programs.
    pub fn values(mut self, values: impl IntoIterator<Item = Value>) -> Self {
        self.values.extend(values);
        self
    }

    /// Names of the columns that hold anything, after that of the quantities, and whether each column does.
    pub fn columns(&self) -> [(&'static str, bool); 4] {
        let any = |of: fn(&Row) -> &String| self.rows.iter().any(|row| !of(row).is_empty());
        [
            ("published", any(|row| &row.published)),
            ("published method, run here", any(|row| &row.theirs)),
            ("ours", any(|row| &row.ours)),
            ("limit", any(|row| &row.limit)),
        ]
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
