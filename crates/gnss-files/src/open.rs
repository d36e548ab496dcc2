//! Opening and unpacking of files.

use std::path::Path;

use crate::error::Error;
use crate::text::{Text, without_mark};
use crate::{crinex, gzip};

impl Text {
    /// Reads a file and unpacks it as [`Self::unpack`] does.
    ///
    /// # Errors
    /// [`Error::Read`] if the file cannot be read; otherwise those of [`Self::unpack`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        Self::unpack(path, gzip::read(path)?)
    }

    /// Unpacks the contents of a file, named `path` in errors and warnings: plain text, gzip, Compact RINEX, or Compact
    /// RINEX in gzip.
    ///
    /// # Errors
    /// [`Error::File`] if the contents are packed in another way, damaged, or larger than 1 GiB; [`Error::Line`] if
    /// a line of Compact RINEX is damaged.
    pub fn unpack(path: impl AsRef<Path>, bytes: Vec<u8>) -> Result<Self, Error> {
        let path = path.as_ref();
        let mut bytes = gzip::unpack(path, bytes)?;
        bytes.drain(..bytes.len() - without_mark(&bytes).len());
        let text = Self::new(path, bytes);
        if crinex::is_compressed(text.bytes()) {
            let bytes = crinex::decompress(&text, gzip::LARGEST)?;
            return Ok(Self::new(path, bytes));
        }
        Ok(text)
    }
}
