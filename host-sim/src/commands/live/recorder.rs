//! Records what arrives, before anything processes it.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::Error;

/// The folder of recordings for which no file is given.
const FOLDER: &str = "target/live";
/// The maximum number of recordings begun in the same second that are given distinct names.
const MOST_A_SECOND: u32 = 100;

/// A new file that is appended to. The bytes are handed to the operating system at once, so that they survive the end
/// of this program.
#[derive(Debug)]
pub(super) struct Recorder {
    path: PathBuf,
    file: File,
}

impl Recorder {
    /// Creates a recording at this path, or at one made from date and time.
    pub(super) fn create(path: Option<&Path>) -> Result<Self, Error> {
        match path {
            Some(path) => {
                Self::new(path).map_err(|source| Error::Write { path: path.into(), source })
            }
            None => Self::named_by_time(),
        }
    }

    fn new(path: &Path) -> io::Result<Self> {
        let file = File::create_new(path).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists => io::Error::new(
                ErrorKind::AlreadyExists,
                "it exists, and no recording is ever overwritten",
            ),
            _ => error,
        })?;
        Ok(Self { path: path.to_path_buf(), file })
    }

    fn named_by_time() -> Result<Self, Error> {
        let folder = Path::new(FOLDER);
        let failed = |path: &Path, source| Error::Write { path: path.to_path_buf(), source };
        fs::create_dir_all(folder).map_err(|source| failed(folder, source))?;
        // Colons are not allowed in file names everywhere.
        let now =
            humantime::format_rfc3339_seconds(SystemTime::now()).to_string().replace(':', "-");
        let mut number = 1;
        loop {
            let more = if number == 1 { String::new() } else { format!("-{number}") };
            let path = folder.join(format!("{now}{more}.frames"));
            match Self::new(&path) {
                Err(error)
                    if error.kind() == ErrorKind::AlreadyExists && number < MOST_A_SECOND =>
                {
                    number += 1;
                }
                made => return made.map_err(|source| failed(&path, source)),
            }
        }
    }

    /// The path of the file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// A handle to the file, for syncing it to the disk.
    pub(super) fn file(&self) -> Result<File, Error> {
        self.file.try_clone().map_err(|source| self.failed(source))
    }

    /// Appends received bytes.
    pub(super) fn append(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.file.write_all(bytes).map_err(|source| self.failed(source))
    }

    fn failed(&self, source: io::Error) -> Error {
        Error::Write { path: self.path.clone(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_in_the_file_at_once_and_no_file_is_overwritten() -> Result<(), Error> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.frames");
        let mut recorder = Recorder::create(Some(&path))?;
        recorder.append(b"abc")?;
        assert_eq!(fs::read(&path).unwrap(), b"abc");
        let refused = Recorder::create(Some(&path)).unwrap_err().to_string();
        assert!(refused.contains("ever overwritten"), "{refused}");
        recorder.append(b"def")?;
        assert_eq!(fs::read(&path).unwrap(), b"abcdef");
        Ok(())
    }
}
