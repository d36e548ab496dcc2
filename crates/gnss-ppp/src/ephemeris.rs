//! Orbits and clocks from broadcast ephemerides.

use crate::constants::EARTH_ROTATION;
use crate::{Constellation, GpsTime, OrbitState};
use nalgebra::Vector3;

/// The number of Newton steps for Kepler's equation: two suffice for orbits of navigation satellites, four for e = 0.6.
const STEPS: usize = 6;

/// An ephemeris as a satellite of GPS, Galileo or BeiDou broadcasts it, in m, s and rad.
///
/// Positions follow IS-GPS-200, table 20-IV, which the Galileo OS SIS ICD shares (5.1.1), and, with other constants,
/// BDS-SIS-ICD-B1I (ephemeris parameters) for BeiDou satellites that are not geostationary. They are those of the phase
/// centre of the satellite's antenna, not of its centre of mass. The documents' symbols are given with each field.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ephemeris {
    /// The satellite system, which determines the constants.
    pub constellation: Constellation,
    /// The reference time of the orbit, in GPS time: toe.
    pub time: GpsTime,
    /// The reference time of the clock: toc.
    pub clock_time: GpsTime,
    /// The satellite's clock minus the time of its system, s, s/s and s/s², without the relativistic effect of the
    /// orbit's eccentricity: af0, af1, af2. For Galileo and BeiDou it is that of the two carriers that are observed.
    pub clock: [f64; 3],
    /// The issue number, by which corrections refer to it: IODE or `IODnav`.
    pub issue: u16,
    /// By how much the clock is ahead of that of the first carrier alone, s: `TGD` or `BGD`.
    pub group_delay: f64,
    /// The square root of the semi-major axis, √m: √A.
    pub root_of_axis: f64,
    /// Eccentricity: e.
    pub eccentricity: f64,
    /// Mean anomaly: M0.
    pub mean_anomaly: f64,
    /// Correction of the mean motion, rad/s: Δn.
    pub mean_motion_correction: f64,
    /// Argument of perigee: ω.
    pub perigee: f64,
    /// Longitude of the ascending node at the beginning of the week: Ω0.
    pub node: f64,
    /// The rate of the ascending node's longitude, rad/s: Ω̇.
    pub node_rate: f64,
    /// Inclination: i0.
    pub inclination: f64,
    /// The rate of the inclination, rad/s: IDOT.
    pub inclination_rate: f64,
    /// Cosine and sine terms of the argument of latitude, rad: Cuc, Cus.
    pub latitude_terms: [f64; 2],
    /// Cosine and sine terms of the radius, m: Crc, Crs.
    pub radius_terms: [f64; 2],
    /// Cosine and sine terms of the inclination, rad: Cic, Cis.
    pub inclination_terms: [f64; 2],
    /// The standard deviation of a range from this ephemeris, m: URA or SISA.
    pub accuracy: f64,
    /// How long the ephemeris is valid before and after its reference time, s: half the fit interval for GPS.
    pub holds: f64,
}

impl Ephemeris {
    /// Whether the ephemeris is valid at a time.
    pub fn holds_at(&self, time: GpsTime) -> bool {
        time.since(self.time).abs() <= self.holds
    }

