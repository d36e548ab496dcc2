//! Lines of fixed columns, in bytes: headers hold names in any encoding.

use std::path::{Path, PathBuf};

use kestirim_gnss_ppp::GpsTime;

use super::fields::{decimal, integer};
use super::time::from_calendar;
use super::{compressed, crinex};
use crate::Error;
use crate::text::printable;

/// A text in memory, as unpacked from its file.
#[derive(Debug, Clone)]
pub struct Text {
    path: PathBuf,
    bytes: Vec<u8>,
}

impl Text {
    /// Reads a file, which may be compressed.
    ///
    /// # Errors
    /// [`Error::Read`] if it cannot be read, [`Error::File`] or [`Error::Line`] if it cannot be unpacked.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::unpack(path, compressed::read(path)?)
    }

    /// Takes the contents of the file `path`, which may be compressed.
    ///
    /// # Errors
    /// [`Error::File`] or [`Error::Line`] if they cannot be unpacked.
    pub fn unpack(path: &Path, bytes: Vec<u8>) -> Result<Self, Error> {
        let bytes = compressed::unpack(path, bytes)?;
        let text = Self { path: path.to_path_buf(), bytes };
        if crinex::is_compressed(&text.bytes) {
            let bytes = crinex::decompress(&text, compressed::LARGEST)?;
            return Ok(Self { bytes, ..text });
        }
        Ok(text)
    }

    /// Its lines, blank ones too.
    pub fn lines(&self) -> Lines<'_> {
        Lines { text: self, position: 0 }
    }

    /// A complaint about the file as a whole.
    pub fn error(&self, problem: impl Into<String>) -> Error {
        Error::File { path: self.path.clone(), problem: problem.into() }
    }

    /// A warning about the file as a whole: the sentence that an error would be.
    pub fn warning(&self, problem: impl Into<String>) -> String {
        self.error(problem).to_string()
    }

    /// Whether the last line is complete; that of a file cut off is not.
    pub fn ends_with_line_break(&self) -> bool {
        self.bytes.last() == Some(&b'\n')
    }

    /// The complaint that this is not `expected`, but what its first line tells.
    pub fn wrong_kind(&self, expected: &str) -> Error {
        self.error(format!("expected {expected}, found {}", kind(&self.bytes)))
    }
}

/// What a text is, by its beginning.
fn kind(bytes: &[u8]) -> String {
    const RINEX: &[u8] = b"RINEX VERSION / TYPE";
    let first = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let start = first.trim_ascii_start();
    let named = |label: &[u8]| memchr::memmem::find(first, label).is_some();
    let name = match first {
        [] if bytes.is_empty() => "an empty file",
        _ if named(RINEX) => match first.get(20).filter(|byte| **byte != b' ').or(first.get(21)) {
            Some(b'O') => "observations (RINEX)",
            Some(b'N' | b'G' | b'E' | b'H' | b'L') => "a navigation file (RINEX)",
            Some(b'M') => "a meteorological file (RINEX)",
            Some(b'C') => "satellite clocks (RINEX)",
            _ => "a RINEX file of another type",
        },
        _ if named(b"ANTEX VERSION") => "antenna patterns (ANTEX)",
        _ if named(b"IONEX VERSION") => "an ionosphere map (IONEX)",
        [b'#', b'a'..=b'd', b'P' | b'V', ..] => "orbits (SP3)",
        _ if start.starts_with(b"$$") => "ocean loading (BLQ)",
        _ if start.starts_with(b"<") => "a web page: the download did not work",
        _ => return printable(&String::from_utf8_lossy(first.trim_ascii())),
    };
    name.to_owned()
}

/// The lines of a [`Text`] from some place on.
#[derive(Debug, Clone)]
pub struct Lines<'a> {
    text: &'a Text,
    position: usize,
}

impl<'a> Lines<'a> {
    /// The line that comes next, which stays there.
    pub fn peek(&self) -> Option<Line<'a>> {
        self.clone().next()
    }

    /// Whether there is no line left.
    pub fn is_at_end(&self) -> bool {
        self.position >= self.text.bytes.len()
    }

    /// Goes on behind the next line that holds `words`, or to the end.
    pub fn skip_past(&mut self, words: &memchr::memmem::Finder<'_>) {
        let rest = &self.text.bytes[self.position..];
        self.position += words.find(rest).unwrap_or(rest.len());
        self.next();
    }

    /// The next line of a record that goes on.
    ///
    /// # Errors
    /// [`Error::File`] at the end of the file.
    pub fn expect(&mut self, what: &str) -> Result<Line<'a>, Error> {
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
pub struct Line<'a> {
    text: &'a Text,
    start: usize,
    /// The line without its line break.
    pub bytes: &'a [u8],
}

