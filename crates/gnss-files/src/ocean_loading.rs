//! Ocean loading of stations: BLQ.

use std::path::Path;

use crate::error::{Error, Warning};
use crate::fields::{blank_separated, decimal};
use crate::text::{Line, Text};

/// Stations closer than this are at the same place, degrees.
const SAME_PLACE: f64 = 0.1;
/// The number of tidal waves in a line.
const WAVES: usize = 11;

/// The displacement of a station by ocean tide loading: eleven waves (M2 S2 N2 K2 K1 O1 P1 Q1 Mf Mm Ssa).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OceanLoading {
    /// Amplitudes, m: radially up, tangentially west, tangentially south.
    pub amplitude: [[f64; WAVES]; 3],
    /// Phase lags behind Greenwich, degrees: radially up, tangentially west, tangentially south.
    pub lag: [[f64; WAVES]; 3],
}

/// The ocean loading of a station, looked up in a file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StationLoading {
    /// The loading; `None` if the file does not know the station.
    pub loading: Option<OceanLoading>,
    /// Warnings about the file.
    pub warnings: Vec<Warning>,
}

impl StationLoading {
    /// Looks a station up by the first four letters of its marker's name, or else by its position (ECEF, m).
    ///
    /// # Errors
    /// [`Error`]: the file, the line, what was expected there and what was found.
    pub fn read(
        path: impl AsRef<Path>,
        marker: &str,
        position: Option<[f64; 3]>,
    ) -> Result<Self, Error> {
        Self::parse(&Text::read(path)?, marker, position)
    }

    /// Looks a station up in a file in memory, like [`Self::read`].
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub fn parse(text: &Text, marker: &str, position: Option<[f64; 3]>) -> Result<Self, Error> {
        let stations = stations(text)?;
        let place = position.map(longitude_latitude);
        let near = |station: &Station| Some(distance(place?, station.place?) < SAME_PLACE);
        let wanted = four_letters(marker.as_bytes());
        let named = |station: &&Station| station.name == wanted && wanted[0] != b' ';
        let mut this = Self::default();
        // A matching name at another place belongs to another station.
        let by_name = stations.iter().filter(named).find(|station| near(station) != Some(false));
        let by_place = || stations.iter().find(|station| near(station) == Some(true));
        let marker = marker.trim_ascii();
        if let Some(station) = by_name {
            this.loading = Some(station.loading);
        } else if let Some(station) = by_place() {
            let name = String::from_utf8_lossy(&station.name);
            let problem = format!("does not know station {marker:?}: {name} is at its place");
            this.warnings.push(text.warning(problem));
            this.loading = Some(station.loading);
        } else {
            let problem =
                format!("does not know station {marker:?}: its ocean loading is left out");
            this.warnings.push(text.warning(problem));
        }
        Ok(this)
    }
}

struct Station {
    name: [u8; 4],
    /// Longitude and latitude, degrees.
    place: Option<[f64; 2]>,
    loading: OceanLoading,
}

fn stations(text: &Text) -> Result<Vec<Station>, Error> {
    let mut stations = Vec::new();
    let mut lines = text.lines().filter(|line| !line.bytes.trim_ascii().is_empty()).peekable();
    while let Some(line) = lines.next() {
        if is_comment(&line) {
            continue;
        }
        let name = line.bytes.trim_ascii();
        if matches!(name, b"Errors:" | b"Warnings:") && !stations.is_empty() {
            // The loading service of Onsala appends messages after the last station.
            break;
        }
        let number = blank_separated(name).next().is_some_and(|field| decimal(field).is_some());
        // A name may be a number, alone on its line.
        let is_name = name.iter().all(u8::is_ascii_digit);
        if number && !is_name || !name[0].is_ascii_alphanumeric() {
            return Err(if stations.is_empty() {
                text.wrong_kind("ocean loading (BLQ)")
            } else {
                line.expected("a station's name")
            });
        }
        let mut place = None;
        while let Some(comment) = lines.next_if(is_comment) {
            place = place.or(comment_place(&comment));
        }
        let mut rows = [[0.0; WAVES]; 6];
        for values in &mut rows {
            let next = lines.by_ref().find(|line| !is_comment(line));
            let next =
                next.ok_or_else(|| line.error("expected six lines of ocean loading behind it"))?;
            *values = row(&next)?;
        }
        let [up, west, south, rest @ ..] = rows;
        let loading = OceanLoading { amplitude: [up, west, south], lag: rest };
        stations.push(Station { name: four_letters(line.bytes), place, loading });
    }
    if stations.is_empty() {
        return Err(text.wrong_kind("ocean loading (BLQ)"));
    }
    Ok(stations)
}

fn is_comment(line: &Line<'_>) -> bool {
    line.bytes.trim_ascii_start().starts_with(b"$$")
}

