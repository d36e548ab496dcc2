//! CSV of `SparkFun`'s `OpenLog` Artemis with its ICM-20948 (`Sensors.ino` and `SENSOR_UNITS.md` of
//! `github.com/sparkfun/OpenLog_Artemis`: `aX,aY,aZ` in milli g, `gX,gY,gZ` in °/s), after `rtcDate,rtcTime` or, if so set, `micros`.

use super::{Description, Format, has};
use crate::table::Table;

const SENSORS: [&str; 6] = ["aX", "aY", "aZ", "gX", "gY", "gZ"];

pub(super) const OPENLOG_ARTEMIS: Description = Description {
    format: Format::OpenLogArtemis,
    name: "openlog-artemis",
    title: "OpenLog Artemis CSV",
    is_it: Some(is_it),
    time: &[("micros", "us"), ("rtcTime", "us")],
    sensors: SENSORS,
    acceleration: "mg",
    rate: "deg/s",
    is_a_guess: false,
};

fn is_it(table: &Table) -> bool {
    has(table, &SENSORS) && has(table, &["imu_degC"])
}
