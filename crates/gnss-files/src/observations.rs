//! Observations: RINEX 2.x, 3.0x and 4.0x.

mod body;
mod header;
mod record;
mod signals;

use std::path::Path;

use self::body::Body;
use self::header::Header;
pub use self::record::{Epoch, Observations, Observed};
pub use self::signals::{Carriers, Signal, Signals};
use crate::error::Error;
use crate::text::Text;

impl Observations {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::parse(&Text::read(path)?)
    }

    /// Reads a file in memory.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &Text) -> Result<Self, Error> {
        let mut lines = text.lines();
        let header = Header::parse(text, &mut lines)?;
        let mut body = Body::new(header);
        body.read(text, &mut lines)?;
        Ok(body.finish(text))
    }
}

#[cfg(test)]
mod tests;
