use core::fmt;

use crate::{ImuError, RadioError};

/// An error after which the robot needs a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The bus of the radio failed.
    Radio,
    /// The serial port does not accept data.
    Telemetry,
    /// The tracker cannot work with the room's anchors.
    Room(kestirim_uwb_tracker::Error),
}

/// The reason why a step yielded no range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RangeError {
    /// The exchange failed.
    Radio(RadioError),
    /// The timestamps do not yield a distance.
    Exchange(kestirim_uwb_ranging::Error),
    /// The tracker refused the range, and is unchanged.
    Refused(kestirim_uwb_tracker::Error),
}

/// The reason why a step yielded no acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AccelerationError {
    /// The IMU did not deliver it.
    Imu(ImuError),
    /// The tracker refused the acceleration, and is unchanged.
    Refused(kestirim_uwb_tracker::Error),
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Radio => "the bus of the radio failed",
            Self::Telemetry => "telemetry cannot be sent",
            Self::Room(_) => "the tracker cannot work with the room's anchors",
        })
    }
}

impl core::error::Error for Error {}

impl fmt::Display for RangeError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Radio(_) => "the exchange failed",
            Self::Exchange(_) => "the times of the exchange make no distance",
            Self::Refused(_) => "the tracker refused the range",
        })
    }
}

impl core::error::Error for RangeError {}

impl fmt::Display for AccelerationError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Imu(_) => "the inertial sensor did not tell the acceleration",
            Self::Refused(_) => "the tracker refused the acceleration",
        })
    }
}

impl core::error::Error for AccelerationError {}
