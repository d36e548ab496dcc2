//! A receiver's stream, read in one pass.

use crate::biases::Biases;
use crate::error::Error;
use crate::navigation::Navigation;
use crate::observations::Observations;
use crate::streams::Stream;
use crate::text::Text;

/// The contents of a receiver's stream in RTCM 3 or UBX.
#[derive(Debug)]
pub struct Received {
    /// The observations.
    pub observations: Observations,
    /// The data that the satellites broadcast; may be empty.
    pub navigation: Navigation,
}

impl Received {
    /// Reads a stream in memory, and subtracts the biases of satellites from its codes, like
    /// [`Observations::read_unbiased`].
    ///
    /// # Errors
    /// [`Error::File`] if the text is no stream, or a stream without observations.
    pub fn parse(text: &Text, biases: &Biases) -> Result<Self, Error> {
        let wrong = || text.wrong_kind("the stream of a receiver (UBX or RTCM 3)");
        let mut stream = Stream::of(text)?.ok_or_else(wrong)?;
        let broadcast = stream.take_broadcast();
        Ok(Self {
            observations: Observations::of_stream(text, stream, biases)?,
            navigation: Navigation::of_stream(text, broadcast),
        })
    }
}
