use nalgebra::Vector3;

use crate::GpsTime;
use crate::solid_tide::Station;
use crate::trigonometry::Turn;

/// The length of a year, days.
const YEAR: f64 = 365.25;
/// The secular pole of 2000, mas, and its change per year (update of 2018 to section 7.1.4).
const SECULAR: [[f64; 2]; 2] = [[55.0, 1.677], [320.5, 3.460]];

/// The displacement of a station at `position` (ECEF, m) by the pole tide, ECEF, m: up to 25 mm in height and 7 mm
/// horizontally.
///
/// The Earth's rotation axis moves relative to its crust, and the changing centrifugal force deforms the Earth. `pole`
/// is the position of the pole: x towards Greenwich, y towards 90° west, rad, as in Earth rotation files. IERS
/// Conventions 2010, section 7.1.4 (7.26), relative to the secular pole.
///
/// Add it to coordinates of the ITRF or the IGS. Zero at the Earth's centre.
pub fn pole_tide(position: &Vector3<f64>, pole: [f64; 2], time: GpsTime) -> Vector3<f64> {
    let Some(station) = Station::at(position) else { return Vector3::zeros() };
    let years = time.days_since_j2000(0.0) / YEAR;
    let [x, y] = pole.map(|angle| angle.to_degrees() * 3600.0);
    let [secular_x, secular_y] = SECULAR.map(|[mean, rate]| (mean + rate * years) / 1000.0);
    let (m1, m2) = (x - secular_x, secular_y - y);
    let Station { sine: sine_of_latitude, cosine: cosine_of_latitude, .. } = station;
    let Turn { sine, cosine } = station.longitude;
    let along = m1 * cosine + m2 * sine;
    let across = m1 * sine - m2 * cosine;
    // (7.26), m for arcseconds, with the latitude in place of the colatitude.
    let up = -0.066 * sine_of_latitude * cosine_of_latitude * along;
    let double = sine_of_latitude * sine_of_latitude - cosine_of_latitude * cosine_of_latitude;
    let north = 0.009 * double * along;
    let east = 0.009 * sine_of_latitude * across;
    station.displacement(up, north, east)
}

#[cfg(test)]
mod tests {
    use super::pole_tide;
    use crate::GpsTime;
    use nalgebra::Vector3;

    /// Computed with numpy from the formula, with the colatitude on a sphere.
    #[test]
    fn as_elsewhere() {
        let pole = [0.156_804_f64, 0.417_332].map(|seconds| (seconds / 3600.0).to_radians());
        let time = GpsTime::new(61_162, 0.0);
        for (position, expected) in [
            (
                [3_582_105.0, 532_590.0, 5_232_755.0],
                [-1.136_890_209, -0.063_230_745, -1.325_302_558],
            ),
            (
                [-4_490_605.0, 3_483_895.0, 2_884_928.0],
                [-0.904_394_064, 0.542_786_708, 0.823_847_230],
            ),
            (
                [-5_000_000.0, -1_000_000.0, -3_000_000.0],
                [1.245_421_872, 0.170_335_162, 1.019_170_624],
            ),
        ] {
            let moved = 1e3 * pole_tide(&Vector3::from(position), pole, time);
            assert!((moved - Vector3::from(expected)).norm() < 1e-6, "{moved}");
        }
    }

    /// A pole at its secular position moves nothing, nor is anything displaced at the Earth's centre or on the axis.
    #[test]
    fn nothing_moves() {
        let noon = GpsTime::new(51_544, 43_200.0);
        let secular = [0.055_f64, 0.320_5].map(|seconds| (seconds / 3600.0).to_radians());
        let place = Vector3::new(3_582_105.0, 532_590.0, 5_232_755.0);
        assert!(pole_tide(&place, secular, noon).norm() < 1e-12);
        assert_eq!(pole_tide(&Vector3::zeros(), [1e-6; 2], noon), Vector3::zeros());
        let at_pole = pole_tide(&Vector3::new(0.0, 0.0, 6_356_752.0), [1e-6; 2], noon);
        assert!(at_pole.z.abs() < 1e-12 && at_pole.norm() < 0.003);
        assert!(!pole_tide(&place, [f64::NAN, 0.0], noon).norm().is_finite());
    }
}
