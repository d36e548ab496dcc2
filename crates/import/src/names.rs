//! What a column's name says: which of time, accelerometer and gyroscope it is, which axis, which unit.
//!
//! Upper and lower case are the same, except that a lone `T` may be a temperature. A unit stands in brackets or behind the
//! name: `ax [g]`, `gyro_x(deg/s)`, `acc_x_mss`, `time_ms`. Words such as `imu` and `raw` around a name are ignored.
//! The axis stands behind the sensor or before it: `AccX`, `accel.x`, `x_gyro`, `Accelerometer X`.
//!
//! | | names |
//! |---|---|
//! | time | `t`, `time`, `timestamp`, `timestamps`, `ts`, `times`, `elapsed`, `elapsed_time`, `time_elapsed`, `sample_time`, `sensor_time`, `system_time`, `log_time`, `clock`, `datetime`, `date_time`, `utc`, `utc_time`, `rtc_time`, `zaman`, `zeit`, `temps`, `tiempo` |
//! | time with its unit | `seconds_elapsed`, `seconds`, `secs`, `sec`; `millis`, `milliseconds`, `msec`, `ms`; `micros`, `microseconds`, `usec`, `us`; `nanos`, `nanoseconds`, `nsec`, `ns` |
//! | accelerometer | `a`, `ac`, `acc`, `accel`, `accelerometer`, `acceleration`, `f`, `specific_force`, `linear_acceleration`, `total_acceleration` |
//! | gyroscope | `g`, `gy`, `gyr`, `gyro`, `gyroscope`, `w`, `omega`, `angular_rate`, `angular_velocity`, `ang_vel`, `rotation_rate`, `turn_rate` |

use crate::unit::{Quantity, Unit};

const TIMES: [&str; 23] = [
    "t",
    "time",
    "timestamp",
    "timestamps",
    "ts",
    "times",
    "elapsed",
    "elapsedtime",
    "timeelapsed",
    "sampletime",
    "sensortime",
    "systemtime",
    "logtime",
    "clock",
    "datetime",
    "utc",
    "utctime",
    "rtctime",
    "zaman",
    "zeit",
    "temps",
    "tiempo",
    "unixtime",
];
/// Names of time columns that are the unit itself.
const TIMES_IN: [(&str, &str); 16] = [
    ("secondselapsed", "s"),
    ("seconds", "s"),
    ("secs", "s"),
    ("sec", "s"),
    ("millis", "ms"),
    ("milliseconds", "ms"),
    ("msec", "ms"),
    ("micros", "us"),
    ("microseconds", "us"),
    ("usec", "us"),
    ("nanos", "ns"),
    ("nanoseconds", "ns"),
    ("nsec", "ns"),
    ("ms", "ms"),
    ("us", "us"),
    ("ns", "ns"),
];
const ACCELEROMETERS: [&str; 10] = [
    "a",
    "ac",
    "acc",
    "accel",
    "accelerometer",
    "acceleration",
    "f",
    "specificforce",
    "linearacceleration",
    "totalacceleration",
];
const GYROSCOPES: [&str; 12] = [
    "g",
    "gy",
    "gyr",
    "gyro",
    "gyroscope",
    "w",
    "omega",
    "angularrate",
    "angularvelocity",
    "angvel",
    "rotationrate",
    "turnrate",
];
/// Words that say nothing about what a column holds.
const FILLERS: [&str; 7] = ["imu", "raw", "cal", "calibrated", "sensor", "axis", "data"];

/// The meaning of a column's name.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Meaning {
    pub(crate) quantity: Quantity,
    /// 0, 1 and 2 for x, y and z; 0 for time.
    pub(crate) axis: usize,
    /// The index of the sensor's name among the known ones: the columns of one sensor share it.
    pub(crate) alias: usize,
    pub(crate) unit: Option<Unit>,
}

/// The meaning of a column's name, if it is a known one.
pub(crate) fn meaning(name: &str) -> Option<Meaning> {
    let (base, bracket) = split_unit(name);
    if base == "T" {
        return None;
    }
    // `gyr_x_°/s`: a unit with characters other than letters.
    if let Some((base, unit)) = base.rsplit_once(['_', ' ']).filter(|_| bracket.is_none())
        && let Some(mut meaning) = plain_meaning(&words(base).concat())
        && let Some(unit) = Unit::read(meaning.quantity, unit)
    {
        meaning.unit = Some(unit);
        return Some(meaning);
    }
    let words: Vec<_> =
        words(base).into_iter().filter(|w| !FILLERS.contains(&w.as_str())).collect();
    // Take the shortest possible unit at the end of the name.
    (1..=words.len()).rev().find_map(|end| {
        let mut meaning = plain_meaning(&words[..end].concat())?;
        if end < words.len() {
            meaning.unit = Some(Unit::read(meaning.quantity, &words[end..].concat())?);
        }
        if let Some(unit) = bracket.and_then(|text| Unit::read(meaning.quantity, text)) {
            meaning.unit = Some(unit);
        }
        Some(meaning)
    })
}

/// A column name that matches the wanted one, with the unit that it contains.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Named {
    pub(crate) unit: Option<Unit>,
}

