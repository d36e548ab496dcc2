//! Zip files exported by telephones, with one text for each sensor: identifies the program that wrote them.

use super::zipped::Zipped;
use super::{Decoded, phyphox, refuse_topic, sensor_logger};
use crate::error::{Error, quoted};
use crate::formats::Format;
use crate::options::Options;
use crate::text::{Text, letters};

/// The names of a gyroscope's text, the preferred one first.
const GYROSCOPES: [&str; 2] = [phyphox::GYROSCOPE, "GyroscopeUncalibrated.csv"];

/// An export of a telephone.
pub(super) struct Phone<'a> {
    zipped: Zipped<'a>,
    gyroscope: Vec<u8>,
    /// The name of the gyroscope's text.
    name: &'static str,
    format: Format,
}

impl<'a> Phone<'a> {
    /// Opens a zip file.
    ///
    /// # Errors
    /// If it holds no gyroscope, or was written by an unknown program.
    pub(super) fn open(bytes: &'a [u8], options: &Options) -> Result<Self, Error> {
        refuse_topic(options, "a zip file of texts")?;
        let mut zipped = Zipped::open(bytes)?;
        let Some(name) = GYROSCOPES.into_iter().find(|name| zipped.has(name)) else {
            let found = zipped.listed();
            return Err(Error::log(format!(
                "expected Gyroscope.csv in the zip file, as phyphox and Sensor Logger name it, found {found}"
            )));
        };
        let gyroscope = zipped.unpack(name)?;
        let text = Text::new(&gyroscope)?;
        let header = letters(text.lines().next().map_or(b"", |line| line.bytes));
        let format = if header.contains(sensor_logger::ELAPSED) {
            Format::SensorLogger
        } else if header.contains(phyphox::TIME) {
            Format::Phyphox
        } else {
            let problem = "expected a column seconds_elapsed (Sensor Logger) or Time (s) (phyphox)";
            return Err(Error::log(format!("{problem} in {name}, found {}", quoted(&header))));
        };
        Ok(Self { zipped, gyroscope, name, format })
    }

    pub(super) fn format(&self) -> Format {
        self.format
    }

    /// Reads the sensors.
    ///
    /// # Errors
    /// If one is missing, or a text is not of the format.
    pub(super) fn read(&mut self, options: &Options) -> Result<Decoded, Error> {
        let Self { zipped, gyroscope, name, format } = self;
        match format {
            Format::SensorLogger => sensor_logger::read(zipped, gyroscope, name, options),
            _ => phyphox::read(zipped, gyroscope),
        }
    }
}
