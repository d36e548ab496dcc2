//! Lines of fixed columns, as bytes, because headers hold names in any encoding.

use std::path::{Path, PathBuf};

use crate::error::{Error, Warning, quoted};
use crate::fields::{decimal, integer};
use crate::kind::in_words;
use crate::time::GpsTime;

/// A file's unpacked text in memory, with the file's name.
///
/// The readers accept it where a file is available as bytes, or serves several readers.
#[derive(Debug, Clone)]
pub struct Text {
    path: PathBuf,
    bytes: Vec<u8>,
}

/// A text without the byte order mark that editors put before it.
pub(crate) fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes)
}

impl Text {
    pub(crate) fn new(path: &Path, bytes: Vec<u8>) -> Self {
        Self { path: path.to_path_buf(), bytes }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The lines of the text, including blank ones.
    pub(crate) fn lines(&self) -> Lines<'_> {
        Lines { text: self, position: 0 }
    }

    /// An error about the file as a whole.
    pub(crate) fn error(&self, problem: impl Into<String>) -> Error {
        Error::File { path: self.path.clone(), problem: problem.into() }
    }

    /// A warning about the file as a whole.
    pub(crate) fn warning(&self, problem: impl Into<String>) -> Warning {
        Warning { path: self.path.clone(), line: None, problem: problem.into() }
    }

    /// Whether the last line is complete, unlike that of a file that was cut off.
    pub(crate) fn ends_with_line_break(&self) -> bool {
        self.bytes.last() == Some(&b'\n')
    }

    /// The error that the file is of another format than `expected`.
    pub(crate) fn wrong_kind(&self, expected: &str) -> Error {
        self.error(format!("expected {expected}, found {}", in_words(&self.bytes)))
    }
}

/// The remaining lines of a [`Text`].
#[derive(Debug, Clone)]
pub(crate) struct Lines<'a> {
    text: &'a Text,
    position: usize,
}

impl<'a> Lines<'a> {
    /// Whether all lines have been read.
    pub(crate) fn is_at_end(&self) -> bool {
        self.position >= self.text.bytes.len()
    }

    /// Skips past the next line that contains `words`, or to the end.
    pub(crate) fn skip_past(&mut self, words: &memchr::memmem::Finder<'_>) {
        let rest = &self.text.bytes[self.position..];
        self.position += words.find(rest).unwrap_or(rest.len());
        self.next();
    }

    /// Skips to the next line that begins with `>`, as epochs do, or to the end.
    pub(crate) fn skip_to_epoch(&mut self) {
        let rest = &self.text.bytes[self.position..];
        if !rest.starts_with(b">") {
            let next = memchr::memmem::find(rest, b"\n>").map(|before| before + 1);
            self.position += next.unwrap_or(rest.len());
        }
    }

    /// The next line, where the record requires one.
    ///
    /// # Errors
    /// [`Error::File`] at the end of the file.
    pub(crate) fn expect(&mut self, what: &str) -> Result<Line<'a>, Error> {
        self.next()
            .ok_or_else(|| self.text.error(format!("expected {what}, found the end of the file")))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let start = self.position;
        let rest = self.text.bytes.get(start..).filter(|rest| !rest.is_empty())?;
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        // The last line may have no break.
        self.position = (start + length + 1).min(self.text.bytes.len());
        let bytes = rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length]);
        Some(Line { text: self.text, start, bytes })
    }
}

/// A line of a [`Text`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Line<'a> {
    text: &'a Text,
    start: usize,
    /// The line without its line break.
    pub(crate) bytes: &'a [u8],
}

impl<'a> Line<'a> {
    /// The line's number, from 1.
    pub(crate) fn number(&self) -> usize {
        memchr::memchr_iter(b'\n', &self.text.bytes[..self.start]).count() + 1
    }

    /// An error about this line.
    pub(crate) fn error(&self, problem: impl Into<String>) -> Error {
        let path = self.text.path.clone();
        Error::Line { path, line: self.number(), problem: problem.into() }
    }

    /// The error that something else was expected in this line.
    pub(crate) fn expected(&self, what: &str) -> Error {
        self.expected_instead_of(what, self.bytes)
    }

