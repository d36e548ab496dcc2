//! Text files other than tables, read so that every error names the file and the line; and text for people.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use crate::Error;

/// The size of the largest file that is read into memory, in bytes.
const LARGEST: u64 = 1 << 30;
/// The length of a file's beginning, in bytes: enough to recognise a table.
const BEGINNING: u64 = 1 << 16;

/// Reads the contents of a file.
///
/// # Errors
/// [`Error::Read`] if it cannot be read, or is too large.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Error> {
    let read = regular(path).and_then(|size| match size {
        0..=LARGEST => fs::read(path),
        _ => Err(io::Error::other("it is larger than 1 GiB, which no log of use is")),
    });
    read.map_err(|source| Error::Read { path: path.to_path_buf(), source })
}

/// Reads the contents of a log, unpacked if they are packed with gzip.
///
/// # Errors
/// Those of [`bytes`]; [`Error::File`] if it cannot be unpacked.
pub fn unpacked(path: &Path) -> Result<Vec<u8>, Error> {
    let unpacked = kestirim_import::unpacked(bytes(path)?.into()).map(Cow::into_owned);
    unpacked.map_err(|error| Error::File { path: path.to_path_buf(), problem: error.to_string() })
}

/// The first whole lines of a file, at most some tens of kilobytes.
///
/// # Errors
/// An error if the file cannot be read.
pub fn beginning(path: &Path) -> io::Result<Vec<u8>> {
    regular(path)?;
    let mut bytes = Vec::new();
    File::open(path)?.take(BEGINNING).read_to_end(&mut bytes)?;
    if bytes.len() as u64 == BEGINNING {
        let whole = bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
        bytes.truncate(whole);
    }
    Ok(bytes)
}

/// The size of a regular file, in bytes. Pipes and devices are refused: they may never begin or end.
///
/// # Errors
/// An error if there is no file of this name, or it is not a regular one.
pub fn regular(path: &Path) -> io::Result<u64> {
    let file = fs::metadata(path)?;
    if file.is_file() || file.is_dir() {
        // The operating system reports what is wrong with a folder.
        return Ok(file.len());
    }
    Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a pipe or a device, not a file"))
}

/// A text file in memory.
#[derive(Debug, Clone)]
pub struct TextFile {
    path: PathBuf,
    text: String,
}

impl TextFile {
    /// Reads a file as UTF-8, which may be packed with gzip.
    ///
    /// # Errors
    /// Those of [`unpacked`]; [`Error::Line`] where it is not text.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::from_bytes(path, unpacked(path)?)
    }

    /// Takes the contents of the file `path`; a byte order mark is dropped.
    ///
    /// # Errors
    /// [`Error::Line`] where the bytes are not UTF-8.
    pub fn from_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, Error> {
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = valid.split(|&byte| byte == b'\n').count();
            let problem = "expected text, found bytes that are not UTF-8".to_owned();
            Error::Line { path: path.to_path_buf(), line, problem }
        })?;
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        Ok(Self { path: path.to_path_buf(), text })
    }

    /// Parses the file as JSON.
    ///
    /// # Errors
    /// [`Error::Line`] that says what was `expected`, and what the parser found instead.
    pub fn json<T: DeserializeOwned>(&self, expected: &str) -> Result<T, Error> {
        Ok(self.json_with_unused(expected)?.0)
    }

    /// Parses the file as JSON and returns the paths of unused fields as well: `noise.inputz`.
    ///
    /// # Errors
    /// Those of [`TextFile::json`].
    pub fn json_with_unused<T: DeserializeOwned>(
        &self,
        expected: &str,
    ) -> Result<(T, Vec<String>), Error> {
        let mut unused = Vec::new();
        let mut json = serde_json::Deserializer::from_str(&self.text);
        let contents =
            // Optional values appear as a question mark in the path.
            serde_ignored::deserialize(&mut json, |path| unused.push(path.to_string().replace(".?", "")));
        let ended = contents.and_then(|contents| json.end().map(|()| contents));
        let contents = ended.map_err(|error| {
            let complaint = error.to_string();
            // The parser's message ends with the location, which `Error::Line` states first.
            let reason = complaint.split(" at line ").next().unwrap_or_default();
            let problem = format!("expected {expected}: {reason}");
            Error::Line { path: self.path.clone(), line: error.line(), problem }
        })?;
        Ok((contents, unused))
    }

    /// The lines that are not blank, trimmed.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        let numbered = self.text.lines().enumerate();
        let trimmed =
            numbered.map(|(i, text)| Line { file: self, number: i + 1, text: text.trim() });
        trimmed.filter(|line| !line.text.is_empty())
    }

    /// An error about the file as a whole.
    pub fn error(&self, problem: impl Into<String>) -> Error {
        Error::File { path: self.path.clone(), problem: problem.into() }
    }
}

