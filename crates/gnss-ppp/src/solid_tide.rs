use nalgebra::Vector3;

use crate::astronomy::Arguments;
use crate::constants::{EARTH_RADIUS, MOON_TO_EARTH_MASS, SUN_TO_EARTH_MASS};
use crate::trigonometry::Turn;
use crate::{Bodies, GpsTime};

/// The displacement by the diurnal tides beyond the nominal Love numbers, mm (IERS Conventions 2010, table 7.3a):
/// multiples of τ, s, h, p, N′ and p₁, then radial in phase and out of phase, transverse in phase and out of phase.
const DIURNAL: [([i8; 6], [f64; 4]); 11] = [
    ([1, -2, 0, 1, 0, 0], [-0.08, 0.00, -0.01, 0.01]),
    ([1, -1, 0, 0, -1, 0], [-0.10, 0.00, 0.00, 0.00]),
    ([1, -1, 0, 0, 0, 0], [-0.51, 0.00, -0.02, 0.03]),
    ([1, 0, 0, 1, 0, 0], [0.06, 0.00, 0.00, 0.00]),
    ([1, 1, -3, 0, 0, 1], [-0.06, 0.00, 0.00, 0.00]),
    ([1, 1, -2, 0, 0, 0], [-1.23, -0.07, 0.06, 0.01]),
    ([1, 1, 0, 0, -1, 0], [-0.22, 0.01, 0.01, 0.00]),
    ([1, 1, 0, 0, 0, 0], [12.00, -0.80, -0.67, -0.03]),
    ([1, 1, 0, 0, 1, 0], [1.73, -0.12, -0.10, 0.00]),
    ([1, 1, 1, 0, 0, -1], [-0.50, -0.01, 0.03, 0.00]),
    ([1, 1, 2, 0, 0, 0], [-0.11, 0.01, 0.01, 0.00]),
];
/// The displacement by the long-period tides beyond the nominal Love numbers, mm, in the layout of [`DIURNAL`] (table
/// 7.3b).
const LONG_PERIOD: [([i8; 6], [f64; 4]); 5] = [
    ([0, 0, 0, 0, 1, 0], [0.47, 0.16, 0.23, 0.07]),
    ([0, 0, 2, 0, 0, 0], [-0.20, -0.11, -0.12, -0.05]),
    ([0, 1, 0, -1, 0, 0], [-0.11, -0.09, -0.08, -0.04]),
    ([0, 2, 0, 0, 0, 0], [-0.13, -0.15, -0.11, -0.07]),
    ([0, 2, 0, 0, 1, 0], [-0.05, -0.06, -0.05, -0.03]),
];

/// The displacement of a station at `position` (ECEF, m) by the solid Earth tides, ECEF, m: up to 0.4 m.
///
/// The model of the IERS Conventions 2010, section 7.1.1: tides of degree 2 and 3 from the Sun and the Moon
/// with the Love and Shida numbers' dependence on latitude and their imaginary parts (step 1), and the
/// corrections to the diurnal and long-period waves (step 2). On the test cases of the Conventions' program it
/// agrees to 0.09 mm.
///
/// Add it to coordinates of the ITRF or the IGS. These are conventionally free of tides, including the permanent one,
/// which the displacement therefore contains. The pole tide is another effect: [`pole_tide`](crate::pole_tide()).
///
/// `bodies` belong to the same instant. Zero at the Earth's centre.
pub fn solid_tide(
    position: &Vector3<f64>,
    bodies: &Bodies,
    time: GpsTime,
    ut1_minus_gps: f64,
) -> Vector3<f64> {
    let Some(station) = Station::at(position) else { return Vector3::zeros() };
    let from_sun = station.step_1(&bodies.sun, SUN_TO_EARTH_MASS);
    let from_moon = station.step_1(&bodies.moon, MOON_TO_EARTH_MASS);
    from_sun + from_moon + station.step_2(&Arguments::at(time, ut1_minus_gps))
}

