use core::fmt;

/// Reason for which a frame was not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The buffer is shorter than the frame; [`crate::CAPACITY`] bytes are always enough.
    BufferTooShort,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::BufferTooShort => "the buffer is shorter than the frame",
        })
    }
}

impl core::error::Error for Error {}