    /// The ephemeris of a satellite with the nearest reference time among those valid at `time`.
    pub fn nearest(of_satellite: &[Self], time: GpsTime) -> Option<&Self> {
        let away = |it: &&Self| time.since(it.time).abs();
        of_satellite
            .iter()
            .filter(|it| it.holds_at(time))
            .min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// The satellite's clock minus the time of its system at `time`, s (IS-GPS-200, 20.3.3.3.3.1).
    ///
    /// It does not include the relativistic effect of the orbit's eccentricity
    /// ([`eccentricity_clock`](crate::eccentricity_clock)).
    pub fn clock_at(&self, time: GpsTime) -> f64 {
        let [offset, drift, ageing] = self.clock;
        let elapsed = time.since(self.clock_time);
        offset + elapsed * (drift + elapsed * ageing)
    }

    /// The position and velocity of the phase centre of the satellite's antenna at a time. (IS-GPS-200, table 20-IV.)
    pub fn orbit_at(&self, time: GpsTime) -> OrbitState {
        let elapsed = time.since(self.time);
        let axis = self.root_of_axis * self.root_of_axis;
        let motion = libm::sqrt(self.gravity() / axis) / axis + self.mean_motion_correction;
        let anomaly = kepler(self.mean_anomaly + motion * elapsed, self.eccentricity);
        let (sine, cosine) = libm::sincos(anomaly);
        let minor = libm::sqrt(1.0 - self.eccentricity * self.eccentricity);
        let nearness = 1.0 - self.eccentricity * cosine;
        let argument = libm::atan2(minor * sine, cosine - self.eccentricity) + self.perigee;
        // Rates, 1/s.
        let of_anomaly = motion / nearness;
        let of_argument = of_anomaly * minor / nearness;

        let harmonic = Harmonic::of(argument, of_argument);
        let [latitude, of_latitude] = harmonic.of_terms(self.latitude_terms);
        let [radius, of_radius] = harmonic.of_terms(self.radius_terms);
        let [tilt, of_tilt] = harmonic.of_terms(self.inclination_terms);
        let (radius, of_radius) =
            (axis * nearness + radius, axis * self.eccentricity * sine * of_anomaly + of_radius);
        let of_latitude = of_argument + of_latitude;
        let tilt = self.inclination + self.inclination_rate * elapsed + tilt;
        let of_tilt = self.inclination_rate + of_tilt;
        // Counted in the week of the ephemeris, even after its end.
        let second = self.time.plus(-self.behind()).second_of_week() + elapsed;
        let node = self.node + self.node_rate * elapsed - self.rotation() * second;

        // In the orbital plane, x towards the ascending node.
        let (up, along) = libm::sincos(argument + latitude);
        let (x, y) = (radius * along, radius * up);
        let of_x = of_radius * along - y * of_latitude;
        let of_y = of_radius * up + x * of_latitude;
        // Equatorial coordinates, x still towards the node.
        let (tilt_sine, tilt_cosine) = libm::sincos(tilt);
        let level = y * tilt_cosine;
        let of_level = of_y * tilt_cosine - y * tilt_sine * of_tilt;
        let (node_sine, node_cosine) = libm::sincos(node);
        let turned = |x: f64, y: f64, z: f64| {
            Vector3::new(node_cosine * x - node_sine * y, node_sine * x + node_cosine * y, z)
        };
        OrbitState {
            position: turned(x, level, y * tilt_sine),
            velocity: turned(
                of_x - level * self.node_rate,
                of_level + x * self.node_rate,
                of_y * tilt_sine + y * tilt_cosine * of_tilt,
            ),
        }
    }

    /// The geocentric gravitational constant that the message assumes, m³/s².
    const fn gravity(&self) -> f64 {
        match self.constellation {
            Constellation::Gps => 3.986_005e14,
            Constellation::Galileo | Constellation::Glonass | Constellation::BeiDou => {
                3.986_004_418e14
            }
        }
    }

    /// The rotation rate of the Earth that the message assumes, rad/s.
    const fn rotation(&self) -> f64 {
        match self.constellation {
            Constellation::BeiDou => 7.292_115_0e-5,
            _ => EARTH_ROTATION,
        }
    }

    /// By how much the system's week begins later than that of GPS, s.
    const fn behind(&self) -> f64 {
        match self.constellation {
            Constellation::BeiDou => GpsTime::BEIDOU_BEHIND,
            _ => 0.0,
        }
    }
}

/// The cosine and sine of twice the argument of latitude, and the rate of that angle.
#[derive(Clone, Copy, Debug)]
struct Harmonic {
    sine: f64,
    cosine: f64,
    rate: f64,
}

impl Harmonic {
    fn of(argument: f64, rate: f64) -> Self {
        let (sine, cosine) = libm::sincos(2.0 * argument);
        Self { sine, cosine, rate: 2.0 * rate }
    }