/// The local directions of a place on a sphere, and its geocentric latitude.
pub(crate) struct Station {
    up: Vector3<f64>,
    north: Vector3<f64>,
    east: Vector3<f64>,
    /// The unit vector from the Earth's axis into the station's meridian.
    outward: Vector3<f64>,
    pub(crate) sine: f64,
    pub(crate) cosine: f64,
    pub(crate) longitude: Turn,
}

impl Station {
    pub(crate) fn at(position: &Vector3<f64>) -> Option<Self> {
        let up = position.try_normalize(f64::MIN_POSITIVE)?;
        let (sine, cosine) = (up.z, libm::hypot(up.x, up.y));
        // At a pole any meridian will do.
        let longitude = if cosine > 0.0 {
            Turn { sine: up.y / cosine, cosine: up.x / cosine }
        } else {
            Turn::NONE
        };
        let outward = Vector3::new(longitude.cosine, longitude.sine, 0.0);
        let east = Vector3::new(-longitude.sine, longitude.cosine, 0.0);
        let north = up.cross(&east);
        Some(Self { up, north, east, outward, sine, cosine, longitude })
    }

    pub(crate) fn displacement(&self, up: f64, north: f64, east: f64) -> Vector3<f64> {
        self.up * up + self.north * north + self.east * east
    }

    /// The displacement by one body, in the time domain.
    fn step_1(&self, body: &Vector3<f64>, mass: f64) -> Vector3<f64> {
        let Some(direction) = body.try_normalize(f64::MIN_POSITIVE) else {
            return Vector3::zeros();
        };
        let Self { sine, cosine, .. } = *self;
        let ratio = EARTH_RADIUS / body.norm();
        let degree_2 = mass * EARTH_RADIUS * ratio * ratio * ratio;
        let degree_3 = degree_2 * ratio;

        // Degree 2 (7.5) and degree 3 (7.6); the component along the body has the coefficient `towards`.
        let zonal = 1.5 * sine * sine - 0.5;
        let (h2, l2) = (0.6078 - 0.0006 * zonal, 0.0847 + 0.0002 * zonal);
        let (h3, l3) = (0.292, 0.015);
        let x = direction.dot(&self.up);
        let towards = degree_2 * 3.0 * l2 * x + degree_3 * l3 * (7.5 * x * x - 1.5);
        let up = degree_2 * h2 * (1.5 * x * x - 0.5) + degree_3 * h3 * x * (2.5 * x * x - 1.5);
        let nominal = direction * towards + self.up * (up - towards * x);

        // The body's direction along the station's meridian, to its east and along the Earth's axis.
        let p = direction.dot(&self.outward);
        let q = direction.dot(&self.east);
        let s = direction.z;
        let (along, across) = (p * p - q * q, p * q);
        let double = cosine * cosine - sine * sine;

        // Imaginary parts of the diurnal (7.10) and the semidiurnal (7.11) Love numbers.
        let (h, l) = (-0.0025, -0.0007);
        let mut up = 3.0 * h * sine * cosine * s * q;
        let mut north = 3.0 * l * double * s * q;
        let mut east = -3.0 * l * sine * s * p;
        let (h, l) = (-0.0022, -0.0007);
        up += 1.5 * h * cosine * cosine * across;
        north -= 3.0 * l * sine * cosine * across;
        east -= 1.5 * l * cosine * along;

        // The toroidal parts l⁽¹⁾, diurnal (7.8) and semidiurnal (7.9).
        let l = 0.0012;
        north -= 3.0 * l * sine * sine * s * p;
        east -= 3.0 * l * sine * double * s * q;
        let l = 0.0024;
        north -= 1.5 * l * sine * cosine * along;
        east += 3.0 * l * sine * sine * cosine * across;
        nominal + self.displacement(up, north, east) * degree_2
    }