    /// A warning about this line.
    pub(crate) fn warning(&self, problem: impl Into<String>) -> Warning {
        let line = Some(self.number());
        Warning { path: self.text.path.clone(), line, problem: problem.into() }
    }

    /// The bytes from column `from` up to, not including, column `to`, counted from 0, without surrounding blanks;
    /// empty beyond the end of the line.
    pub(crate) fn columns(&self, from: usize, to: usize) -> &'a [u8] {
        let to = to.min(self.bytes.len());
        self.bytes.get(from..to).unwrap_or_default().trim_ascii()
    }

    /// The byte in a column; a blank beyond the end of the line.
    pub(crate) fn column(&self, place: usize) -> u8 {
        self.bytes.get(place).copied().unwrap_or(b' ')
    }

    /// The text between two columns, without trailing blanks.
    pub(crate) fn text(&self, from: usize, to: usize) -> String {
        let field = self.bytes.get(from..to.min(self.bytes.len())).unwrap_or_default();
        String::from_utf8_lossy(field.trim_ascii_end()).into_owned()
    }

    /// The label of a header line, in columns 60 to 80.
    pub(crate) fn label(&self) -> &'a [u8] {
        self.columns(60, 80)
    }

    /// The finite number between two columns; `None` if they are blank.
    ///
    /// # Errors
    /// [`Error::Line`] if it is anything else, or if the line ends within it.
    pub(crate) fn optional_number(
        &self,
        what: &str,
        from: usize,
        to: usize,
    ) -> Result<Option<f64>, Error> {
        let field = self.columns(from, to);
        if field.is_empty() {
            return Ok(None);
        }
        self.finite_of(field, what, to).map(Some)
    }

    /// The finite number between two columns, right-aligned as Fortran writes it: if a file is cut off within a number,
    /// the missing digits are unknown.
    ///
    /// # Errors
    /// [`Error::Line`] if there is anything else, or if the line ends within the number.
    pub(crate) fn finite(&self, what: &str, from: usize, to: usize) -> Result<f64, Error> {
        self.finite_of(self.columns(from, to), what, to)
    }

    fn finite_of(&self, field: &[u8], what: &str, to: usize) -> Result<f64, Error> {
        if !field.is_empty() && self.bytes.len() < to {
            let end = self.bytes.len();
            return Err(self.error(format!(
                "expected {what} up to column {to}, found the line's end in column {end}: cut off?"
            )));
        }
        decimal(field).ok_or_else(|| self.expected_instead_of(what, field))
    }

    /// The number of lines or items between two columns.
    ///
    /// # Errors
    /// [`Error::Line`] if there is no such number.
    pub(crate) fn count(&self, what: &str, from: usize, to: usize) -> Result<usize, Error> {
        let field = self.columns(from, to);
        let count = integer(field).and_then(|count| usize::try_from(count).ok());
        count.ok_or_else(|| self.expected_instead_of(what, field))
    }

    /// The instant whose year, month, day, hour, minute and second stand between the given columns.
    ///
    /// # Errors
    /// [`Error::Line`] if there is none.
    pub(crate) fn time(&self, columns: [usize; 7]) -> Result<GpsTime, Error> {
        self.short_time(columns, |year| year)
    }

    /// The instant as [`Self::time`] reads it, where `full` converts the year in the file to a full year.
    ///
    /// # Errors
    /// Those of [`Self::time`].
    pub(crate) fn short_time(
        &self,
        columns: [usize; 7],
        full: impl FnOnce(i32) -> i32,
    ) -> Result<GpsTime, Error> {
        let [year, .., second, end] = columns;
        let complaint = || self.expected_instead_of("a date and time", self.columns(year, end));
        let mut calendar = [0; 5];
        for (i, field) in calendar.iter_mut().enumerate() {
            *field = integer(self.columns(columns[i], columns[i + 1])).ok_or_else(complaint)?;
        }
        calendar[0] = full(calendar[0]);
        let second = decimal(self.columns(second, end)).ok_or_else(complaint)?;
        GpsTime::from_calendar(calendar, second).ok_or_else(complaint)
    }

    fn expected_instead_of(&self, what: &str, found: &[u8]) -> Error {
        self.error(format!("expected {what}, found {}", quoted(found)))
    }
}
