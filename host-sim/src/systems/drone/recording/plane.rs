//! Conversion of latitude and longitude to metres east and north of the first position.

use crate::Error;
use crate::table::{Column, Header, Row};

/// The Earth's semi-major axis, m, and the square of its eccentricity (WGS 84).
const SEMI_MAJOR_M: f64 = 6_378_137.0;
const ECCENTRICITY_SQUARE: f64 = 6.694_379_990_14e-3;

/// The point where a plane touches the Earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Origin {
    /// The latitude in degrees.
    pub latitude: f64,
    /// The longitude in degrees.
    pub longitude: f64,
}

impl Origin {
    /// The length of a degree in metres, to the east and to the north.
    fn metres_a_degree(&self) -> [f64; 2] {
        let (sine, cosine) = self.latitude.to_radians().sin_cos();
        let square = 1.0 - ECCENTRICITY_SQUARE * sine * sine;
        let normal = SEMI_MAJOR_M / square.sqrt();
        let meridian = normal * (1.0 - ECCENTRICITY_SQUARE) / square;
        [normal * cosine, meridian].map(f64::to_radians)
    }

    /// Converts a position to the plane; the first one becomes the origin. `None` if it is not a valid position, near a
    /// pole, or where both angles are zero, which receivers write before they have a position.
    pub fn place(origin: &mut Option<Self>, latitude: f64, longitude: f64) -> Option<[f64; 2]> {
        let is_fixed = latitude != 0.0 || longitude != 0.0;
        let is_place = is_fixed && latitude.abs() <= 89.0 && longitude.abs() <= 360.0;
        is_place
            .then(|| origin.get_or_insert(Self { latitude, longitude }).plane(latitude, longitude))
    }

    /// The position in the plane, metres to the east and north. Within 10 km it is accurate to a metre.
    fn plane(&self, latitude: f64, longitude: f64) -> [f64; 2] {
        let [east, north] = self.metres_a_degree();
        let turn = longitude - self.longitude;
        // The shorter way may lead across the date line.
        let turn = turn - 360.0 * (turn / 360.0).round();
        [east * turn, north * (latitude - self.latitude)]
    }

    /// The latitude and longitude of a position in the plane, in degrees.
    pub fn degrees(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [east, north] = self.metres_a_degree();
        [self.latitude + y / north, self.longitude + x / east]
    }
}

/// The columns that hold positions.
#[derive(Debug, Clone, Copy)]
pub enum Places {
    /// The columns of x and y (m).
    Plane([Column; 2]),
    /// The columns of latitude and longitude (degrees).
    Earth([Column; 2]),
}

impl Places {
    /// Finds `x,y` or `lat,lon`.
    ///
    /// # Errors
    /// Those of [`Header::require`].
    pub fn find(header: &Header<'_>) -> Result<Self, Error> {
        if let Some(columns) = header.all(["x", "y"])? {
            return Ok(Self::Plane(columns));
        }
        match header.all(["lat", "lon"])? {
            Some(columns) => Ok(Self::Earth(columns)),
            None => header.require(["x", "y"]).map(Self::Plane),
        }
    }

    /// Refuses positions of another kind than those of the log; `origin` is given if that has latitudes and longitudes.
    ///
    /// # Errors
    /// An error that names the header, and what was expected there.
    pub fn as_in_log(self, header: &Header<'_>, origin: Option<Origin>) -> Result<Self, Error> {
        match (self, origin) {
            (Self::Plane(_), Some(_)) => {
                Err(header.error("expected lat,lon as in the log, found x,y"))
            }
            (Self::Earth(_), None) => {
                Err(header.error("expected x,y as in the log, found lat,lon"))
            }
            _ => Ok(self),
        }
    }

    /// The position in a row (m); the first one by latitude and longitude becomes the origin of all.
    ///
    /// # Errors
    /// An error that names the line, and what was expected there.
    pub fn read(&self, row: &Row<'_>, origin: &mut Option<Origin>) -> Result<[f64; 2], Error> {
        match *self {
            Self::Plane([x, y]) => Ok([row.coordinate("x", x)?, row.coordinate("y", y)?]),
            Self::Earth([lat, lon]) => {
                let (latitude, longitude) = (row.number("lat", lat)?, row.number("lon", lon)?);
                Origin::place(origin, latitude, longitude).ok_or_else(|| {
                    row.line.error("expected latitude and longitude of a fix, in degrees")
                })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_receiver_writes_without_a_position_is_none() {
        let mut origin = None;
        assert_eq!(Origin::place(&mut origin, 0.0, 0.0), None);
        assert_eq!(Origin::place(&mut origin, 90.0, 10.0), None);
        assert_eq!(origin, None);
        assert_eq!(Origin::place(&mut origin, 0.0, 29.0), Some([0.0; 2]));
    }

    #[test]
    fn a_plane_touches_the_earth() {
        let origin = Origin { latitude: 52.0, longitude: 179.999 };
        // A minute of latitude at 52° is 1854 m.
        let [x, y] = origin.plane(52.0 + 1.0 / 60.0, 179.999);
        assert!(x.abs() < 1e-9 && (y - 1854.5).abs() < 0.5, "{y}");
        let [x, _] = origin.plane(52.0, -179.999);
        assert!((x - 137.3).abs() < 0.1, "{x}");
        let [latitude, longitude] = origin.degrees(origin.plane(52.01, 179.99));
        assert!((latitude - 52.01).abs() < 1e-12 && (longitude - 179.99).abs() < 1e-12);
    }
}
