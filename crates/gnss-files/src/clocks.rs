//! Satellite clocks: RINEX clock files 2.00, 3.00 and 3.04.

use std::collections::BTreeMap;
use std::path::Path;

use crate::antenna_model::AntennaModel;
use crate::error::{Error, Warning};
use crate::fields::{blank_separated, decimal, first_field, integer};
use crate::satellites::{Differing, PerSatellite};
use crate::system::{System, satellite};
use crate::text::{Line, Lines, Text};
use crate::time::GpsTime;

/// A bias of this size or more stands for an unknown one, s.
const NO_BIAS: f64 = 0.9;

/// Tolerance within which two clock biases of a satellite at one instant are of the same solution, s.
const SAME_CLOCK: f64 = 3e-11;

/// The clock of a satellite at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockSample {
    /// The instant.
    pub time: GpsTime,
    /// The satellite's clock minus GPS time, s, without the relativistic effect of the orbit's eccentricity.
    pub bias: f64,
}

/// Clocks of satellites, which are identified by number ([`Observed::prn`](crate::Observed::prn)).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Clocks {
    samples: PerSatellite<ClockSample>,
    /// Wide-lane biases, cycles, by day (modified Julian date) and satellite.
    wide_lanes: BTreeMap<(i32, u8), f64>,
    /// The edition of the satellite antennas with which the files were made, from the first file that tells it
    /// (`SYS / PCVS APPLIED`).
    pub antenna_model: Option<AntennaModel>,
    /// Warnings about the files.
    pub warnings: Vec<Warning>,
}

impl Clocks {
    /// Reads files in any order, such as those of three days. Where two hold the same instant, the file that begins
    /// later takes precedence.
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(paths: &[impl AsRef<Path>]) -> Result<Self, Error> {
        let texts: Result<Vec<_>, _> = paths.iter().map(Text::read).collect();
        Self::parse(&texts?)
    }

    /// Reads files in memory, like [`Self::read`].
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse(texts: &[Text]) -> Result<Self, Error> {
        let mut clocks = Self::default();
        let files: Result<Vec<_>, _> =
            texts.iter().map(|text| parse_file(text, &mut clocks)).collect();
        let mut differing = Differing::default();
        clocks.samples = PerSatellite::merge(
            files?,
            |sample| sample.time,
            |earlier, later| {
                if (later.bias - earlier.bias).abs() > SAME_CLOCK {
                    differing.add(later.time);
                }
            },
        );
        clocks.warnings.extend(differing.warning(texts, "clocks"));
        Ok(clocks)
    }

    /// The samples of a satellite in chronological order; empty for a satellite that the files do not know.
    pub fn satellite(&self, prn: u8) -> &[ClockSample] {
        self.samples.of(prn)
    }

    /// The samples of a satellite before and after a time, or twice the sample at that time; `None` outside the
    /// samples.
    pub fn around(&self, prn: u8, time: GpsTime) -> Option<[&ClockSample; 2]> {
        let samples = self.satellite(prn);
        let after = samples.partition_point(|sample| sample.time < time);
        let later = samples.get(after)?;
        let earlier = if later.time == time { after } else { after.checked_sub(1)? };
        Some([&samples[earlier], later])
    }

    /// Wide-lane biases by day (modified Julian date) and satellite, in cycles of the wide lane, from the header
    /// comments (`WL`) of CNES/CLS integer clocks.
    ///
    /// Added to a satellite's Melbourne–Wübbena combination, such a bias makes it a whole number apart from the
    /// receiver's own bias (Loyer et al. 2012).
    pub fn wide_lanes(&self) -> impl Iterator<Item = ((i32, u8), f64)> {
        self.wide_lanes.iter().map(|(key, bias)| (*key, *bias))
    }

    /// The numbers of the satellites in the files.
    pub fn satellites(&self) -> impl Iterator<Item = u8> {
        self.samples.numbers()
    }
}