impl<'a> Line<'a> {
    /// The line's number, from 1.
    pub fn number(&self) -> usize {
        memchr::memchr_iter(b'\n', &self.text.bytes[..self.start]).count() + 1
    }

    /// A complaint about this line.
    pub fn error(&self, problem: impl Into<String>) -> Error {
        let path = self.text.path.clone();
        Error::Line { path, line: self.number(), problem: problem.into() }
    }

    /// The complaint that something else was expected in this line.
    pub fn expected(&self, what: &str) -> Error {
        self.expected_instead_of(what, self.bytes)
    }

    /// A warning about this line: the sentence that an error would be.
    pub fn warning(&self, problem: impl Into<String>) -> String {
        self.error(problem).to_string()
    }

    /// The bytes from one column to before another, counted from 0, without surrounding blanks; nothing
    /// beyond the line's end.
    pub fn columns(&self, from: usize, to: usize) -> &'a [u8] {
        let to = to.min(self.bytes.len());
        self.bytes.get(from..to).unwrap_or_default().trim_ascii()
    }

    /// The byte in a column, blank beyond the line's end.
    pub fn column(&self, place: usize) -> u8 {
        self.bytes.get(place).copied().unwrap_or(b' ')
    }

    /// The text between two columns, without blanks behind it.
    pub fn text(&self, from: usize, to: usize) -> String {
        let field = self.bytes.get(from..to.min(self.bytes.len())).unwrap_or_default();
        String::from_utf8_lossy(field.trim_ascii_end()).into_owned()
    }

    /// What a line of a header says it is, in columns 60 to 80.
    pub fn label(&self) -> &'a [u8] {
        self.columns(60, 80)
    }

    /// The finite number between two columns, none if they are blank.
    ///
    /// # Errors
    /// [`Error::Line`] if it is anything else.
    pub fn optional_number(
        &self,
        what: &str,
        from: usize,
        to: usize,
    ) -> Result<Option<f64>, Error> {
        let field = self.columns(from, to);
        if field.is_empty() {
            return Ok(None);
        }
        decimal(field).map(Some).ok_or_else(|| self.expected_instead_of(what, field))
    }

    /// The finite number between two columns.
    ///
    /// # Errors
    /// [`Error::Line`] if there is anything else.
    pub fn finite(&self, what: &str, from: usize, to: usize) -> Result<f64, Error> {
        let field = self.columns(from, to);
        decimal(field).ok_or_else(|| self.expected_instead_of(what, field))
    }

    /// The integer between two columns.
    ///
    /// # Errors
    /// [`Error::Line`] if there is anything else.
    pub fn integer(&self, what: &str, from: usize, to: usize) -> Result<i32, Error> {
        let field = self.columns(from, to);
        integer(field).ok_or_else(|| self.expected_instead_of(what, field))
    }

    /// How many lines or items follow, between two columns.
    ///
    /// # Errors
    /// [`Error::Line`] if there is no such number.
    pub fn count(&self, what: &str, from: usize, to: usize) -> Result<usize, Error> {
        let field = self.columns(from, to);
        let count = integer(field).and_then(|count| usize::try_from(count).ok());
        count.ok_or_else(|| self.expected_instead_of(what, field))
    }

    /// The instant whose year, month, day, hour, minute and second stand between the given columns.
    ///
    /// # Errors
    /// [`Error::Line`] if there is none.
    pub fn time(&self, columns: [usize; 7]) -> Result<GpsTime, Error> {
        self.short_time(columns, |year| year)
    }

    /// The instant as in [`Self::time`], where `full` makes a whole year of the one in the file.
    ///
    /// # Errors
    /// As [`Self::time`].
    pub fn short_time(
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
        from_calendar(calendar, second).ok_or_else(complaint)
    }

    fn expected_instead_of(&self, what: &str, found: &[u8]) -> Error {
        let found = printable(&String::from_utf8_lossy(found.trim_ascii()));
        self.error(format!("expected {what}, found {found}"))
    }
}
