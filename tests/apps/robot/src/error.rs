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
pub enum AccelerationError {
    /// The IMU did not tell it.
    Imu(ImuError),
    /// The tracker refused it, and is as it was.
    Refused(kestirim_uwb_tracker::Error),
}