/// Matches a name against aliases, with a unit of the quantity behind it or in brackets.
pub(crate) fn named(name: &str, quantity: Option<Quantity>, aliases: &[&str]) -> Option<Named> {
    let (base, bracket) = split_unit(name);
    let is_one = |text: &str| aliases.contains(&text);
    let unit = |text: &str| quantity.and_then(|quantity| Unit::read(quantity, text));
    // `speed_cm/s`: a unit with characters other than letters.
    if let Some((base, text)) = base.rsplit_once(['_', ' '])
        && let (true, Some(unit)) = (is_one(&words(base).concat()), unit(text))
    {
        return Some(Named { unit: Some(unit) });
    }
    let words = words(base);
    (1..=words.len()).rev().find_map(|end| {
        if !is_one(&words[..end].concat()) {
            return None;
        }
        let behind = if end < words.len() { Some(unit(&words[end..].concat())?) } else { None };
        // The brackets may contain something other than a unit.
        Some(Named { unit: bracket.and_then(unit).or(behind) })
    })
}

/// Splits a name into the part before the brackets and the brackets themselves.
pub(crate) fn split_unit(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    let open = name.find(['[', '(', '{']).filter(|&at| at > 0);
    match open {
        Some(at) => (name[..at].trim(), Some(&name[at..])),
        None => (name, None),
    }
}

/// The words of a name in lower case: `AccX_raw` has three.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut was_lower = false;
    for letter in name.chars() {
        if !letter.is_alphanumeric() || letter.is_uppercase() && was_lower {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut()
            && letter.is_alphanumeric()
        {
            word.extend(letter.to_lowercase());
        }
        was_lower = letter.is_lowercase();
    }
    words.into_iter().filter(|word| !word.is_empty()).collect()
}

fn plain_meaning(name: &str) -> Option<Meaning> {
    if let Some(alias) = TIMES.iter().position(|&time| time == name) {
        return Some(Meaning { quantity: Quantity::Time, axis: 0, alias, unit: None });
    }
    if let Some(place) = TIMES_IN.iter().position(|(time, _)| *time == name) {
        let unit = Unit::read(Quantity::Time, TIMES_IN[place].1);
        let alias = TIMES.len() + place;
        return Some(Meaning { quantity: Quantity::Time, axis: 0, alias, unit });
    }
    let axis_of = |letter: char| "xyz".find(letter);
    let behind = name.char_indices().last();
    let behind = behind.and_then(|(at, letter)| Some((&name[..at], axis_of(letter)?)));
    let before = name.chars().next();
    // A short sensor name precedes its axis: `ya` is not an accelerometer.
    let before = before.and_then(|letter| Some((&name[letter.len_utf8()..], axis_of(letter)?)));
    let before = before.filter(|(sensor, _)| sensor.len() > 2);
    for (sensor, axis) in behind.into_iter().chain(before) {
        for (quantity, aliases) in
            [(Quantity::Acceleration, &ACCELEROMETERS[..]), (Quantity::Rate, &GYROSCOPES[..])]
        {
            if let Some(alias) = aliases.iter().position(|&alias| alias == sensor) {
                return Some(Meaning { quantity, axis, alias, unit: None });
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_people_write_them() {
        for (name, quantity, axis, unit) in [
            ("t", Quantity::Time, 0, None),
            ("Time (s)", Quantity::Time, 0, Some("s")),
            ("time_ms", Quantity::Time, 0, Some("ms")),
            ("TimeUS", Quantity::Time, 0, Some("µs")),
            ("timestamp [us]", Quantity::Time, 0, Some("µs")),
            ("times", Quantity::Time, 0, None),
            ("ms", Quantity::Time, 0, Some("ms")),
            ("seconds_elapsed", Quantity::Time, 0, Some("s")),
            ("ax [g]", Quantity::Acceleration, 0, Some("g")),
            ("aY", Quantity::Acceleration, 1, None),
            ("acc_x_mss", Quantity::Acceleration, 0, Some("m/s²")),
            ("AccX[g]", Quantity::Acceleration, 0, Some("g")),
            ("Accelerometer X", Quantity::Acceleration, 0, None),
            ("accel.z (m/s^2)", Quantity::Acceleration, 2, Some("m/s²")),
            ("x_acc", Quantity::Acceleration, 0, None),
            ("imu_raw_acc_z", Quantity::Acceleration, 2, None),
            ("linear_acceleration.x", Quantity::Acceleration, 0, None),
            ("gx", Quantity::Rate, 0, None),
            ("gyro_x(deg/s)", Quantity::Rate, 0, Some("°/s")),
            ("GyrX[dps]", Quantity::Rate, 0, Some("°/s")),
            ("gy_dps", Quantity::Rate, 1, Some("°/s")),
            ("gyr_x_°/s", Quantity::Rate, 0, Some("°/s")),
            ("gyy", Quantity::Rate, 1, None),
            ("wz_rad_s", Quantity::Rate, 2, Some("rad/s")),
            ("Gyroscope Y-axis (°/s)", Quantity::Rate, 1, Some("°/s")),
        ] {
            let meaning = meaning(name).unwrap_or_else(|| panic!("{name}"));
            let found = meaning.unit.map(|unit| unit.name);
            assert_eq!((meaning.quantity, meaning.axis), (quantity, axis), "{name}");
            assert_eq!(found.as_deref(), unit, "{name}");
        }
        for name in
            ["T", "", "gt_x", "mx", "x", "note", "FreeAcc_X", "height", "axle", "index", "ax1"]
        {
            assert_eq!(meaning(name), None, "{name}");
        }
    }
}
