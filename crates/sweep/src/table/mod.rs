//! Files of rows: CSV, and Parquet if it is built in, told apart by the file extension.
//!
//! A CSV file begins with a comment on the origin of its rows, and ends with a comment on their number and the files
//! that were read: each a line with `#` and a JSON object. In a Parquet file, both are metadata.

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

/// The extensions of files of rows.
pub const ENDINGS: &[&str] = if cfg!(feature = "parquet") { &["csv", "parquet"] } else { &["csv"] };

/// The format of a file, given by its extension.
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

/// Checks that the extension of a file is one of a file of rows.
///
/// # Errors
/// [`Error::File`] if it is not.
pub fn check_ending(path: &Path) -> Result<(), Error> {
    Format::of(path).map(|_| ())
}

/// The writer of a file of rows: it writes a draft beside the file's place, and renames it once it is complete.
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
    /// Creates a file with its columns and head.
    ///
    /// # Errors
    /// [`Error::File`] for an unknown file extension; [`Error::Write`].
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
            // The lock is held while the file is open: a draft without one is abandoned. Some network file systems have
            // no locks; abandoned drafts remain there.
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

    /// Writes a row, one value per column.
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

    /// Completes the file with its tail and renames it to its place.
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
            // Half a file is of no use; if it cannot be removed, it does no harm.
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

/// What is known of rows once they are complete.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, serde::Deserialize)]
pub struct Tail {
    /// The number of rows.
    pub rows: u64,
    /// The files that were read.
    #[serde(default)]
    pub inputs: Vec<crate::Input>,
    /// Warnings for the user.
    #[serde(default)]
    pub warnings: Vec<String>,
}

/// The reader of a file of rows.
#[derive(Debug)]
pub struct Reader {
    path: PathBuf,
    /// The head: where the rows come from.
    pub head: Json,
    /// The tail: what is known of all rows.
    pub tail: Tail,
    /// The names of the columns.
    pub columns: Vec<String>,
    open: Source,
}

#[derive(Debug)]
enum Source {
    Csv(Box<csv_file::Reader>),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet_file::Reader>),
}

/// What is read from either kind of file before its rows.
struct Told {
    head: String,
    tail: String,
    columns: Vec<String>,
}

impl Reader {
    /// Opens a file.
    ///
    /// # Errors
    /// [`Error::Read`]; [`Error::File`] if the file was not written by a [`Writer`].
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
    /// [`Error::Line`] and [`Error::File`] for what is not a row of the file's columns.
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
