//! Comma-separated tables with a header, of which some columns may be missing.

use std::path::Path;

use crate::Error;
use crate::text::{Header, Line, TextFile};

/// Beyond any clock, s: three centuries, within which a double resolves microseconds.
const LATEST_TIME: f64 = 1e10;
/// Beyond any place on earth in any projection, m.
pub(crate) const FARTHEST_POSITION: f64 = 1e8;

/// Reads a table: `row` is called for each line below the header.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read<T>(
    path: &Path,
    what: &str,
    columns: impl FnOnce(&Header<'_>) -> Result<T, Error>,
    mut row: impl FnMut(&T, &Row<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let file = TextFile::read(path)?;
    let mut lines = file.lines();
    let Some(first) = lines.next() else {
        return Err(file.error(format!("expected {what}, found an empty file")));
    };
    let header = Header::new(first);
    let columns = columns(&header)?;
    let mut empty = true;
    for line in lines {
        let fields = header.fields(&line)?;
        row(&columns, &Row { line, fields })?;
        empty = false;
    }
    if empty { Err(file.error(format!("expected {what}, found only a header"))) } else { Ok(()) }
}

/// A line below the header.
#[derive(Debug)]
pub struct Row<'a> {
    /// The line, for complaints.
    pub line: Line<'a>,
    fields: Vec<&'a str>,
}

impl<'a> Row<'a> {
    /// The text of a field; empty beyond the columns.
    pub fn text(&self, column: usize) -> &'a str {
        self.fields.get(column).copied().unwrap_or_default()
    }

    /// A finite number.
    ///
    /// # Errors
    /// [`Error::Line`] if it is anything else.
    pub fn number(&self, name: &str, column: usize) -> Result<f64, Error> {
        self.line.number(name, self.text(column))
    }

    /// Coordinates, m.
    ///
    /// # Errors
    /// [`Error::Line`] if one is not a number, or beyond the earth.
    pub fn coordinate(&self, name: &str, column: usize) -> Result<f64, Error> {
        let value = self.number(name, column)?;
        if value.abs() > FARTHEST_POSITION {
            return Err(self
                .line
                .error("expected a position in metres, found one beyond the earth"));
        }
        Ok(value)
    }

    /// A time in seconds, as microseconds.
    ///
    /// # Errors
    /// [`Error::Line`] if it is not a number, or beyond any clock.
    pub fn time_us(&self, column: usize) -> Result<i64, Error> {
        let seconds = self.number("t", column)?;
        if seconds.abs() > LATEST_TIME {
            return Err(self.line.error("expected a time in seconds, found one beyond any clock"));
        }
        Ok((seconds * 1e6).round() as i64)
    }
}
