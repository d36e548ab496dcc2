//! Antenna phase centres: ANTEX 1.3 and 1.4.

use std::path::Path;

use memchr::memmem::Finder;

use crate::antenna_model::AntennaModel;
use crate::error::{Error, Warning};
use crate::observations::Carriers;
use crate::system::{System, satellite};
use crate::text::{Line, Lines, Text};
use crate::time::GpsTime;

/// Upper limit on the steps of a grid, beyond that of any calibration.
const MOST_ANGLES: f64 = 400.0;

/// The phase centre of an antenna on one frequency: an offset, and a table of variations.
///
/// The table has one row of zenith angles (receivers) or nadir angles (satellites) without azimuth and, if the
/// calibration covers azimuth, one such row for each azimuth.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PhaseCentre {
    /// The mean phase centre, m: for a receiver north, east and up of the antenna's reference point; for a satellite
    /// along X, Y and Z of its body from the centre of mass.
    pub offset: [f64; 3],
    /// The first angle of a row, degrees (`ZEN1`).
    pub first: f64,
    /// The step between the angles of a row, degrees (`DZEN`).
    pub step: f64,
    /// The azimuth-independent variations, m (`NOAZI`).
    pub mean: Vec<f64>,
    /// The step between the azimuths, degrees (`DAZI`); zero if the table has none.
    pub azimuth_step: f64,
    /// The rows for the azimuths from 0° to 360° one after the other, each as long as `mean`, m; empty if there are
    /// none.
    pub by_azimuth: Vec<f64>,
}

/// An antenna.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Antenna {
    /// The antenna type, with the radome in the case of a receiver, as in the file.
    pub name: String,
    /// The satellite's permanent number (SVN), for example `E210`; empty for a receiver.
    pub code: String,
    /// The edition to which the antenna belongs, if the file tells it (`SINEX CODE`).
    pub model: Option<AntennaModel>,
    /// The phase centres by system and band (the digit of RINEX 3).
    centres: Vec<((System, u8), PhaseCentre)>,
    /// The first instant at which a satellite uses this antenna; `None` if it always has.
    pub valid_from: Option<GpsTime>,
    /// The last instant at which a satellite uses this antenna; `None` if it still does.
    pub valid_until: Option<GpsTime>,
}

impl Antenna {
    fn is_valid(&self, time: GpsTime) -> bool {
        self.valid_from.is_none_or(|from| from <= time)
            && self.valid_until.is_none_or(|until| time <= until)
    }

    /// The antenna as another edition has it, where that is known.
    ///
    /// An antenna of that edition, or of no named edition, is returned as it is. Between `igs14` and `igs20` only the
    /// antennas of Galileo are known: the header of `igs20.atx` tells by how much it moved them.
    pub fn in_model(&self, model: AntennaModel) -> Option<Self> {
        let moved = match (self.model, model) {
            (None, _) => return Some(self.clone()),
            (Some(own), _) if own == model => return Some(self.clone()),
            (Some(AntennaModel::Igs14), AntennaModel::Igs20) => 1.0,
            (Some(AntennaModel::Igs20), AntennaModel::Igs14) => -1.0,
            _ => return None,
        };
        let moved = moved * AntennaModel::moved_by_igs20(&self.name, &self.code)?;
        let mut other = Self { model: Some(model), ..self.clone() };
        for (_, centre) in &mut other.centres {
            centre.offset[2] += moved;
        }
        Some(other)
    }

    /// The phase centres on two carriers, if the file has both.
    pub fn on(&self, carriers: Carriers) -> Option<[&PhaseCentre; 2]> {
        let [first, second] = carriers.bands();
        let centre = |band| {
            let wanted = (carriers.system(), band);
            self.centres.iter().find(|(on, _)| *on == wanted).map(|(_, centre)| centre)
        };
        Some([centre(first)?, centre(second)?])
    }
}

/// Antennas of satellites and of one receiver.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Antennas {
    satellites: Vec<(u8, Antenna)>,
    /// The receiver's antenna, or else the same type without a radome.
    pub receiver: Option<Antenna>,
    /// Warnings about the file.
    pub warnings: Vec<Warning>,
}