/// A line of a [`TextFile`].
#[derive(Debug, Clone, Copy)]
pub struct Line<'a> {
    file: &'a TextFile,
    number: usize,
    /// The line without surrounding whitespace.
    pub text: &'a str,
}

impl Line<'_> {
    /// An error about this line.
    pub fn error(&self, problem: impl Into<String>) -> Error {
        let path = self.file.path.clone();
        Error::Line { path, line: self.number, problem: problem.into() }
    }
}

/// Quotes an excerpt of a file, shortened and escaped so that it stays on one line of a terminal.
pub fn printable(text: &str) -> String {
    const LONGEST: usize = 24;
    if text.is_empty() {
        return "nothing".to_owned();
    }
    let start: String = text.chars().take(LONGEST).collect();
    let dots = if text.chars().nth(LONGEST).is_some() { "…" } else { "" };
    format!("\"{}{dots}\"", start.escape_debug())
}

/// Joins words into a shell command: words with other characters than letters, digits and a few signs are quoted.
pub fn command_line(words: impl IntoIterator<Item = String>) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "-_./,:=+%@°".contains(letter);
    let quoted = words.into_iter().map(|word| {
        let is_plain = !word.is_empty() && word.chars().all(plain);
        if is_plain { word } else { format!("'{}'", word.replace('\'', "'\\''")) }
    });
    quoted.collect::<Vec<_>>().join(" ")
}

/// Lists names from a file in a message, at most `most` of them.
pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>, most: usize) -> String {
    let mut names = names.into_iter();
    let mut told: Vec<_> = names.by_ref().take(most).map(printable).collect();
    let more = names.count();
    if more > 0 {
        told.push(format!("and {more} more"));
    }
    told.join(", ")
}

/// The name of a file, without its folders.
pub fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Formats a path as a user would write it, on one line whatever its name holds.
pub fn printable_path(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "?")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(bytes: &[u8]) -> Result<TextFile, Error> {
        TextFile::from_bytes(Path::new("walk.csv"), bytes.to_vec())
    }

    #[test]
    fn words_of_a_command_are_quoted_where_a_shell_needs_it() {
        let words = ["host-sim", "--log", "my walk.txt", "it's", ""].map(str::to_owned);
        assert_eq!(command_line(words), r"host-sim --log 'my walk.txt' 'it'\''s' ''");
    }

    #[test]
    fn blank_lines_are_skipped_but_counted() -> Result<(), Error> {
        let file = file(b"\xef\xbb\xbfa\r\n\r\n  \n b \n")?;
        let lines: Vec<_> = file.lines().map(|line| (line.number, line.text)).collect();
        assert_eq!(lines, [(1, "a"), (4, "b")]);
        Ok(())
    }

    #[test]
    fn invalid_text_is_located() {
        let error = file(b"t\n1\n\xff").unwrap_err().to_string();
        assert_eq!(error, "walk.csv, line 3: expected text, found bytes that are not UTF-8");
    }

    #[test]
    fn complaints_stay_on_one_short_line() {
        assert_eq!(printable("a\nb\0"), r#""a\nb\0""#);
        assert_eq!(printable(&"x".repeat(1000)).chars().count(), 27);
        assert_eq!(printable_path(Path::new("a\nb")), "a?b");
    }
}
