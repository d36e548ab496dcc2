//! Zip files of CSV that phyphox exports (RWTH Aachen, <https://phyphox.org>), with any of its separators and decimal
//! signs.
//!
//! Each data set of an experiment is a file. Experiments with several sensors write `Accelerometer.csv`,
//! `Gyroscope.csv` and `Linear Accelerometer.csv` (older ones `Linear Acceleration.csv`), whose columns are `Time (s)`
//! and `Acceleration x (m/s^2)` or `X (m/s^2)`, and `Gyroscope x (rad/s)` or `X (rad/s)`; a linear acceleration
//! excludes gravity. Both Android and iOS give +1 g upwards at rest: on iOS `ExperimentSensorInput.swift` of
//! `github.com/phyphox/phyphox-ios` multiplies by −9.81.

use super::Decoded;
use super::join::join;
use super::member;
use super::zipped::Zipped;
use crate::damage::Damage;
use crate::error::Error;
use crate::formats::{Description, Format};
use crate::unit::Quantity;

pub(crate) const PHYPHOX: Description = Description {
    format: Format::Phyphox,
    name: "phyphox",
    title: "phyphox",
    is_it: None,
    time: &[(TIME, "s")],
    sensors: [
        "Accelerometer x",
        "Accelerometer y",
        "Accelerometer z",
        "Gyroscope x",
        "Gyroscope y",
        "Gyroscope z",
    ],
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

pub(super) const TIME: &str = "Time (s)";
const ACCELEROMETER: &str = "Accelerometer.csv";
pub(super) const GYROSCOPE: &str = "Gyroscope.csv";

/// Reads the accelerometer in addition to the gyroscope's text.
///
/// # Errors
/// If the accelerometer with gravity is missing, or a text is not of the format.
pub(super) fn read(zipped: &mut Zipped<'_>, gyroscope: &[u8]) -> Result<Decoded, Error> {
    if !zipped.has(ACCELEROMETER) {
        return Err(Error::log(format!(
            "expected {ACCELEROMETER}, with gravity, beside {GYROSCOPE}, found {}",
            zipped.listed()
        )));
    }
    let accelerometer = zipped.unpack(ACCELEROMETER)?;
    let (rates, rate_damage) = member::read(gyroscope, GYROSCOPE, TIME, Quantity::Rate)?;
    let (forces, force_damage) =
        member::read(&accelerometer, ACCELEROMETER, TIME, Quantity::Acceleration)?;
    let (joined, note) = join(&rates, &forces, 1.0)?;
    let damage = Damage::joined([rate_damage, force_damage]);
    Ok(Decoded { table: joined.named(&PHYPHOX, TIME, damage), notes: vec![note] })
}
