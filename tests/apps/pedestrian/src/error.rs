use core::fmt;

/// A failure of a part of the hardware: `S` is the bus' error, `F` the file's, `P` the serial port's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error<S, F, P> {
    /// The sensor cannot be read, or is not the expected one.
    Sensor(S),
    /// The log was not written.
    Log(F),
    /// The telemetry was not sent.
    Port(P),
}

impl<S, F, P> fmt::Display for Error<S, F, P> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Sensor(_) => "the sensor cannot be read",
            Self::Log(_) => "the log cannot be written",
            Self::Port(_) => "telemetry cannot be sent",
        })
    }
}

impl<S: fmt::Debug, F: fmt::Debug, P: fmt::Debug> core::error::Error for Error<S, F, P> {}
