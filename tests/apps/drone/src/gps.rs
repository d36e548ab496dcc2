//! Positions from a satellite receiver: its GGA sentences.

use nmea::ParseResult;
use nmea::sentences::FixType;

use crate::site::{GROUND, ORIGIN};

/// The lengths of a degree of longitude and of latitude at the origin, m.
#[derive(Clone, Copy, Debug)]
pub struct Degree([f64; 2]);

impl Degree {
    /// The lengths on the ellipsoid of GPS, to 0.1 m per degree.
    pub fn at_origin() -> Self {
        let latitude = ORIGIN[0].to_radians();
        let cosine = |multiple: f64| libm::cos(multiple * latitude);
        Self([
            111_412.84 * cosine(1.0) - 93.5 * cosine(3.0) + 0.118 * cosine(5.0),
            111_132.95 - 559.822 * cosine(2.0) + 1.175 * cosine(4.0),
        ])
    }

    /// The position east and north of the origin and above the ground, m, from a sentence that contains one.
    pub fn place(&self, sentence: &str) -> Option<[f32; 3]> {
        let Ok(ParseResult::GGA(fix)) = nmea::parse_str(sentence) else { return None };
        if matches!(fix.fix_type?, FixType::Invalid | FixType::Estimated | FixType::Simulation) {
            return None;
        }
        let ([latitude, longitude], Self([east, north])) = (ORIGIN, self);
        Some([
            ((fix.longitude? - longitude) * east) as f32,
            ((fix.latitude? - latitude) * north) as f32,
            fix.altitude? - GROUND,
        ])
    }
}
