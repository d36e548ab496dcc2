//! Rows as CSV.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use csv::{ReaderBuilder, StringRecord, WriterBuilder};

use super::Told;
use crate::{Column, Error, Value};

/// The character that begins a comment.
const COMMENT: u8 = b'#';

#[derive(Debug)]
pub(super) struct Writer {
    rows: csv::Writer<BufWriter<File>>,
    text: String,
}

impl Writer {
    pub(super) fn new(file: File, columns: &[Column], head: &str) -> io::Result<Self> {
        let mut file = BufWriter::new(file);
        writeln!(file, "# {head}")?;
        // A text that begins like a comment is quoted.
        let mut rows = WriterBuilder::new().comment(Some(COMMENT)).from_writer(file);
        rows.write_record(columns.iter().map(|column| &column.name))?;
        Ok(Self { rows, text: String::new() })
    }

    pub(super) fn write(&mut self, row: &[Value]) -> io::Result<()> {
        for value in row {
            self.text.clear();
            // Writing to a `String` cannot fail.
            let _ = write!(self.text, "{value}");
            self.rows.write_field(&self.text)?;
        }
        Ok(self.rows.write_record(None::<&[u8]>)?)
    }

    pub(super) fn finish(self, tail: &str) -> io::Result<File> {
        let mut file = self.rows.into_inner().map_err(csv::IntoInnerError::into_error)?;
        writeln!(file, "# {tail}")?;
        file.into_inner().map_err(io::IntoInnerError::into_error)
    }
}

#[derive(Debug)]
pub(super) struct Reader {
    rows: csv::Reader<BufReader<File>>,
    record: StringRecord,
}

impl Reader {
    pub(super) fn open(path: &Path) -> Result<(Told, Self), Error> {
        let failed = Error::read(path);
        let ends = || {
            let mut file = BufReader::new(File::open(path)?);
            let mut head = Vec::new();
            file.read_until(b'\n', &mut head)?;
            let tail = last_line(file.get_mut())?;
            file.seek(SeekFrom::Start(0))?;
            Ok((comment(&head), comment(&tail), file))
        };
        let (head, tail, file) = ends().map_err(failed)?;
        let mut rows = ReaderBuilder::new().comment(Some(COMMENT)).from_reader(file);
        let columns = rows.headers().map_err(|error| wrong(path, &error))?;
        let columns = columns.iter().map(str::to_owned).collect();
        Ok((Told { head, tail, columns }, Self { rows, record: StringRecord::new() }))
    }

    pub(super) fn read(&mut self, path: &Path, row: &mut Vec<Value>) -> Result<bool, Error> {
        let there = self.rows.read_record(&mut self.record).map_err(|error| wrong(path, &error))?;
        if there {
            row.extend(self.record.iter().map(Value::from));
        }
        Ok(there)
    }
}

fn wrong(path: &Path, error: &csv::Error) -> Error {
    let problem = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("expected {expected_len} values, found {len}")
        }
        csv::ErrorKind::Utf8 { .. } => "expected UTF-8".to_owned(),
        _ => return Error::file(path, error.to_string()),
    };
    match error.position() {
        Some(position) => {
            Error::Line { path: path.to_owned(), line: position.line() as usize, problem }
        }
        None => Error::file(path, problem),
    }
}

/// The content of a comment line; empty if the line is not a comment.
fn comment(line: &[u8]) -> String {
    let text = std::str::from_utf8(line).unwrap_or_default();
    text.strip_prefix('#').map_or_else(String::new, |text| text.trim().to_owned())
}

/// The last line, of whatever length.
fn last_line(file: &mut File) -> io::Result<Vec<u8>> {
    let length = file.seek(SeekFrom::End(0))?;
    let mut size = 4096;
    loop {
        let begin = length.saturating_sub(size);
        file.seek(SeekFrom::Start(begin))?;
        let mut end = Vec::new();
        file.take(length - begin).read_to_end(&mut end)?;
        let text = end.strip_suffix(b"\n").unwrap_or(&end);
        if let Some(before) = text.iter().rposition(|&byte| byte == b'\n') {
            return Ok(text[before + 1..].to_vec());
        }
        if begin == 0 {
            return Ok(text.to_vec());
        }
        size *= 4;
    }
}
