use nalgebra::Vector3;

use crate::GpsTime;
use crate::astronomy::Arguments;
use crate::constants::ASTRONOMICAL_UNIT;
use crate::trigonometry::{Turn, cos, sin};

/// Positions of the Sun and the Moon relative to the Earth's centre, ECEF, m.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Bodies {
    /// The Sun.
    pub sun: Vector3<f64>,
    /// The Moon.
    pub moon: Vector3<f64>,
}

/// Multiples of D, l′, l and F, and the terms of the Moon's longitude (10⁻⁶ degrees, with the sine) and distance (m,
/// with the cosine): the largest terms of Meeus 1998, table 47.A.
const LONGITUDE_AND_DISTANCE: [([i8; 4], f64, f64); 24] = [
    ([0, 0, 1, 0], 6_288_774.0, -20_905_355.0),
    ([2, 0, -1, 0], 1_274_027.0, -3_699_111.0),
    ([2, 0, 0, 0], 658_314.0, -2_955_968.0),
    ([0, 0, 2, 0], 213_618.0, -569_925.0),
    ([0, 1, 0, 0], -185_116.0, 48_888.0),
    ([0, 0, 0, 2], -114_332.0, -3_149.0),
    ([2, 0, -2, 0], 58_793.0, 246_158.0),
    ([2, -1, -1, 0], 57_066.0, -152_138.0),
    ([2, 0, 1, 0], 53_322.0, -170_733.0),
    ([2, -1, 0, 0], 45_758.0, -204_586.0),
    ([0, 1, -1, 0], -40_923.0, -129_620.0),
    ([1, 0, 0, 0], -34_720.0, 108_743.0),
    ([0, 1, 1, 0], -30_383.0, 104_755.0),
    ([2, 0, 0, -2], 15_327.0, 10_321.0),
    ([0, 0, 1, 2], -12_528.0, 0.0),
    ([0, 0, 1, -2], 10_980.0, 79_661.0),
    ([4, 0, -1, 0], 10_675.0, -34_782.0),
    ([0, 0, 3, 0], 10_034.0, -23_210.0),
    ([4, 0, -2, 0], 8_548.0, -21_636.0),
    ([2, 1, -1, 0], -7_888.0, 24_208.0),
    ([2, 1, 0, 0], -6_766.0, 30_824.0),
    ([1, 0, -1, 0], -5_163.0, -8_379.0),
    ([1, 1, 0, 0], 4_987.0, -16_675.0),
    ([2, -1, 1, 0], 4_036.0, -12_831.0),
];
/// Multiples of D, l′, l and F, and the terms of the Moon's latitude (10⁻⁶ degrees, with the sine; table 47.B).
const LATITUDE: [([i8; 4], f64); 12] = [
    ([0, 0, 0, 1], 5_128_122.0),
    ([0, 0, 1, 1], 280_602.0),
    ([0, 0, 1, -1], 277_693.0),
    ([2, 0, 0, -1], 173_237.0),
    ([2, 0, -1, 1], 55_413.0),
    ([2, 0, -1, -1], 46_271.0),
    ([2, 0, 0, 1], 32_573.0),
    ([0, 0, 2, 1], 17_198.0),
    ([2, 0, 1, -1], 9_266.0),
    ([0, 0, 2, -1], 8_822.0),
    ([2, -1, 0, -1], 8_216.0),
    ([2, 0, -2, -1], 4_324.0),
];

