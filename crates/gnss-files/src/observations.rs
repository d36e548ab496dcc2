//! Observations: RINEX 2.x, 3.0x and 4.0x.

mod body;
mod header;
mod names;
mod order;
mod record;
mod signals;

use std::path::Path;

use self::body::Body;
use self::header::Header;
pub use self::record::{Epoch, Observations, Observed};
#[cfg(feature = "rtcm")]
pub(crate) use self::signals::channel_scale;
pub(crate) use self::signals::{CHANNELS, Raw};
pub use self::signals::{Carriers, Signal, Signals};
use crate::biases::Biases;
use crate::error::Error;
use crate::streams::Stream;
use crate::text::Text;

impl Observations {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::parse(&Text::read(path)?)
    }

    /// Reads a file and subtracts the biases of satellites from its codes. Satellites whose biases are unknown are
    /// listed in the warnings.
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn read_unbiased(path: impl AsRef<Path>, biases: &Biases) -> Result<Self, Error> {
        Self::parse_unbiased(&Text::read(path)?, biases)
    }

    /// Reads a file in memory.
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse(text: &Text) -> Result<Self, Error> {
        Self::parse_unbiased(text, &Biases::default())
    }

    /// Reads a file in memory, like [`Self::read_unbiased`].
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse_unbiased(text: &Text, biases: &Biases) -> Result<Self, Error> {
        if let Some(stream) = Stream::of(text)? {
            return Self::of_stream(text, stream, biases);
        }
        let mut lines = text.lines();
        let header = Header::parse(text, &mut lines)?;
        let mut body = Body::new(header);
        body.read(text, &mut lines)?;
        Ok(body.finish(text, biases))
    }

    pub(crate) fn of_stream(text: &Text, stream: Stream, biases: &Biases) -> Result<Self, Error> {
        let mut body = Body::default();
        body.take(text, stream)?;
        Ok(body.finish(text, biases))
    }
}

#[cfg(test)]
mod tests;
