use core::fmt;

use crate::SensorError;

/// A failure of a part of the hardware: `B` is the error of the inertial sensor's bus, `P` the serial port's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error<B, P> {
    /// A sensor cannot be read, or is not the expected one.
    Sensor(SensorError<B>),
    /// The observer refused its gains.
    Observer(kestirim_luenberger::Error),
    /// The telemetry was not sent.
    Port(P),
}

impl<B, P> fmt::Display for Error<B, P> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Sensor(_) => "a sensor cannot be read",
            Self::Observer(_) => "the observer does not take its gains",
            Self::Port(_) => "telemetry cannot be sent",
        })
    }
}

impl<B: fmt::Debug, P: fmt::Debug> core::error::Error for Error<B, P> {}