impl Bodies {
    /// The bodies at an instant; `ut1_minus_gps` (s) as for
    /// [`greenwich_sidereal_time`](crate::greenwich_sidereal_time).
    ///
    /// Compared with ERFA's ephemerides, the Sun is within 0.01°, the Moon within 0.04° and 80 km from 1990 to 2044:
    /// together at most 0.23 mm of tide.
    ///
    /// The positions are geometric on the mean equator of date, turned by mean sidereal time: nutation (0.003°), polar
    /// motion and light time are neglected.
    pub fn at(time: GpsTime, ut1_minus_gps: f64) -> Self {
        let arguments = Arguments::at(time, ut1_minus_gps);
        let obliquity = (23.439_279_4 - 0.013_010_2 * arguments.centuries).to_radians();
        let earth_fixed = |longitude: f64, latitude: f64, distance: f64| {
            let (sine, cosine) = libm::sincos(longitude);
            let (up, across) = libm::sincos(latitude);
            let (tilt, level) = libm::sincos(obliquity);
            let (turn, straight) = libm::sincos(arguments.sidereal);
            let x = across * cosine;
            let y = level * across * sine - tilt * up;
            let z = tilt * across * sine + level * up;
            Vector3::new(straight * x + turn * y, straight * y - turn * x, z) * distance
        };
        let (longitude, distance) = sun(&arguments);
        let sun = earth_fixed(longitude, 0.0, distance);
        let (longitude, latitude, distance) = moon(&arguments);
        Self { sun, moon: earth_fixed(longitude, latitude, distance) }
    }
}

/// The longitude (rad) and distance (m) of the Sun: an ellipse (Meeus 1998, chapter 25).
fn sun(arguments: &Arguments) -> (f64, f64) {
    let Arguments { centuries: t, sun_anomaly, .. } = *arguments;
    let centre = (1.914_602 - 0.004_817 * t) * sin(sun_anomaly)
        + (0.019_993 - 0.000_101 * t) * sin(2.0 * sun_anomaly)
        + 0.000_289 * sin(3.0 * sun_anomaly);
    let centre = centre.to_radians();
    let eccentricity = 0.016_708_634 - 0.000_042_037 * t;
    let distance = 1.000_001_018 * (1.0 - eccentricity * eccentricity)
        / (1.0 + eccentricity * cos(sun_anomaly + centre));
    (arguments.sun_longitude() + centre, distance * ASTRONOMICAL_UNIT)
}

/// The longitude and latitude (rad) and distance (m) of the Moon.
fn moon(arguments: &Arguments) -> (f64, f64, f64) {
    let angles = [
        arguments.elongation,
        arguments.sun_anomaly,
        arguments.moon_anomaly,
        arguments.node_distance,
    ]
    .map(Turn::of);
    let mut longitude = 0.0;
    let mut distance = 385_000_560.0;
    for (multiples, along, away) in LONGITUDE_AND_DISTANCE {
        let turn = Turn::sum(&multiples, &angles);
        longitude += along * turn.sine;
        distance += away * turn.cosine;
    }
    let north = |(multiples, north): &([i8; 4], f64)| north * Turn::sum(multiples, &angles).sine;
    let latitude: f64 = LATITUDE.iter().map(north).sum();
    let radians = |millionths: f64| (millionths * 1e-6).to_radians();
    (arguments.moon_longitude() + radians(longitude), radians(latitude), distance)
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::Bodies;
    use crate::GpsTime;

    /// Computed with ERFA 2.0.1 (`epv00`, `moon98` and `c2t06a` without polar motion).
    #[test]
    fn sun_and_moon_as_erfa_has_them() {
        for (time, ut1_minus_gps, sun, moon) in [
            (
                GpsTime::new(59_025, 43_200.0),
                -18.24,
                [139_590_068_208.0, 1_888_557_656.0, 60_306_915_785.0],
                [196_200_975.0, 300_441_013.0, 107_607_177.0],
            ),
            (
                GpsTime::new(54_613, 0.0),
                -14.39,
                [-141_194_240_764.0, 1_610_213_247.0, 55_122_981_542.0],
                [64_452_657.0, 373_922_112.0, -93_385_042.0],
            ),
        ] {
            let (sun, moon) = (Vector3::<f64>::from(sun), Vector3::<f64>::from(moon));
            let bodies = Bodies::at(time, ut1_minus_gps);
            let off = |found: Vector3<f64>, expected: Vector3<f64>| {
                (found.angle(&expected).to_degrees(), found.norm() / expected.norm() - 1.0)
            };
            let (angle, distance) = off(bodies.sun, sun);
            assert!(angle < 0.012 && distance.abs() < 1e-4, "{angle} {distance}");
            let (angle, distance) = off(bodies.moon, moon);
            assert!(angle < 0.04 && distance.abs() < 2e-4, "{angle} {distance}");
        }
    }
}