fn parse_file(text: &Text, clocks: &mut Clocks) -> Result<PerSatellite<ClockSample>, Error> {
    let mut lines = text.lines();
    header(text, &mut lines, clocks)?;
    let mut samples = PerSatellite::default();
    let mut dated = None;
    while let Some(line) = lines.next() {
        if lines.is_at_end() && !text.ends_with_line_break() {
            clocks.warnings.push(line.warning("the file ends within this line, which is left out"));
            break;
        }
        match line.bytes {
            [b'A', b'S', b' ', b'G' | b'E' | b'R' | b'C' | b' ', ..] => {
                let (prn, sample) = record(line.bytes, &mut dated)
                    .ok_or_else(|| line.expected("a satellite's clock"))?;
                if let Some(prn) = prn.filter(|_| sample.bias.abs() < NO_BIAS) {
                    samples.push(prn, sample);
                }
            }
            // Records of other satellites and of receivers, and continuation lines.
            [b'A' | b'M', b'S', b' ', ..]
            | [b'A' | b'C' | b'D', b'R', b' ', ..]
            | [b' ', ..]
            | [] => {}
            _ => return Err(line.expected("a record of a clock file")),
        }
    }
    if samples.is_empty() {
        return Err(text.error(
            "expected clocks of satellites of GPS, Galileo, GLONASS or BeiDou, found none",
        ));
    }
    Ok(samples)
}

fn header(text: &Text, lines: &mut Lines<'_>, clocks: &mut Clocks) -> Result<(), Error> {
    let first = lines.next().filter(|line| {
        // Version 3.04 has wider lines.
        let label = line.bytes.get(60..).unwrap_or_default();
        label.trim_ascii().starts_with(b"RINEX VERSION / TYPE")
            && (line.column(20) == b'C' || line.column(21) == b'C')
    });
    first.ok_or_else(|| text.wrong_kind("satellite clocks (RINEX)"))?;
    for line in lines {
        let label = line.bytes.get(60..).unwrap_or_default().trim_ascii();
        match label {
            b"END OF HEADER" => return Ok(()),
            b"TIME SYSTEM ID" => time_system(&line)?,
            b"SYS / PCVS APPLIED" => {
                let told = || AntennaModel::named(line.columns(18, 65));
                clocks.antenna_model = clocks.antenna_model.or_else(told);
            }
            b"COMMENT" if line.bytes.starts_with(b"WL ") => {
                // Comments about other systems or about something else are ignored.
                if let Some((day, prn, bias)) = wide_lane(line.bytes) {
                    clocks.wide_lanes.insert((day, prn), bias);
                }
            }
            _ => {}
        }
    }
    Err(text.error("expected the end of the header, found the end of the file"))
}

/// The day, the satellite and its wide-lane bias, cycles.
fn wide_lane(bytes: &[u8]) -> Option<(i32, u8, f64)> {
    let mut fields = blank_separated(bytes.get(..60)?).skip(1);
    let prn = satellite(fields.next()?)?;
    let mut calendar = [0; 5];
    for field in &mut calendar {
        *field = integer(fields.next()?)?;
    }
    let time = GpsTime::from_calendar(calendar, decimal(fields.next()?)?)?;
    Some((time.day(), prn, decimal(fields.nth(1)?)?))
}

/// Accepts the time systems of GPS, Galileo and QZSS, which agree to some nanoseconds.
fn time_system(line: &Line<'_>) -> Result<(), Error> {
    match line.columns(0, 20) {
        b"" | b"GPS" | b"GAL" | b"QZS" => Ok(()),
        other => {
            let found = String::from_utf8_lossy(other);
            Err(line.error(format!("expected times of GPS, found the time system {found:?}")))
        }
    }
}

/// A date and time as written, and the instant that it means.
type Dated<'a> = Option<(&'a [u8], GpsTime)>;