    /// Corrections in the frequency domain (7.12 and 7.13).
    fn step_2(&self, arguments: &Arguments) -> Vector3<f64> {
        let Self { sine, cosine, .. } = *self;
        let (waves, longitude) = (doodson(arguments), self.longitude);
        let mut total = [0.0; 3];
        for (multiples, [radial, radial_out, transverse, transverse_out]) in DIURNAL {
            let Turn { sine: s, cosine: c } = Turn::sum(&multiples, &waves).plus(longitude);
            let [up, north, east] = &mut total;
            *up += 2.0 * sine * cosine * (radial * s + radial_out * c);
            *north += (cosine * cosine - sine * sine) * (transverse * s + transverse_out * c);
            *east += sine * (transverse * c - transverse_out * s);
        }
        for (multiples, [radial, radial_out, transverse, transverse_out]) in LONG_PERIOD {
            let Turn { sine: s, cosine: c } = Turn::sum(&multiples, &waves);
            let [up, north, _] = &mut total;
            *up += (1.5 * sine * sine - 0.5) * (radial * c + radial_out * s);
            *north += 2.0 * sine * cosine * (transverse * c + transverse_out * s);
        }
        let [up, north, east] = total.map(|millimetres| millimetres * 1e-3);
        self.displacement(up, north, east)
    }
}

/// Doodson's arguments, whose multiples add up to those of the waves; N′ is minus the longitude of the Moon's node.
fn doodson(arguments: &Arguments) -> [Turn; 6] {
    let moon_and_sun =
        [arguments.lunar_time(), arguments.moon_longitude(), arguments.sun_longitude()];
    let [tau, s, h] = moon_and_sun.map(Turn::of);
    let [p, n, p1] = [arguments.perigee(), -arguments.node, arguments.sun_perigee()].map(Turn::of);
    [tau, s, h, p, n, p1]
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::solid_tide;
    use crate::{Bodies, GpsTime};

    /// The test cases of the IERS program DEHANTTIDEINEL, at midnight UTC; the fourth, with the Sun at a tenth of its
    /// distance, is omitted.
    #[test]
    fn the_test_cases_of_the_conventions() {
        for (day, leap, position, sun, moon, expected) in [
            (
                54_934,
                15.0,
                [4_075_578.385, 931_852.890, 4_801_570.154],
                [137_859_926_952.015, 54_228_127_881.435_0, 23_509_422_341.696_0],
                [-179_996_231.920_342, -312_468_450.131_567, -169_288_918.592_160],
                [0.077_004_203_571_081_26, 0.063_040_563_218_249_68, 0.055_165_681_525_972_47],
            ),
            (
                56_121,
                16.0,
                [1_112_189.660, -4_842_955.026, 3_985_352.284],
                [-54_537_460_436.235_7, 130_244_288_385.279, 56_463_429_031.599_6],
                [300_396_716.912, 243_238_281.451, 120_548_075.939],
                [-0.020_368_314_795_920_76, 0.056_582_547_762_259_72, -0.075_976_796_768_717_42],
            ),
            (
                57_218,
                17.0,
                [1_112_200.569_6, -4_842_957.851_1, 3_985_345.912_2],
                [100_210_282_451.627_9, 103_055_630_398.316, 56_855_096_480.447_5],
                [369_817_604.434_8, 1_897_917.525_8, 120_804_980.828_4],
                [0.005_095_708_691_723_638, 0.082_866_302_598_352_87, -0.063_663_492_540_418_96],
            ),
        ] {
            let bodies = Bodies { sun: sun.into(), moon: moon.into() };
            let tide = solid_tide(&position.into(), &bodies, GpsTime::new(day, leap), -leap);
            let error = (tide - Vector3::from(expected)).norm();
            assert!(error < 0.9e-4, "{error}");
        }
    }

    #[test]
    fn poles_and_the_centre_are_finite() {
        let time = GpsTime::new(59_025, 0.0);
        let bodies = Bodies::at(time, -18.0);
        let nowhere = Bodies { sun: Vector3::zeros(), moon: Vector3::zeros() };
        assert_eq!(solid_tide(&Vector3::zeros(), &bodies, time, -18.0), Vector3::zeros());
        for bodies in [bodies, nowhere] {
            let tide = solid_tide(&(Vector3::z() * 6.4e6), &bodies, time, -18.0);
            assert!(tide.norm() < 0.5, "{tide:?}");
        }
    }
}
