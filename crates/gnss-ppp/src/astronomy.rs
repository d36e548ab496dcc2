//! Angles of the Sun, the Moon and the Earth, shared by the positions of the bodies and the tides.

use core::f64::consts::{PI, TAU};

use crate::GpsTime;
use crate::constants::TERRESTRIAL_MINUS_GPS;

/// Greenwich mean sidereal time, rad from 0 to 2π (IAU 2006; Capitaine et al. 2005).
///
/// `ut1_minus_gps` (s) is UT1 − UTC minus the seconds by which GPS time is ahead of UTC: −18 and a fraction since 2017.
/// If UT1 − UTC is unknown, it may be omitted: 0.9 s turn the Earth by 66 µrad, and change the tides by some 50 µm.
pub fn greenwich_sidereal_time(time: GpsTime, ut1_minus_gps: f64) -> f64 {
    let days = time.days_since_j2000(ut1_minus_gps);
    let centuries = time.days_since_j2000(TERRESTRIAL_MINUS_GPS) / 36_525.0;
    // The Earth's rotation angle (IERS Conventions 2010, 5.15) and the precession of the equinox in arcseconds.
    let turns = 0.779_057_273_264_0 + 0.002_737_811_911_354_48 * days + (days - libm::floor(days));
    let precession = 0.014_506 + (4_612.156_534 + 1.391_581_7 * centuries) * centuries;
    let angle = (turns - libm::floor(turns)) * TAU + arcseconds(precession);
    angle - TAU * libm::floor(angle / TAU)
}

/// The arguments of the series for Sun, Moon and tides at one instant, rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arguments {
    /// Julian centuries of terrestrial time since J2000.0.
    pub(crate) centuries: f64,
    /// Mean anomaly of the Moon, l.
    pub(crate) moon_anomaly: f64,
    /// Mean anomaly of the Sun, l′.
    pub(crate) sun_anomaly: f64,
    /// Mean distance of the Moon from its node, F.
    pub(crate) node_distance: f64,
    /// Mean elongation of the Moon from the Sun, D.
    pub(crate) elongation: f64,
    /// Mean longitude of the Moon's ascending node, Ω.
    pub(crate) node: f64,
    /// Greenwich mean sidereal time.
    pub(crate) sidereal: f64,
}

impl Arguments {
    /// Computes Delaunay's arguments (IERS Conventions 2010, 5.43, up to the square of time).
    pub(crate) fn at(time: GpsTime, ut1_minus_gps: f64) -> Self {
        let t = time.days_since_j2000(TERRESTRIAL_MINUS_GPS) / 36_525.0;
        let angle = |degrees: f64, linear: f64, square: f64| {
            degrees.to_radians() + arcseconds((linear + square * t) * t)
        };
        Self {
            centuries: t,
            moon_anomaly: angle(134.963_402_51, 1_717_915_923.217_8, 31.879_2),
            sun_anomaly: angle(357.529_109_18, 129_596_581.048_1, -0.553_2),
            node_distance: angle(93.272_090_62, 1_739_527_262.847_8, -12.751_2),
            elongation: angle(297.850_195_47, 1_602_961_601.209_0, -6.370_6),
            node: angle(125.044_555_01, -6_962_890.543_1, 7.472_2),
            sidereal: greenwich_sidereal_time(time, ut1_minus_gps),
        }
    }

    /// Mean longitude of the Moon, s.
    pub(crate) fn moon_longitude(&self) -> f64 {
        self.node_distance + self.node
    }

    /// Mean longitude of the Sun, h.
    pub(crate) fn sun_longitude(&self) -> f64 {
        self.moon_longitude() - self.elongation
    }

    /// Mean longitude of the Moon's perigee, p.
    pub(crate) fn perigee(&self) -> f64 {
        self.moon_longitude() - self.moon_anomaly
    }

    /// Mean longitude of the Sun's perigee, p₁.
    pub(crate) fn sun_perigee(&self) -> f64 {
        self.sun_longitude() - self.sun_anomaly
    }

    /// Mean lunar time at Greenwich, τ: from the Moon's lower transit.
    pub(crate) fn lunar_time(&self) -> f64 {
        self.sidereal + PI - self.moon_longitude()
    }

    /// Mean solar time at Greenwich, from midnight, as an angle.
    pub(crate) fn solar_time(&self) -> f64 {
        self.sidereal + PI - self.sun_longitude()
    }
}

/// Converts an angle in arcseconds to radians.
fn arcseconds(angle: f64) -> f64 {
    (angle / 3_600.0).to_radians()
}

#[cfg(test)]
mod tests {
    use super::greenwich_sidereal_time;
    use crate::GpsTime;

    /// Computed with ERFA 2.0.1 (`gmst06`).
    #[test]
    fn sidereal_time_as_erfa_has_it() {
        for (time, ut1_minus_gps, expected) in [
            (GpsTime::new(59_025, 43_200.0), -18.24, 1.640_825_255_582_921_2),
            (GpsTime::new(54_613, 0.0), -14.39, 4.273_603_426_979_619),
        ] {
            let sidereal = greenwich_sidereal_time(time, ut1_minus_gps);
            assert!((sidereal - expected).abs() < 1e-10, "{sidereal} {expected}");
        }
    }
}
