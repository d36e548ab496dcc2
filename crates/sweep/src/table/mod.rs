//! Files of rows: CSV, and Parquet if it is built in, by their endings.
//!
//! A CSV file begins with a comment, which tells where its rows come from, and ends with one, which tells how many there
//! are and what was read: a line of `#` and a JSON object each. In a Parquet file both are metadata.

mod csv_file;
#[cfg(feature = "parquet")]
mod parquet_file;

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process;

use serde::Serialize;
use serde_json::Value as Json;

use crate::{Column, Error, Value};

/// Endings of files of rows.
pub const ENDINGS: &[&str] = if cfg!(feature = "parquet") { &["csv", "parquet"] } else { &["csv"] };

/// The format of a file by its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Csv,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    fn of(path: &Path) -> Result<Self, Error> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some(ending) if ending.eq_ignore_ascii_case("csv") => Ok(Self::Csv),
            #[cfg(feature = "parquet")]
            Some(ending) if ending.eq_ignore_ascii_case("parquet") => Ok(Self::Parquet),
            #[cfg(not(feature = "parquet"))]
            Some(ending) if ending.eq_ignore_ascii_case("parquet") => {
                let problem =
                    "this program was built without Parquet (--features parquet); expected .csv";
                Err(Error::file(path, problem))
            }
            _ => Err(Error::file(
                path,
                format!("expected a name that ends in .{}", ENDINGS.join(" or .")),
            )),
        }
    }
}

/// Whether a file would be one of rows.
///
/// # Errors
/// [`Error::File`] if its ending says that it would not.
pub fn check_ending(path: &Path) -> Result<(), Error> {
    Format::of(path).map(|_| ())
}

/// A file of rows that is being written: beside its place, and there once it is whole.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    draft: PathBuf,
    rows: u64,
    open: Option<Open>,
}

#[derive(Debug)]
enum Open {
    Csv(Box<csv_file::Writer>),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet_file::Writer>),
}

impl Writer {
    /// Begins a file with what is known of its rows.
    ///
    /// # Errors
    /// [`Error::File`] for another ending, [`Error::Write`].
    pub fn create(path: &Path, columns: &[Column], head: &impl Serialize) -> Result<Self, Error> {
        let format = Format::of(path)?;
        let failed = Error::write(path);
        let begin = || {
            // Renaming over a device would replace the device.
            if path.exists() && !path.is_file() {
                return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no regular file"));
            }
            let name =
                path.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidFilename))?;
            let name = name.to_string_lossy();
            remove_abandoned(path, &name);
            let draft = path.with_file_name(format!(".{name}.{}.tmp", process::id()));
            let file = File::create_new(&draft)?;
            // Held for as long as the file is open: what nobody holds is abandoned. Some network's file systems know no
            // locks; drafts stay there.
            let _ = file.try_lock();
            let head = serde_json::to_string(head)?;
            let open = match format {
                Format::Csv => Open::Csv(Box::new(csv_file::Writer::new(file, columns, &head)?)),
                #[cfg(feature = "parquet")]
                Format::Parquet => {
                    Open::Parquet(Box::new(parquet_file::Writer::new(file, columns, head)?))
                }
            };
            Ok((draft, open))
        };
        let (draft, open) = begin().map_err(failed)?;
        Ok(Self { path: path.to_owned(), draft, rows: 0, open: Some(open) })
    }

    /// Writes a row, a value a column.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn write(&mut self, row: &[Value]) -> Result<(), Error> {
        self.rows += 1;
        let written = match &mut self.open {
            Some(Open::Csv(file)) => file.write(row),
            #[cfg(feature = "parquet")]
            Some(Open::Parquet(file)) => file.write(row),
            None => Ok(()),
        };
        written.map_err(Error::write(&self.path))
    }

    /// Ends the file with what is known by now, and puts it into its place.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn finish(mut self, tail: &Tail) -> Result<(), Error> {
        let (failed, rows) = (Error::write(&self.path), self.rows);
        let mut end = || {
            let tail = serde_json::to_string(&Tail { rows, ..tail.clone() })?;
            let file = match self.open.take() {
                Some(Open::Csv(file)) => file.finish(&tail)?,
                #[cfg(feature = "parquet")]
                Some(Open::Parquet(file)) => file.finish(tail)?,
                None => return Ok(()),
            };
            file.sync_all()?;
            fs::rename(&self.draft, &self.path)
        };
        end().map_err(failed)
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        if self.open.take().is_some() {
            // Half a file serves nobody; if it cannot be removed it is in nobody's way.
            let _ = fs::remove_file(&self.draft);
        }
    }
}

/// Removes drafts that a program left when it was killed.
fn remove_abandoned(path: &Path, name: &str) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let Ok(entries) = fs::read_dir(folder.unwrap_or(Path::new("."))) else { return };
    let (first, last) = (format!(".{name}."), ".tmp");
    for entry in entries.flatten() {
        let other = entry.file_name();
        let draft = other.to_str().and_then(|it| it.strip_prefix(&first)?.strip_suffix(last));
        if draft.is_some_and(|id| id.bytes().all(|byte| byte.is_ascii_digit())) {
            let abandoned = File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok());
            if abandoned {
                let _ = fs::remove_file(entry.path());
            }
        }
    }
}

/// What is known of rows once they are there.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Tail {
    /// How many.
    pub rows: u64,
    /// Files that were read.
    #[serde(default)]
    pub inputs: Vec<crate::Input>,
    /// What a user should know.
    #[serde(default)]
    pub warnings: Vec<String>,
}

/// A file of rows.
#[derive(Debug)]
pub struct Reader {
    path: PathBuf,
    /// Where its rows come from.
    pub head: Json,
    /// What is known of all of them.
    pub tail: Tail,
    /// Names of its columns.
    pub columns: Vec<String>,
    open: Source,
}

#[derive(Debug)]
enum Source {
    Csv(Box<csv_file::Reader>),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet_file::Reader>),
}

/// What both kinds of files tell before their rows.
struct Told {
    head: String,
    tail: String,
    columns: Vec<String>,
}

impl Reader {
    /// Opens a file.
    ///
    /// # Errors
    /// [`Error::Read`]; [`Error::File`] if it is not one that a [`Writer`] wrote.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let (told, open) = match Format::of(path)? {
            Format::Csv => {
                let (told, reader) = csv_file::Reader::open(path)?;
                (told, Source::Csv(Box::new(reader)))
            }
            #[cfg(feature = "parquet")]
            Format::Parquet => {
                let (told, reader) = parquet_file::Reader::open(path)?;
                (told, Source::Parquet(Box::new(reader)))
            }
        };
        let head = serde_json::from_str(&told.head);
        let head = head.map_err(|_| Error::file(path, "expected a file that a sweep wrote"))?;
        let tail = serde_json::from_str(&told.tail);
        let tail = tail
            .map_err(|_| Error::file(path, "its end is missing: expected how many rows it has"))?;
        Ok(Self { path: path.to_owned(), head, tail, columns: told.columns, open })
    }

    /// Reads the next row; false if there is none.
    ///
    /// # Errors
    /// [`Error::Line`] and [`Error::File`] for what is no row of the file's columns.
    pub fn read(&mut self, row: &mut Vec<Value>) -> Result<bool, Error> {
        row.clear();
        match &mut self.open {
            Source::Csv(reader) => reader.read(&self.path, row),
            #[cfg(feature = "parquet")]
            Source::Parquet(reader) => reader.read(&self.path, row),
        }
    }
}

#[cfg(test)]
mod tests;
