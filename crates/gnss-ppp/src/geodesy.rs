use kestirim_scalar::Components;
use nalgebra::{Matrix3, Vector3};

/// Semi-major axis of the GRS 80 ellipsoid, m.
const SEMI_MAJOR: f64 = 6_378_137.0;
/// Flattening of the ellipsoid.
const FLATTENING: f64 = 1.0 / 298.257_222_101;
/// First eccentricity of the ellipsoid, squared.
const ECCENTRICITY_SQUARED: f64 = FLATTENING * (2.0 - FLATTENING);

/// A geodetic position relative to the GRS 80 ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Geodetic {
    /// Geodetic latitude, rad, north positive.
    pub latitude: f64,
    /// Longitude, rad, east positive, from −π to π.
    pub longitude: f64,
    /// Height above the ellipsoid, m.
    pub height: f64,
}

impl Geodetic {
    /// Converts an ECEF position (m).
    ///
    /// The latitude is found by fixed-point iteration, to below a micrometre from 10 km below ground to the orbits of
    /// satellites. At the Earth's centre the latitude is meaningless, but finite.
    pub fn from_ecef(position: &Vector3<f64>) -> Self {
        let [x, y, z] = *position.as_array();
        let equatorial = libm::hypot(x, y);
        let mut shifted = z;
        let mut normal = SEMI_MAJOR;
        for _ in 0..8 {
            let sine = shifted / libm::hypot(equatorial, shifted).max(f64::MIN_POSITIVE);
            normal = SEMI_MAJOR / libm::sqrt(1.0 - ECCENTRICITY_SQUARED * sine * sine);
            shifted = z + normal * ECCENTRICITY_SQUARED * sine;
        }
        Self {
            latitude: libm::atan2(shifted, equatorial),
            longitude: libm::atan2(y, x),
            height: libm::hypot(equatorial, shifted) - normal,
        }
    }

    /// The ECEF position (m) of this place.
    pub fn to_ecef(&self) -> Vector3<f64> {
        let (sine, cosine) = libm::sincos(self.latitude);
        let (sine_longitude, cosine_longitude) = libm::sincos(self.longitude);
        let normal = SEMI_MAJOR / libm::sqrt(1.0 - ECCENTRICITY_SQUARED * sine * sine);
        let equatorial = (normal + self.height) * cosine;
        Vector3::new(
            equatorial * cosine_longitude,
            equatorial * sine_longitude,
            (normal * (1.0 - ECCENTRICITY_SQUARED) + self.height) * sine,
        )
    }

    /// The rotation from ECEF to the local east, north, up.
    pub fn enu_from_ecef(&self) -> Matrix3<f64> {
        let (sine, cosine) = libm::sincos(self.latitude);
        let (sine_longitude, cosine_longitude) = libm::sincos(self.longitude);
        Matrix3::new(
            -sine_longitude,
            cosine_longitude,
            0.0,
            -sine * cosine_longitude,
            -sine * sine_longitude,
            cosine,
            cosine * cosine_longitude,
            cosine * sine_longitude,
            sine,
        )
    }
}

/// The direction from a receiver to a satellite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Direction {
    /// The angle above the horizon, rad.
    pub elevation: f64,
    /// The angle from north over east, rad, from 0 to 2π.
    pub azimuth: f64,
}

impl Direction {
    /// The direction of the unit vector `sight` (ECEF, receiver to satellite) at `place`.
    pub fn of(sight: &Vector3<f64>, place: &Geodetic) -> Self {
        Self::of_local(&(place.enu_from_ecef() * sight))
    }

    /// The direction of a unit vector to the east, north and up.
    pub(crate) fn of_local(local: &Vector3<f64>) -> Self {
        let [east, north, up] = *local.as_array();
        let azimuth = libm::atan2(east, north);
        Self {
            elevation: libm::atan2(up, libm::sqrt(east * east + north * north)),
            azimuth: if azimuth < 0.0 { azimuth + core::f64::consts::TAU } else { azimuth },
        }
    }

    /// The unit vector to the east, north and up.
    pub fn local(self) -> Vector3<f64> {
        let (up, level) = libm::sincos(self.elevation);
        let (east, north) = libm::sincos(self.azimuth);
        Vector3::new(level * east, level * north, up)
    }
}

#[cfg(test)]
mod tests {
    use super::{Direction, Geodetic};
    use nalgebra::Vector3;

    #[test]
    fn there_and_back() {
        for degrees in -90..=90 {
            for height in [-10e3, 0.0, 4_807.0, 20_200e3] {
                let latitude = f64::from(degrees).to_radians();
                let place = Geodetic { latitude, longitude: latitude * 1.9, height };
                let back = Geodetic::from_ecef(&place.to_ecef());
                assert!((back.to_ecef() - place.to_ecef()).norm() < 1e-6, "{place:?} {back:?}");
                assert!((back.height - height).abs() < 1e-6, "{place:?} {back:?}");
            }
        }
    }

    #[test]
    fn poles_and_the_centre_are_finite() {
        for position in [Vector3::zeros(), Vector3::z() * 6.4e6, -Vector3::z() * 1e-300] {
            let place = Geodetic::from_ecef(&position);
            assert!(place.latitude.is_finite() && place.height.is_finite(), "{place:?}");
        }
    }

    #[test]
    fn a_satellite_in_the_east() {
        let place = Geodetic { latitude: 0.5, longitude: 1.0, height: 0.0 };
        let east = place.enu_from_ecef().transpose() * Vector3::new(1.0, 0.0, 0.0);
        let direction = Direction::of(&east, &place);
        assert!(direction.elevation.abs() < 1e-12);
        assert!((direction.azimuth - core::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
