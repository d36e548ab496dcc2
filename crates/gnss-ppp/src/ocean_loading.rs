use core::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use crate::GpsTime;
use crate::astronomy::Arguments;

/// Multiples of solar time, s, h and p of the waves and a phase in quarter turns, by the convention of
/// Schwiderski to which BLQ files refer (IERS Conventions 2010, ARG2).
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

/// How the tides of the oceans move one station: eleven waves, as a BLQ file lists them
/// (M2 S2 N2 K2 K1 O1 P1 Q1 Mf Mm Ssa).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OceanLoading {
    /// Amplitudes, m: radially up, tangentially west, tangentially south.
    pub amplitude: [[f64; 11]; 3],
    /// Phase lags behind Greenwich, degrees, in the same order.
    pub lag: [[f64; 11]; 3],
}

impl OceanLoading {
    /// The station's displacement east, north and up, m; `ut1_minus_gps` (s) as for
    /// [`greenwich_sidereal_time`](crate::greenwich_sidereal_time).
    ///
    /// The sum of the eleven waves alone. Their side lobes, above all the nodal ones over 18.6 years, are
    /// left out: a tenth of the displacement, a millimetre or two on the worst coasts.
    pub fn displacement(&self, time: GpsTime, ut1_minus_gps: f64) -> Vector3<f64> {
        let angles = angles(&Arguments::at(time, ut1_minus_gps));
        let component = |amplitude: &[f64; 11], lag: &[f64; 11]| -> f64 {
            amplitude
                .iter()
                .zip(lag)
                .zip(angles)
                .map(|((amplitude, lag), angle)| amplitude * libm::cos(angle - lag.to_radians()))
                .sum()
        };
        let [up, west, south] = &self.amplitude;
        let [up_lag, west_lag, south_lag] = &self.lag;
        Vector3::new(
            -component(west, west_lag),
            -component(south, south_lag),
            component(up, up_lag),
        )
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
