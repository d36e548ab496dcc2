use core::fmt;

use crate::{ImuError, RadioError};

/// Why the robot cannot go on: what helps is a reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error {
    /// The bus of the radio failed.
    Radio,
    /// The serial port takes nothing.
    Telemetry,
    /// The room's anchors are not what the tracker can work with.
    Room(kestirim_uwb_tracker::Error),
}

/// Why a step brought no range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RangeError {
    /// The exchange failed.
    Radio(RadioError),
    /// Its times make no distance.
    Exchange(kestirim_uwb_ranging::Error),
    /// The tracker refused it, and is as it was.
    Refused(kestirim_uwb_tracker::Error),
}

/// Why a step brought no acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum AccelerationError {
    /// The IMU did not tell it.
    Imu(ImuError),
    /// The tracker refused it, and is as it was.
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
