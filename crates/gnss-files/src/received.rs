//! A receiver's stream that is read once.

use crate::biases::Biases;
use crate::error::Error;
use crate::navigation::Navigation;
use crate::observations::Observations;
use crate::streams::Stream;
use crate::text::Text;

/// What a receiver's stream holds, RTCM 3 or UBX.
#[derive(Debug)]
pub struct Received {
    /// What was observed.
    pub observations: Observations,
    /// What the satellites broadcast; perhaps nothing.
    pub navigation: Navigation,
}

impl Received {
    /// Reads a stream in memory, and takes the biases of satellites off its codes, as [`Observations::read_unbiased`].
    ///
    /// # Errors
    /// [`Error::File`] if it is no stream, or one without observations.
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
