//! Polar motion: IGS ERP.

use std::path::Path;

use crate::error::Error;
use crate::fields::{blank_separated, decimal};
use crate::text::{Line, Text};
use crate::time::GpsTime;

/// How far outside its samples a file is used, s: the pole moves 0.01″ in that time at most.
const BEYOND: f64 = 2.0 * 86_400.0;
/// The largest plausible pole coordinate, ″: the pole has not been farther off.
const FARTHEST: f64 = 1.0;
/// The unit of pole coordinates in the file, ″.
const UNIT: f64 = 1e-6;

/// The motion of the Earth's rotation axis relative to its crust, from an Earth rotation file.
#[derive(Debug, Clone, PartialEq)]
pub struct EarthRotation {
    /// The pole in chronological order; x towards Greenwich and y towards 90° west, ″.
    samples: Vec<(GpsTime, [f64; 2])>,
}

impl EarthRotation {
    /// Reads a file.
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::parse(&Text::read(path)?)
    }

    /// Reads a file in memory, like [`Self::read`].
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse(text: &Text) -> Result<Self, Error> {
        let mut lines = text.lines();
        if !lines.next().is_some_and(|first| is_earth_rotation(first.bytes)) {
            return Err(text.wrong_kind("Earth rotation (ERP version 2)"));
        }
        let is_table = |line: &Line<'_>| blank_separated(line.bytes).next() == Some(b"MJD");
        let found = lines.find(is_table);
        found.ok_or_else(|| text.error("expected the line that begins with MJD"))?;
        lines.expect("the line of units")?;
        let mut samples = Vec::new();
        for line in lines.filter(|line| !line.bytes.trim_ascii().is_empty()) {
            samples.push(sample(&line)?);
        }
        samples.sort_by(|a, b| a.0.since(b.0).total_cmp(&0.0));
        if samples.is_empty() {
            return Err(text.error("expected a line of the table"));
        }
        Ok(Self { samples })
    }

    /// The pole at an instant, x towards Greenwich and y towards 90° west, rad; `None` more than two days outside the
    /// file.
    pub fn pole(&self, time: GpsTime) -> Option<[f64; 2]> {
        let behind = self.samples.partition_point(|(at, _)| at.since(time) <= 0.0);
        let before = behind.checked_sub(1).and_then(|last| self.samples.get(last));
        let seconds = match (before, self.samples.get(behind)) {
            (Some((earlier, from)), Some((later, to))) => {
                let share = time.since(*earlier) / later.since(*earlier);
                [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
            }
            (Some((at, pole)), None) | (None, Some((at, pole)))
                if at.since(time).abs() <= BEYOND =>
            {
                *pole
            }
            _ => return None,
        };
        Some(seconds.map(|angle| (angle / 3600.0).to_radians()))
    }
}

/// Whether a first line is that of an Earth rotation file.
pub(crate) fn is_earth_rotation(first: &[u8]) -> bool {
    first.trim_ascii().eq_ignore_ascii_case(b"VERSION 2")
}

/// Reads an instant, written as a modified Julian date, and the pole, ″.
fn sample(line: &Line<'_>) -> Result<(GpsTime, [f64; 2]), Error> {
    let complaint = || line.expected("a date (MJD) and where the axis is (10⁻⁶″)");
    let mut fields = blank_separated(line.bytes).map(decimal);
    let mut next = || fields.next().flatten().ok_or_else(complaint);
    let (date, pole) = (next()?, [next()? * UNIT, next()? * UNIT]);
    if !(40_000.0..100_000.0).contains(&date) || pole.iter().any(|it| it.abs() > FARTHEST) {
        return Err(complaint());
    }
    let day = date.floor();
    Ok((GpsTime::new(day as i32, (date - day) * 86_400.0), pole))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{earth_rotation, text};

    #[test]
    fn the_axis_between_samples_and_beyond() -> Result<(), Error> {
        let file = EarthRotation::parse(&text(earth_rotation()))?;
        let at = |day, second| {
            let pole = file.pole(GpsTime::new(day, second))?;
            Some(pole.map(|angle| (angle.to_degrees() * 3600.0 * 1e6).round()))
        };
        assert_eq!(at(61_161, 0.0), Some([155_985.0, 417_263.0]));
        assert_eq!(at(61_161, 21_600.0), Some([156_190.0, 417_281.0]));
        assert_eq!(at(61_159, 0.0), Some([155_985.0, 417_263.0]));
        assert_eq!(at(61_163, 43_200.0), Some([156_395.0, 417_298.0]));
        assert_eq!([at(61_158, 86_399.0), at(61_163, 43_201.0)], [None; 2]);
        Ok(())
    }

    #[test]
    fn damage_is_located() {
        let complaint = |file: &str| EarthRotation::parse(&text(file)).expect_err(file).to_string();
        let file = earth_rotation();
        let damaged = complaint(&file.replace("417263", "4172x3"));
        assert!(damaged.starts_with("file, line 6: expected a date (MJD)"), "{damaged}");
        assert!(complaint(&file.replace("417263", "4172630000")).contains("where the axis is"));
        assert!(complaint(&file.replace("MJD", "JD")).contains("the line that begins with MJD"));
        let header = file.split("61161").next().expect("a header");
        assert!(complaint(header).contains("expected a line of the table"));
        assert!(complaint("version 1\n").contains("expected Earth rotation (ERP version 2)"));
    }
}
