//! Logs of devices and programs that are known by name: the meaning of their columns is documented, so it need not be
//! inferred from the data.

mod openlog_artemis;
mod openshoe;
mod razor;
mod xio;
mod xsens;

use std::fmt;
use std::str::FromStr;

use crate::containers;
use crate::error::{Error, quoted};
use crate::table::Table;

/// A device or program that writes logs in a known format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Text of the 9DoF Razor and its descendants: time in ms, 3 accelerations in g, 3 rates in °/s, separated by
    /// blanks.
    Razor,
    /// CSV of x-io's NGIMU and x-IMU3.
    Xio,
    /// Export of Xsens MT Manager.
    Xsens,
    /// CSV of `SparkFun`'s `OpenLog` Artemis.
    OpenLogArtemis,
    /// Log of `ArduPilot`, binary or as text.
    ArduPilot,
    /// `ULog` of PX4.
    Px4,
    /// Bag of ROS 1.
    Ros1,
    /// MCAP with messages of ROS 1 or ROS 2.
    Mcap,
    /// Zip file that phyphox exports.
    Phyphox,
    /// Zip file that Sensor Logger exports.
    SensorLogger,
    /// Text of `OpenShoe`'s first prototype.
    OpenShoe,
    /// Text of `OpenShoe`'s module, with numbered samples instead of times.
    OpenShoeCounted,
    /// Packets of `OpenShoe`'s module.
    OpenShoeMimu,
}

/// The description of a format.
#[derive(Debug)]
pub(crate) struct Description {
    pub(crate) format: Format,
    /// The name as the option `--format` takes it.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// Whether a table of text is of this format; `None` if the format is recognised by a file's first bytes, not by
    /// its columns.
    pub(crate) is_it: Option<fn(&Table) -> bool>,
    /// The names of the columns of t, ax, ay, az, gx, gy, gz, or their numbers, from 1, if there is no header. Of
    /// several names of time the first that is present is taken.
    pub(crate) time: &'static [(&'static str, &'static str)],
    pub(crate) sensors: [&'static str; 6],
    pub(crate) acceleration: &'static str,
    pub(crate) rate: &'static str,
    /// Whether the data may overrule the format, because it is recognised by the shape of the table alone.
    pub(crate) is_a_guess: bool,
}

/// All formats; the last one is recognised by its shape alone.
const ALL: [&Description; 13] = [
    &xio::XIO,
    &xsens::XSENS,
    &openlog_artemis::OPENLOG_ARTEMIS,
    &containers::ARDUPILOT,
    &containers::PX4,
    &containers::ROS1,
    &containers::MCAP,
    &containers::PHYPHOX,
    &containers::SENSOR_LOGGER,
    &openshoe::OPENSHOE,
    &openshoe::OPENSHOE_COUNTED,
    &containers::MIMU,
    &razor::RAZOR,
];

impl Format {
    /// The name as the option `--format` takes it.
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// The names of all formats, as the option `--format` takes them.
    pub fn names() -> impl Iterator<Item = &'static str> {
        ALL.iter().map(|known| known.name)
    }

    /// The format of a table, if it is recognised.
    pub fn of(table: &Table) -> Option<Self> {
        let is_it = |known: &&&Description| known.is_it.is_some_and(|is_it| is_it(table));
        ALL.iter().find(is_it).map(|known| known.format)
    }

    /// Whether the format is recognised by a file's first bytes, not by the columns of a table of text.
    pub(crate) fn is_container(self) -> bool {
        self.description().is_it.is_none()
    }

    pub(crate) fn description(self) -> &'static Description {
        match self {
            Self::Razor => &razor::RAZOR,
            Self::Xio => &xio::XIO,
            Self::Xsens => &xsens::XSENS,
            Self::OpenLogArtemis => &openlog_artemis::OPENLOG_ARTEMIS,
            Self::ArduPilot => &containers::ARDUPILOT,
            Self::Px4 => &containers::PX4,
            Self::Ros1 => &containers::ROS1,
            Self::Mcap => &containers::MCAP,
            Self::Phyphox => &containers::PHYPHOX,
            Self::SensorLogger => &containers::SENSOR_LOGGER,
            Self::OpenShoe => &openshoe::OPENSHOE,
            Self::OpenShoeCounted => &openshoe::OPENSHOE_COUNTED,
            Self::OpenShoeMimu => &containers::MIMU,
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.description().title)
    }
}

impl FromStr for Format {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let known = ALL.iter().find(|known| known.name == text.trim().to_lowercase());
        known.map(|known| known.format).ok_or_else(|| {
            let names: Vec<_> = ALL.iter().map(|known| known.name).collect();
            Error::options(format!("expected one of {}, found {}", names.join(", "), quoted(text)))
        })
    }
}

/// Whether the header of a table contains all these names.
fn has(table: &Table, names: &[&str]) -> bool {
    table.header.is_some()
        && names.iter().all(|name| table.columns.iter().any(|column| column.name == *name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_to_formats_and_back() {
        for known in ALL {
            assert_eq!(known.format.name().parse(), Ok(known.format));
        }
        let error = "x".parse::<Format>().unwrap_err().to_string();
        assert!(error.starts_with("expected one of x-io, xsens"), "{error}");
    }
}