/// Reads a clock record. Columns differ between versions, but the order of the fields does not.
///
/// The satellites of an epoch share one date, which is read only once. The satellite is `None` if no satellite has the
/// number.
fn record<'a>(bytes: &'a [u8], dated: &mut Dated<'a>) -> Option<(Option<u8>, ClockSample)> {
    let (_, rest) = first_field(bytes)?;
    let (letter, digits, rest) = match first_field(rest)? {
        ([letter @ b'A'..=b'Z'], rest) => {
            let (digits, rest) = first_field(rest)?;
            (*letter, digits, rest)
        }
        ([letter @ b'A'..=b'Z', digits @ ..], rest) => (*letter, digits, rest),
        (digits, rest) => (b'G', digits, rest),
    };
    let number = u8::try_from(integer(digits)?).ok()?;
    let prn = System::of_letter(letter).and_then(|system| system.number(number));
    let known = dated.as_ref().and_then(|(date, time)| {
        let rest = rest.strip_prefix(*date)?;
        rest.first().is_none_or(u8::is_ascii_whitespace).then_some((*time, rest))
    });
    let (time, rest) = if let Some(known) = known {
        known
    } else {
        let (time, behind) = date(rest)?;
        *dated = Some((rest.get(..rest.len() - behind.len())?, time));
        (time, behind)
    };
    let (_, rest) = first_field(rest)?;
    let (bias, _) = first_field(rest).filter(|(field, _)| is_whole(field))?;
    Some((prn, ClockSample { time, bias: decimal(bias)? }))
}

/// The date and time at the beginning of a text, and the rest of the text.
fn date(text: &[u8]) -> Option<(GpsTime, &[u8])> {
    let (mut calendar, mut rest) = ([0; 5], text);
    for number in &mut calendar {
        let field;
        (field, rest) = first_field(rest)?;
        *number = integer(field)?;
    }
    let (second, rest) = first_field(rest)?;
    Some((GpsTime::from_calendar(calendar, decimal(second)?)?, rest))
}

