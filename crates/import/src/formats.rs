//! Logs of devices and programs that are known by name: what their columns hold is written down somewhere, so it need not
//! be found in the data.

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

/// A device or program that writes logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// Text of the 9DoF Razor and its descendants: blanks between ms, 3 × g, 3 × °/s.
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
    /// Text of `OpenShoe`'s module, whose samples are only counted.
    OpenShoeCounted,
    /// Packets of `OpenShoe`'s module.
    OpenShoeMimu,
}

/// What is known of a format.
#[derive(Debug)]
pub(crate) struct Description {
    pub(crate) format: Format,
    /// As in the option.
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    /// Whether a table of text is of this format; none if the first bytes of a file tell, and not its columns.
    pub(crate) is_it: Option<fn(&Table) -> bool>,
    /// Names, or numbers without a header, of t, ax, ay, az, gx, gy, gz; the first of several names of time that is there.
    pub(crate) time: &'static [(&'static str, &'static str)],
    pub(crate) sensors: [&'static str; 6],
    pub(crate) acceleration: &'static str,
    pub(crate) rate: &'static str,
    /// Whether the data may tell otherwise, as nothing but the shape of the table shows the format.
    pub(crate) is_a_guess: bool,
}

/// The shape alone shows the last one.
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
    /// The name in the option `--format`.
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// The names of all formats, as in the option `--format`.
    pub fn names() -> impl Iterator<Item = &'static str> {
        ALL.iter().map(|known| known.name)
    }

    /// The format of a table, if it is one of these.
    pub fn of(table: &Table) -> Option<Self> {
        let is_it = |known: &&&Description| known.is_it.is_some_and(|is_it| is_it(table));
        ALL.iter().find(is_it).map(|known| known.format)
    }

    /// Whether a file's first bytes tell this format, and not the columns of a table of text.
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

/// Whether a table has a header with these names.
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
