//! The provenance of rows: the program and the files that were read.

use std::env::consts::{ARCH, OS};
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::{Error, hex};

/// The program that made something, and the kind of machine it was built for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    /// The version of the program.
    pub version: String,
    /// The commit from which it was built, if `KESTIRIM_COMMIT` was set at that time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The kind of machine: architecture, system, C library.
    pub target: String,
}

impl Program {
    /// This program.
    pub fn this() -> Self {
        let c_library = if cfg!(target_env = "musl") {
            "-musl"
        } else if cfg!(target_env = "gnu") {
            "-gnu"
        } else {
            ""
        };
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: option_env!("KESTIRIM_COMMIT").filter(|it| !it.is_empty()).map(str::to_owned),
            target: format!("{ARCH}-{OS}{c_library}"),
        }
    }

    /// Version and commit, in words.
    pub(crate) fn words(&self) -> String {
        match &self.commit {
            Some(commit) => format!("version {} of commit {commit}", self.version),
            None => format!("version {}", self.version),
        }
    }
}

/// A file that was read, with its hash.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Input {
    /// The path, as the plan names it.
    pub path: String,
    /// The SHA-256 of the file, in hexadecimal.
    pub sha256: String,
}

impl Input {
    /// Hashes the files that exist, on all threads.
    ///
    /// # Errors
    /// [`Error::Read`].
    pub fn all(mut paths: Vec<PathBuf>, folder: &Path) -> Result<Vec<Self>, Error> {
        paths.sort_unstable();
        paths.dedup();
        let files = paths.par_iter().map(|name| (name, folder.join(name)));
        let files = files.filter(|(_, path)| path.is_file());
        files.map(|(name, path)| Self::of(&path, name)).collect()
    }

    /// Hashes a file and lists it under `name`.
    ///
    /// # Errors
    /// [`Error::Read`].
    pub fn of(path: &Path, name: &Path) -> Result<Self, Error> {
        let mut hash = Hash(Sha256::new());
        let copied = File::open(path).and_then(|mut file| io::copy(&mut file, &mut hash));
        copied.map_err(Error::read(path))?;
        Ok(Self { path: name.display().to_string(), sha256: hex(&hash.0.finalize()) })
    }
}

struct Hash(Sha256);

impl io::Write for Hash {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
