//! CSV of x-io's devices: `sensors.csv` of the NGIMU (NGIMU User Manual v1.6, section on the SD card file converter: `Time
//! (s)`, `Gyroscope X (deg/s)`, `Accelerometer X (g)`, …) and `Inertial.csv` of the x-IMU3 (x-IMU3 GUI: `Timestamp (us)`, the
//! same names). Both give specific force: +1 g upwards at rest.

use super::{Description, Format, has};
use crate::table::Table;

const SENSORS: [&str; 6] = [
    "Accelerometer X (g)",
    "Accelerometer Y (g)",
    "Accelerometer Z (g)",
    "Gyroscope X (deg/s)",
    "Gyroscope Y (deg/s)",
    "Gyroscope Z (deg/s)",
];

pub(super) const XIO: Description = Description {
    format: Format::Xio,
    name: "x-io",
    title: "x-io CSV",
    is_it: Some(is_it),
    time: &[("Time (s)", "s"), ("Timestamp (us)", "us")],
    sensors: SENSORS,
    acceleration: "g",
    rate: "deg/s",
    is_a_guess: false,
};

fn is_it(table: &Table) -> bool {
    has(table, &SENSORS) && (has(table, &["Time (s)"]) || has(table, &["Timestamp (us)"]))
}