/// Whether a number in the format E19.12 is complete to the end of its exponent: a truncated one would read as another
/// number.
fn is_whole(field: &[u8]) -> bool {
    let exponent = field.iter().position(|byte| matches!(byte, b'E' | b'e' | b'D' | b'd'));
    let exponent = exponent.map_or(&[][..], |start| &field[start..]);
    exponent.iter().filter(|byte| byte.is_ascii_digit()).count() >= 2
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{clocks, header, sentences, text};

    fn complaint(file: &str) -> String {
        Clocks::parse(&[text(file)]).expect_err(file).to_string()
    }

    #[test]
    fn the_edition_of_the_antennas_is_read() -> Result<(), Error> {
        let end = header("", "END OF HEADER");
        let of = |told: &str| {
            let told = header(told, "SYS / PCVS APPLIED") + &end;
            Ok::<_, Error>(Clocks::parse(&[text(clocks().replace(&end, &told))])?.antenna_model)
        };
        assert_eq!(of("G  GPSEST V5.5        IGS20_2415")?, Some(AntennaModel::Igs20));
        assert_eq!(of("G GINS   V11.1      igs14_2108.atx")?, Some(AntennaModel::Igs14));
        assert_eq!(of("G igs08  V11.1      own")?, None);
        assert_eq!(Clocks::parse(&[text(clocks())])?.antenna_model, None);
        Ok(())
    }

    #[test]
    fn satellites_are_read() -> Result<(), Error> {
        let clocks = Clocks::parse(&[text(clocks())])?;
        assert_eq!(clocks.satellites().collect::<Vec<_>>(), [5]);
        let time = |second| GpsTime::new(58_849, second);
        let samples = [
            ClockSample { time: time(0.0), bias: 1e-5 },
            ClockSample { time: time(30.0), bias: -2e-5 },
        ];
        assert_eq!(clocks.satellite(5), samples);
        let [first, second] = &samples;
        assert_eq!(clocks.around(5, time(10.0)), Some([first, second]));
        assert_eq!(clocks.around(5, time(0.0)), Some([first, first]));
        assert_eq!(clocks.around(5, time(30.0)), Some([second, second]));
        assert_eq!(clocks.around(5, time(30.1)), None);
        assert_eq!(clocks.around(5, time(-0.1)), None);
        assert_eq!(clocks.around(6, time(0.0)), None);
        Ok(())
    }

    #[test]
    fn a_number_that_no_satellite_has_is_passed_over() -> Result<(), Error> {
        let of = |name: &str| Clocks::parse(&[text(clocks().replace("AS J07", name))]);
        for (name, expected) in [("AS R00", None), ("AS C76", None), ("AS R 7", Some(157))] {
            let numbers: Vec<_> = of(name)?.satellites().collect();
            assert_eq!(numbers, [5].into_iter().chain(expected).collect::<Vec<_>>());
        }
        assert!(of("AS R0x").is_err());
        Ok(())
    }

    #[test]
    fn the_wide_lines_of_version_3_04_are_read() -> Result<(), Error> {
        let wide = |content: &str, label| format!("{content:<65}{label}\n");
        let file = wide("3.04                 C                    G", "RINEX VERSION / TYPE")
            + &wide("   GPS", "TIME SYSTEM ID")
            + &wide("", "END OF HEADER")
            + "AR ABMF00GLP 2020  1  1  0  0  0.000000  1   -0.159438015248E-04\n"
            + "AS G05       2020  1  1  0  0  0.000000  2   -0.159438015248E-04  0.640687583086E-11\n";
        let clocks = Clocks::parse(&[text(file)])?;
        assert_eq!(clocks.satellite(5)[0].bias, -0.159_438_015_248e-4);
        Ok(())
    }

    #[test]
    fn wide_lanes_stand_in_comments() -> Result<(), Error> {
        let comments = [
            "WL G05  2020  1  1 12  0  0.000000  1   -0.110300E+01  0102",
            "WL E01 2020   1  1 12  0  0.000000  1   -4.400000E-01  0105",
            "WL J07 2020   1  1 12  0  0.000000  1   -4.400000E-01  0105",
            "WL are the wide lanes",
        ];
        let comments = comments.map(|comment| header(comment, "COMMENT")).concat();
        let end = header("", "END OF HEADER");
        let file = clocks().replace(&end, &(comments + &end));
        let clocks = Clocks::parse(&[text(file)])?;
        let day = GpsTime::new(58_849, 0.0).day();
        assert_eq!(
            clocks.wide_lanes().collect::<Vec<_>>(),
            [((day, 5), -1.103), ((day, 101), -0.44)]
        );
        Ok(())
    }

    #[test]
    fn what_cannot_be_used_is_refused() {
        let file = clocks().replace("   GPS ", "   UTC ");
        assert!(
            complaint(&file)
                .contains("line 2: expected times of GPS, found the time system \"UTC\"")
        );
        let file = clocks().replace("0.100000000000E-04", "0.10000000000xE-04");
        assert!(complaint(&file).contains("line 5: expected a satellite's clock"));
        assert!(
            complaint(&clocks().replace("AS G", "AS J")).contains("GLONASS or BeiDou, found none")
        );
        let file = header("     3.04           O", "RINEX VERSION / TYPE");
        assert_eq!(
            complaint(&file),
            "file: expected satellite clocks (RINEX), found observations (RINEX)"
        );
    }

    #[test]
    fn a_number_cut_off_is_refused() {
        let whole = "0.100000000000E-04";
        for kept in 1..whole.len() {
            let file = clocks().replace(whole, &whole[..kept]);
            let found = complaint(&file);
            assert!(found.contains("line 5: expected a satellite's clock"), "{kept}: {found}");
        }
    }

    #[test]
    fn a_line_cut_off_is_left_out() -> Result<(), Error> {
        let file = clocks();
        let cut = Clocks::parse(&[text(&file[..file.len() - 8])])?;
        assert_eq!(cut.satellite(5).len(), 1);
        assert_eq!(
            sentences(&cut.warnings),
            ["file, line 8: the file ends within this line, which is left out"]
        );
        Ok(())
    }
}