impl Antennas {
    /// Reads files for a receiver whose antenna type and radome are given as in a RINEX header
    /// ([`Observations::antenna`](crate::Observations::antenna)).
    ///
    /// If two files hold the same antenna, the later file takes precedence.
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(paths: &[impl AsRef<Path>], receiver: &str) -> Result<Self, Error> {
        let texts: Result<Vec<_>, _> = paths.iter().map(Text::read).collect();
        Self::parse(&texts?, receiver)
    }

    /// Reads files in memory, like [`Self::read`].
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse(texts: &[Text], receiver: &str) -> Result<Self, Error> {
        let mut antennas = Self::default();
        let mut nearest = None;
        for text in texts {
            antennas.add(text, receiver, &mut nearest)?;
        }
        let receiver = receiver.trim_ascii();
        if let (None, Some(text)) = (&antennas.receiver, texts.last()) {
            let taken = if nearest.is_some() { "taken without its radome" } else { "left out" };
            let problem =
                format!("does not know the receiver's antenna {receiver:?}: it is {taken}");
            antennas.warnings.push(text.warning(problem));
            antennas.receiver = nearest;
        }
        Ok(antennas)
    }

    /// Adds the antennas of a file; `nearest` becomes the receiver's antenna type without a radome.
    fn add(
        &mut self,
        text: &Text,
        receiver: &str,
        nearest: &mut Option<Antenna>,
    ) -> Result<(), Error> {
        let mut lines = text.lines();
        let first = lines.next().filter(|line| line.label() == b"ANTEX VERSION / SYST");
        first.ok_or_else(|| text.wrong_kind("antenna patterns (ANTEX)"))?;
        let wanted = Name::new(receiver.as_bytes());
        let without_radome = Name { radome: *b"NONE", ..wanted };
        let starts = Finder::new("START OF ANTENNA");
        loop {
            lines.skip_past(&starts);
            let Some(line) = lines.next() else { break };
            if line.label() != b"TYPE / SERIAL NO" {
                return Err(line.expected("TYPE / SERIAL NO"));
            }
            let serial = line.columns(20, 40);
            if let (3, [letter, ..]) = (serial.len(), serial)
                && letter.is_ascii_alphabetic()
            {
                if let Some(number) = satellite(serial) {
                    self.satellites.push((number, antenna(&line, &mut lines)?));
                }
                continue;
            }
            if !serial.is_empty() {
                continue;
            }
            let name = Name::new(line.bytes);
            if name == wanted && self.receiver.is_none() {
                self.receiver = Some(antenna(&line, &mut lines)?);
            } else if name == without_radome && nearest.is_none() {
                *nearest = Some(antenna(&line, &mut lines)?);
            }
        }
        Ok(())
    }

    /// The antenna that a satellite uses at a time.
    pub fn satellite(&self, prn: u8, time: GpsTime) -> Option<&Antenna> {
        let fits = |(number, antenna): &&(u8, Antenna)| *number == prn && antenna.is_valid(time);
        self.satellites.iter().rev().find(fits).map(|(_, antenna)| antenna)
    }
}

/// The name of an antenna: a type in 16 columns and a radome in 4.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Name {
    kind: [u8; 16],
    radome: [u8; 4],
}

impl Name {
    fn new(columns: &[u8]) -> Self {
        let mut name = [b' '; 20];
        for (to, from) in name.iter_mut().zip(columns) {
            *to = from.to_ascii_uppercase();
        }
        let mut this = Self { kind: [0; 16], radome: *b"NONE" };
        this.kind.copy_from_slice(&name[..16]);
        if name[16..] != *b"    " {
            this.radome.copy_from_slice(&name[16..]);
        }
        this
    }
}