fn comment_place(line: &Line<'_>) -> Option<[f64; 2]> {
    const WORD: &[u8] = b"lon/lat:";
    let start = memchr::memmem::find(line.bytes, WORD)? + WORD.len();
    let mut values = blank_separated(&line.bytes[start..]).map_while(decimal);
    Some([values.next()?, values.next()?])
}

fn row(line: &Line<'_>) -> Result<[f64; WAVES], Error> {
    let complaint = || line.expected("eleven numbers of ocean loading");
    let mut row = [0.0; WAVES];
    let mut fields = blank_separated(line.bytes);
    for value in &mut row {
        *value = fields.next().and_then(decimal).ok_or_else(complaint)?;
    }
    if fields.next().is_some() { Err(complaint()) } else { Ok(row) }
}

fn four_letters(name: &[u8]) -> [u8; 4] {
    let mut letters = [b' '; 4];
    for (to, from) in letters.iter_mut().zip(name.trim_ascii()) {
        *to = from.to_ascii_uppercase();
    }
    letters
}

/// Geodetic longitude and latitude (WGS 84) of an ECEF position, degrees. The latitude is exact on the ellipsoid, and
/// at most 0.001° off within 20 km of it, which is negligible here.
fn longitude_latitude([x, y, z]: [f64; 3]) -> [f64; 2] {
    /// The square of the ellipsoid's first eccentricity.
    const ECCENTRICITY_SQUARED: f64 = 6.694_379_990_14e-3;
    let latitude = z.atan2((1.0 - ECCENTRICITY_SQUARED) * x.hypot(y));
    [y.atan2(x).to_degrees(), latitude.to_degrees()]
}

/// The distance between two points given by longitude and latitude, degrees, on a sphere away from its poles.
fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let east = (a[0] - b[0] + 540.0).rem_euclid(360.0) - 180.0;
    (east * a[1].to_radians().cos()).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{loading, sentences, text};

    fn place(longitude: f64) -> [f64; 3] {
        let (longitude, latitude) = (f64::to_radians(longitude), f64::to_radians(50.0));
        // The radius of curvature in the prime vertical, plus 10 m of height above the ellipsoid.
        let (sine, cosine) = latitude.sin_cos();
        let normal = 6_378_137.0 / (1.0 - 6.694_379_990_14e-3 * sine * sine).sqrt();
        let equatorial = (normal + 10.0) * cosine;
        let up = (normal * (1.0 - 6.694_379_990_14e-3) + 10.0) * sine;
        [equatorial * longitude.cos(), equatorial * longitude.sin(), up]
    }

    #[test]
    fn a_station_is_found_by_its_name() -> Result<(), Error> {
        for place in [None, Some(place(-2.05))] {
            let found = StationLoading::parse(&text(loading()), "here00XXX", place)?;
            let loading = found.loading.expect("it is there");
            assert_eq!((loading.amplitude[2][1], loading.lag[0][10]), (2.01, 3.1));
            assert_eq!(sentences(&found.warnings), [""; 0]);
        }
        Ok(())
    }

    #[test]
    fn a_number_for_a_name_and_a_footer() -> Result<(), Error> {
        let file =
            loading().replace("HERE", "0042") + "$$ END TABLE\nErrors:\nWarnings:\n a word\n";
        let found = StationLoading::parse(&text(file), "0042", None)?;
        assert!(found.loading.is_some() && found.warnings.is_empty());
        Ok(())
    }

    #[test]
    fn a_station_is_found_by_its_place() -> Result<(), Error> {
        let found = StationLoading::parse(&text(loading()), "ELSE", Some(place(1.0)))?;
        assert!(found.loading.is_some());
        assert_eq!(
            sentences(&found.warnings),
            ["file: does not know station \"ELSE\": THER is at its place"]
        );
        Ok(())
    }

    #[test]
    fn a_station_that_is_not_there_is_told() -> Result<(), Error> {
        let names = [("ELSE", None), ("HERE", Some(place(90.0))), ("", None)];
        for (name, place) in names {
            let found = StationLoading::parse(&text(loading()), name, place)?;
            assert_eq!(found.loading, None);
            assert!(sentences(&found.warnings)[0].ends_with("its ocean loading is left out"));
        }
        Ok(())
    }

    #[test]
    fn damage_is_located() {
        let complaint = |file: &str| {
            StationLoading::parse(&text(file), "HERE", None).expect_err(file).to_string()
        };
        let file = loading().replacen(" 2.05", " 2.x5", 1);
        assert!(complaint(&file).starts_with("file, line 7: expected eleven numbers"));
        let file = loading();
        assert!(complaint(&file[..file.len() - 112]).contains("expected six lines"));
        assert!(complaint("1.0 2.0\n").contains("expected ocean loading (BLQ), found \"1.0 2.0\""));
        assert!(complaint("$$ nothing\n").contains("expected ocean loading (BLQ)"));
    }
}
