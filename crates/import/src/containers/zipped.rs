//! Texts of known names in a zip file.
//!
//! The crate `zip` unpacks them; it reads the directory at the file's end, so a truncated file is refused. Names in
//! folders count as well, except those that macOS adds.

use std::io::{Cursor, Read};

use zip::ZipArchive;

use super::LARGEST;
use crate::error::{Error, listed};

/// A zip file whose texts are unpacked one at a time.
pub(super) struct Zipped<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// The indices of the texts, and their names without folders.
    names: Vec<(usize, String)>,
    /// The number of bytes that may still be unpacked.
    left: u64,
}

/// Whether a file begins as a zip file.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
}

impl<'a> Zipped<'a> {
    /// Opens a zip file.
    ///
    /// # Errors
    /// If it is cut off or damaged.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Error> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| {
            Error::log(format!("expected a whole zip file, found one with {error}"))
        })?;
        let all = archive.file_names_raw().enumerate();
        let names = all.filter_map(|(place, path)| {
            let path = String::from_utf8_lossy(path);
            let name = path.rsplit(['/', '\\']).next().filter(|name| !name.is_empty())?;
            let is_real = !path.starts_with("__MACOSX/") && !name.starts_with("._");
            is_real.then(|| (place, name.to_owned()))
        });
        let names = names.collect();
        Ok(Self { archive, names, left: LARGEST })
    }

    /// The names of the texts in the archive, for error messages.
    pub(super) fn listed(&self) -> String {
        listed(self.names.iter().map(|(_, name)| name.as_str()))
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.names.iter().any(|(_, known)| known == name)
    }

    /// Unpacks a text.
    ///
    /// # Errors
    /// If there is none or more than one of this name, if it is damaged, or if all texts together are too large.
    pub(super) fn unpack(&mut self, name: &str) -> Result<Vec<u8>, Error> {
        let mut places = self.names.iter().filter(|(_, known)| known == name);
        let place = match (places.next(), places.next()) {
            (Some((place, _)), None) => *place,
            (Some(_), Some(_)) => {
                return Err(Error::log(format!(
                    "expected one recording, found several files {name}"
                )));
            }
            (None, _) => {
                let found = self.listed();
                return Err(Error::log(format!("expected {name} in the zip file, found {found}")));
            }
        };
        let damaged = |error: String| {
            Error::log(format!("expected {name} in the zip file whole, found it with {error}"))
        };
        let file = self.archive.by_index(place).map_err(|error| damaged(error.to_string()))?;
        if file.size() > self.left {
            return Err(super::too_large());
        }
        let mut bytes = Vec::new();
        let read = file.take(self.left + 1).read_to_end(&mut bytes);
        let length = read.map_err(|error| damaged(error.to_string()))? as u64;
        self.left = self.left.checked_sub(length).ok_or_else(super::too_large)?;
        Ok(bytes)
    }
}
