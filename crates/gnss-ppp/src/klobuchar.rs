//! The ionosphere model that GPS broadcasts.

use core::f64::consts::{PI, TAU};

use crate::constants::SPEED_OF_LIGHT;
use crate::trigonometry::cos;
use crate::{Direction, Geodetic, GpsTime};

/// The delay at night, s.
const NIGHT: f64 = 5e-9;
/// The time of the largest delay, s of local time.
const AFTERNOON: f64 = 50_400.0;
/// The lower limit of the period, s.
const SHORTEST: f64 = 72_000.0;

/// Klobuchar's model with the coefficients that GPS broadcasts: half of the delay remains as root mean square error
/// (IS-GPS-200, 20.3.3.5.2.5).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Klobuchar {
    /// The coefficients of the amplitude: s, s per semicircle of geomagnetic latitude, and so on.
    pub alpha: [f64; 4],
    /// The coefficients of the period: s, s per semicircle of geomagnetic latitude, and so on.
    pub beta: [f64; 4],
}

impl Klobuchar {
    /// The delay of a code on L1 (or E1, which has the same frequency), m. On another frequency f it is (f₁/f)² times
    /// as long.
    pub fn delay(&self, place: &Geodetic, direction: &Direction, time: GpsTime) -> f64 {
        // Angles are in semicircles, as everywhere in the model.
        let elevation = direction.elevation / PI;
        let away = 0.0137 / (elevation + 0.11) - 0.022;
        let (sine, cosine) = libm::sincos(direction.azimuth);
        let latitude = (place.latitude / PI + away * cosine).clamp(-0.416, 0.416);
        let longitude = place.longitude / PI + away * sine / cos(latitude * PI);
        let geomagnetic = latitude + 0.064 * cos((longitude - 1.617) * PI);
        let local = 43_200.0 * longitude + time.second();
        let local = local - libm::floor(local / 86_400.0) * 86_400.0;
        let slant = libm::pow(0.53 - elevation, 3.0) * 16.0 + 1.0;
        let period = polynomial(&self.beta, geomagnetic).max(SHORTEST);
        let amplitude = polynomial(&self.alpha, geomagnetic).max(0.0);
        let phase = TAU * (local - AFTERNOON) / period;
        let day = if libm::fabs(phase) < 1.57 {
            let square = phase * phase;
            amplitude * (1.0 + square * (square / 24.0 - 0.5))
        } else {
            0.0
        };
        SPEED_OF_LIGHT * slant * (NIGHT + day)
    }
}

fn polynomial(&[a, b, c, d]: &[f64; 4], x: f64) -> f64 {
    a + x * (b + x * (c + x * d))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn delay(
        model: &Klobuchar,
        [latitude, longitude, elevation, azimuth]: [f64; 4],
        second: f64,
    ) -> f64 {
        let place = Geodetic {
            latitude: latitude.to_radians(),
            longitude: longitude.to_radians(),
            height: 0.0,
        };
        let direction =
            Direction { elevation: elevation.to_radians(), azimuth: azimuth.to_radians() };
        model.delay(&place, &direction, GpsTime::new(59_025, second))
    }

    /// The example that circulates with implementations of the model (40° N, 100° W, 20:45 UTC: 23.784 m), and a
    /// station in Denmark, computed from the formulas in Python.
    #[test]
    fn known_delays() {
        let model = Klobuchar {
            alpha: [0.382e-7, 0.149e-7, -0.179e-6, 0.0],
            beta: [0.143e6, 0.0, -0.328e6, 0.113e6],
        };
        let afternoon = delay(&model, [40.0, -100.0, 20.0, 210.0], 593_100.0 % 86_400.0);
        assert!((afternoon - 23.784_147_585).abs() < 1e-6, "{afternoon}");
        let model = Klobuchar {
            alpha: [4.6566e-9, 1.4901e-8, -5.9605e-8, -1.1921e-7],
            beta: [8.192e4, 9.8304e4, -6.5536e4, -5.2429e5],
        };
        for (hour, expected) in [(14.0, 2.907_837_706), (2.0, 2.649_302_815)] {
            let found = delay(&model, [55.5, 8.4, 30.0, 120.0], 3_600.0 * hour);
            assert!((found - expected).abs() < 1e-6, "{found}");
        }
    }
}