    /// The sum of a cosine and a sine term, and its rate.
    fn of_terms(&self, [cosine, sine]: [f64; 2]) -> [f64; 2] {
        [
            cosine * self.cosine + sine * self.sine,
            (sine * self.cosine - cosine * self.sine) * self.rate,
        ]
    }
}

/// The eccentric anomaly of a mean anomaly.
fn kepler(mean: f64, eccentricity: f64) -> f64 {
    let mut anomaly = mean;
    for _ in 0..STEPS {
        let (sine, cosine) = libm::sincos(anomaly);
        anomaly -= (anomaly - eccentricity * sine - mean) / (1.0 - eccentricity * cosine);
    }
    anomaly
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{carried_along, eccentricity_clock};

    /// The ephemeris that G01 broadcast for 4 o'clock on 25 June 2020, from the station ESBC.
    fn real() -> Ephemeris {
        let time = GpsTime::new_in_day(59_025, 14_400.0);
        Ephemeris {
            constellation: Constellation::Gps,
            time,
            clock_time: time,
            clock: [1.604_342_833_161e-5, 7.048_583_938_740e-12, 0.0],
            issue: 0,
            group_delay: 5.122_274_160_385e-9,
            root_of_axis: 5_153.707_128_525,
            eccentricity: 1.000_394_229_777e-2,
            mean_anomaly: 0.634_209_450_786_4,
            mean_motion_correction: 4.304_822_170_265e-9,
            perigee: 0.794_170_301_500_8,
            node: 2.572_838_528_869,
            node_rate: -8.384_634_967_987e-9,
            inclination: 0.980_651_860_109_1,
            inclination_rate: -5.714_523_747_137e-11,
            latitude_terms: [-2.177_432_179_451e-6, 1.937_150_955_200e-6],
            radius_terms: [353.968_75, -39.687_5],
            inclination_terms: [-1.508_742_570_877e-7, 1.359_730_958_939e-7],
            accuracy: 2.0,
            holds: 7_200.0,
        }
    }

    #[test]
    fn the_velocity_is_that_of_the_position() {
        let ephemeris = real();
        for second in [-7_000.0, 0.0, 3_000.0] {
            let at = ephemeris.time.plus(second);
            let half = 0.5;
            let [before, after] = [-half, half].map(|away| {
                // In the ECEF axes of the middle instant.
                carried_along(&ephemeris.orbit_at(at.plus(away)).position, -away)
            });
            let velocity = (after - before) / (2.0 * half);
            let state = ephemeris.orbit_at(at);
            assert!((state.velocity - velocity).norm() < 1e-4, "{velocity} {}", state.velocity);
            // F·e·√A·sin E of the interface specification, which leaves out the harmonics: 2 cm.
            let motion = libm::sqrt(ephemeris.gravity()) / ephemeris.root_of_axis.powi(3);
            let anomaly = kepler(ephemeris.mean_anomaly + motion * second, ephemeris.eccentricity);
            let told = -4.442_807_633e-10
                * ephemeris.eccentricity
                * ephemeris.root_of_axis
                * libm::sin(anomaly);
            let found = eccentricity_clock(&state.position, &state.velocity);
            assert!((found - told).abs() < 7e-11, "{found} {told}");
        }
    }

    #[test]
    fn a_week_that_is_over_changes_nothing() {
        // Saturday, ten minutes before midnight.
        let saturday = GpsTime::new(59_027, 85_800.0);
        let ephemeris = Ephemeris { time: saturday, ..real() };
        let [before, after] =
            [599.5, 600.5].map(|second| ephemeris.orbit_at(saturday.plus(second)).position);
        assert!((after - before).norm() < 4_000.0);
    }

    /// The same elements as those of a BeiDou satellite: the week begins 14 s later, and the Earth's rotation rate
    /// differs.
    #[test]
    fn of_beidou_the_week_and_the_constants_are_its_own() {
        let of = |constellation| Ephemeris { constellation, ..real() };
        let [galileo, beidou] = [Constellation::Galileo, Constellation::BeiDou].map(of);
        for second in [-3_000.0, 0.0, 3_000.0] {
            let at = galileo.time.plus(second);
            let turned = galileo.orbit_at(at).position;
            let since = 4.0 * 86_400.0 + 14_400.0 + second;
            let angle = EARTH_ROTATION * since - 7.292_115e-5 * (since - 14.0);
            let expected = carried_along(&turned, -angle / EARTH_ROTATION);
            let found = beidou.orbit_at(at).position;
            assert!((found - expected).norm() < 1e-3, "{found} {expected}");
            assert!((found - turned).norm() > 1e4);
        }
    }

    #[test]
    fn the_nearest_that_holds_is_taken() {
        let first = real();
        let later = Ephemeris { time: first.time.plus(7_200.0), ..first };
        let all = [first, later];
        let at = |second| Ephemeris::nearest(&all, first.time.plus(second)).copied();
        assert_eq!(at(-7_200.0), Some(first));
        assert_eq!((at(3_500.0), at(3_700.0)), (Some(first), Some(later)));
        assert_eq!((at(-7_201.0), at(14_401.0), at(f64::NAN)), (None, None, None));
    }

    #[test]
    fn a_clock_is_a_parabola() {
        let clock = [1e-4, 1e-11, 1e-18];
        let ephemeris = Ephemeris { clock, clock_time: real().time.plus(-100.0), ..real() };
        let expected = 1e-4 + 1e-9 + 1e-14;
        assert!((ephemeris.clock_at(ephemeris.time) - expected).abs() < 1e-20);
    }
}
