use core::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use crate::GpsTime;
use crate::astronomy::Arguments;
use crate::trigonometry::cos;

/// The multiples of solar time, s, h and p of the waves, and a phase in quarter turns, by the convention of Schwiderski
/// to which BLQ files refer (IERS Conventions 2010, section 7.1.2).
const WAVES: [[i8; 5]; 11] = [
    [2, -2, 2, 0, 0],
    [2, 0, 0, 0, 0],
    [2, -3, 2, 1, 0],
    [2, 0, 2, 0, 0],
    [1, 0, 1, 0, 1],
    [1, -2, 1, 0, -1],
    [1, 0, -1, 0, -1],
    [1, -3, 1, 1, -1],
    [0, 2, 0, 0, 0],
    [0, 1, 0, -1, 0],
    [0, 0, 2, 0, 0],
];

/// The displacement of a station by ocean tide loading: eleven waves, as listed in a BLQ file (M2 S2 N2 K2 K1 O1 P1 Q1
/// Mf Mm Ssa).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OceanLoading {
    /// Amplitudes, m: radially up, tangentially west, tangentially south.
    pub amplitude: [[f64; 11]; 3],
    /// Phase lags behind Greenwich, degrees: radially up, tangentially west, tangentially south.
    pub lag: [[f64; 11]; 3],
}

impl OceanLoading {
    /// The station's displacement east, north and up, m; `ut1_minus_gps` (s) as for
    /// [`greenwich_sidereal_time`](crate::greenwich_sidereal_time).
    ///
    /// Only the sum of the eleven waves. Their side lobes, above all the nodal ones over 18.6 years, are omitted: a
    /// tenth of the displacement, a millimetre or two on the worst coasts.
    pub fn displacement(&self, time: GpsTime, ut1_minus_gps: f64) -> Vector3<f64> {
        let angles = angles(&Arguments::at(time, ut1_minus_gps));
        let mut moved = [0.0; 3];
        for ((moved, amplitudes), lags) in moved.iter_mut().zip(&self.amplitude).zip(&self.lag) {
            for ((amplitude, lag), angle) in amplitudes.iter().zip(lags).zip(angles) {
                *moved += amplitude * cos(angle - lag.to_radians());
            }
        }
        let [up, west, south] = moved;
        Vector3::new(-west, -south, up)
    }
}

/// The waves' angles at Greenwich, rad.
fn angles(arguments: &Arguments) -> [f64; 11] {
    let time = arguments.solar_time();
    let (moon, sun) = (arguments.moon_longitude(), arguments.sun_longitude());
    let perigee = arguments.perigee();
    WAVES.map(|[t, s, h, p, quarters]| {
        f64::from(t) * time
            + f64::from(s) * moon
            + f64::from(h) * sun
            + f64::from(p) * perigee
            + f64::from(quarters) * FRAC_PI_2
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{OceanLoading, angles};
    use crate::GpsTime;
    use crate::astronomy::Arguments;

    /// The test case of the IERS program ARG2, 6 November 2008 at noon. Its Sun is older, and apparent: they differ by
    /// the 100 µrad of aberration, a micrometre of tide.
    #[test]
    fn the_test_case_of_the_conventions() {
        let expected = [
            2.849_663_065_753_788,
            6.283_180_8,
            4.926_040_134_021_299,
            1.608_450_491_115_348_8,
            2.375_021_572_352_622_5,
            0.474_641_493_398_095_8,
            3.908_159_227_647_346,
            2.551_018_561_669_245_3,
            5.041_990_012_540_758,
            4.206_816_878_908_015,
            1.608_463_638_294_885_8,
        ];
        let arguments = Arguments::at(GpsTime::new(54_776, 43_200.0 + 14.0), -14.0);
        for (angle, expected) in angles(&arguments).into_iter().zip(expected) {
            let difference = libm::remainder(angle - expected, core::f64::consts::TAU);
            assert!(difference.abs() < 2.5e-4, "{difference}");
        }
    }

    /// Where the wave's angle equals its lag, the station is displaced by the amplitude.
    #[test]
    fn up_west_and_south_with_their_lags() {
        let time = GpsTime::new(59_025, 4_321.0);
        let [m2, ..] = angles(&Arguments::at(time, -18.0));
        let mut loading = OceanLoading { amplitude: [[0.0; 11]; 3], lag: [[0.0; 11]; 3] };
        for (component, shift) in [0.0, 60.0, 180.0].into_iter().enumerate() {
            loading.amplitude[component][0] = 1e-3;
            loading.lag[component][0] = m2.to_degrees() + shift;
        }
        let displacement = loading.displacement(time, -18.0);
        assert!((displacement - Vector3::new(-0.5e-3, 1e-3, 1e-3)).norm() < 1e-12);
    }
}