/// Reads the lines of an antenna after the one with its type.
fn antenna(start: &Line<'_>, lines: &mut Lines<'_>) -> Result<Antenna, Error> {
    let (name, code) = (start.text(0, 20), start.text(40, 50));
    let mut antenna = Antenna { name, code, ..Antenna::default() };
    let mut grid = Grid::default();
    loop {
        let line = lines.expect("the end of an antenna")?;
        match line.label() {
            b"END OF ANTENNA" => return Ok(antenna),
            b"DAZI" => grid.azimuth_step = line.finite("the step of the azimuths", 2, 8)?,
            b"ZEN1 / ZEN2 / DZEN" => {
                grid.first = line.finite("the first angle", 2, 8)?;
                grid.last = line.finite("the last angle", 8, 14)?;
                grid.step = line.finite("the step of the angles", 14, 20)?;
            }
            b"SINEX CODE" => antenna.model = AntennaModel::named(line.columns(0, 10)),
            b"VALID FROM" => antenna.valid_from = Some(line.time(VALIDITY)?),
            b"VALID UNTIL" => antenna.valid_until = Some(line.time(VALIDITY)?),
            b"START OF FREQUENCY" => match band(line.columns(3, 6)) {
                Some(band) => antenna.centres.push((band, grid.frequency(&line, lines)?)),
                None => lines.skip_past(&Finder::new("END OF FREQUENCY")),
            },
            b"START OF FREQ RMS" => lines.skip_past(&Finder::new("END OF FREQ RMS")),
            _ => {}
        }
    }
}

/// The system and the band of a frequency such as `G01`; `None` for one on which there are no carriers.
fn band(frequency: &[u8]) -> Option<(System, u8)> {
    let &[letter, b'0', band] = frequency else { return None };
    let system = System::of_letter(letter)?;
    let bands: &[u8] = match system {
        System::Gps | System::Glonass => b"12",
        System::Galileo => b"157",
        System::BeiDou => b"12567",
    };
    bands.contains(&band).then_some((system, band))
}

const VALIDITY: [usize; 7] = [0, 6, 12, 18, 24, 30, 43];

/// The angles at which a pattern is tabulated, degrees.
#[derive(Debug, Default)]
struct Grid {
    first: f64,
    last: f64,
    step: f64,
    azimuth_step: f64,
}

impl Grid {
    fn frequency(&self, start: &Line<'_>, lines: &mut Lines<'_>) -> Result<PhaseCentre, Error> {
        let angles = steps(self.first, self.last, self.step)
            .ok_or_else(|| start.error("expected the angles of the pattern before it"))?;
        let azimuths = match self.azimuth_step {
            0.0 => 0,
            step => {
                steps(0.0, 360.0, step).ok_or_else(|| start.error("expected a step of azimuths"))?
            }
        };
        let mut centre = PhaseCentre {
            first: self.first,
            step: self.step,
            azimuth_step: self.azimuth_step,
            ..PhaseCentre::default()
        };
        let mut offset_known = false;
        loop {
            let line = lines.expect("the end of a frequency")?;
            if line.label() == b"END OF FREQUENCY" {
                break;
            } else if line.label() == b"NORTH / EAST / UP" {
                offset_known = true;
                for (i, offset) in centre.offset.iter_mut().enumerate() {
                    *offset = line.finite("an offset in mm", 10 * i, 10 * i + 10)? / 1e3;
                }
            } else if line.columns(0, 8) == b"NOAZI" {
                row(&line, angles, &mut centre.mean)?;
            } else if centre.by_azimuth.len() < azimuths * angles {
                row(&line, angles, &mut centre.by_azimuth)?;
            } else {
                return Err(line.expected("the end of a frequency"));
            }
        }
        let whole = centre.mean.len() == angles && centre.by_azimuth.len() == azimuths * angles;
        if whole && offset_known {
            Ok(centre)
        } else {
            Err(start.error("expected an offset and as many rows as the grid has, found others"))
        }
    }
}

/// The number of points of a grid; `None` if it is too large or the step does not divide it.
fn steps(first: f64, last: f64, step: f64) -> Option<usize> {
    let steps = (last - first) / step;
    let fits = (0.0..MOST_ANGLES).contains(&steps) && (steps - steps.round()).abs() < 1e-6;
    fits.then(|| steps.round() as usize + 1)
}

fn row(line: &Line<'_>, angles: usize, values: &mut Vec<f64>) -> Result<(), Error> {
    for i in 1..=angles {
        values.push(line.finite("a phase centre variation in mm", 8 * i, 8 * i + 8)? / 1e3);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
