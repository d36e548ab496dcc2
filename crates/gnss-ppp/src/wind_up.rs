use nalgebra::{Matrix3, Vector3};

use crate::BodyAxes;

/// The carrier-phase wind-up, in cycles: the phase added by the rotation of the satellite's antenna relative to the
/// receiver's (Wu et al. 1993). Subtract that many wavelengths from the measured phase.
///
/// `receiver_enu_from_ecef` gives the orientation of the receiver's antenna, whose dipoles point north and west, and
/// `sight` is the ECEF unit vector from receiver to satellite. With the result of the preceding epoch as `previous` the
/// phase is continuous over whole turns; without it, it lies within half a cycle of zero. Where it is undefined (a
/// satellite at the antenna's nadir, numbers that are not finite) it stays at `previous`, or zero.
pub fn wind_up(
    axes: &BodyAxes,
    receiver_enu_from_ecef: &Matrix3<f64>,
    sight: &Vector3<f64>,
    previous: Option<f64>,
) -> f64 {
    let previous = previous.filter(|cycles| cycles.is_finite());
    let ray = -sight;
    let east = receiver_enu_from_ecef.row(0).transpose();
    let north = receiver_enu_from_ecef.row(1).transpose();
    let satellite = dipole(&axes.x, &ray) - ray.cross(&axes.y);
    let receiver = dipole(&north, &ray) - ray.cross(&east);
    // atan2 of sine and cosine does not lose digits where the two dipoles are nearly aligned.
    let sine = ray.dot(&satellite.cross(&receiver));
    let cosine = satellite.dot(&receiver);
    let fraction = libm::atan2(sine, cosine) / core::f64::consts::TAU;
    if !fraction.is_finite() || libm::hypot(sine, cosine) < 1e-12 {
        return previous.unwrap_or(0.0);
    }
    let turns = previous.map_or(0.0, |previous| libm::round(previous - fraction));
    fraction + turns
}

/// The component of a dipole perpendicular to the ray.
fn dipole(axis: &Vector3<f64>, ray: &Vector3<f64>) -> Vector3<f64> {
    axis - ray * ray.dot(axis)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::TAU;

    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::wind_up;
    use crate::{BodyAxes, Geodetic};

    const SATELLITE: Vector3<f64> = Vector3::new(-886_542.0, -17_837_767.0, -19_658_629.0);

    fn axes() -> BodyAxes {
        BodyAxes::nominal(&SATELLITE, &Vector3::new(-1.1e11, 0.87e11, -0.53e11)).unwrap()
    }

    fn receiver() -> (Matrix3<f64>, Vector3<f64>) {
        let place = Geodetic { latitude: -1.0, longitude: -2.7, height: 100.0 };
        (place.enu_from_ecef(), (SATELLITE - place.to_ecef()).normalize())
    }

    /// Computed with mpmath from the formulas of Wu et al.
    #[test]
    fn as_wu_and_others_have_it() {
        let (enu, sight) = receiver();
        let cycles = wind_up(&axes(), &enu, &sight, None);
        assert!((cycles - 0.219_446_131_576_440_52).abs() < 1e-12, "{cycles}");
        let later = wind_up(&axes(), &enu, &sight, Some(2.9));
        assert!(
            (later - cycles - 3.0).abs() < 1e-12 || (later - cycles - 2.0).abs() < 1e-12,
            "{later}"
        );
        assert!((later - 2.9).abs() <= 0.5);
    }

    /// The field of a right-handed wave turns clockwise seen from its source. A receiver below the satellite that turns
    /// with it, from north over east, sees each cycle later: its phase grows, as with the range. The same happens if
    /// the satellite turns in the opposite sense.
    #[test]
    fn turning_antennas_count_cycles() {
        let position = Vector3::x() * 26e6;
        let axes = BodyAxes::nominal(&position, &Vector3::new(0.0, 1.5e11, 0.0)).unwrap();
        let enu = Geodetic { latitude: 0.0, longitude: 0.0, height: 0.0 }.enu_from_ecef();
        let start = wind_up(&axes, &enu, &Vector3::x(), None);
        let (mut receiver, mut satellite) = (start, start);
        for step in 1..=80 {
            let angle = f64::from(step) * TAU / 20.0;
            // From north over east is clockwise about up.
            let turned = enu
                * Rotation3::from_axis_angle(&Vector3::x_axis(), angle)
                    .inverse()
                    .matrix()
                    .transpose();
            receiver = wind_up(&axes, &turned, &Vector3::x(), Some(receiver));
            let turn = Rotation3::from_axis_angle(&Vector3::x_axis(), angle);
            let turned = BodyAxes { x: turn * axes.x, y: turn * axes.y, z: axes.z };
            satellite = wind_up(&turned, &enu, &Vector3::x(), Some(satellite));
            let cycles = f64::from(step) / 20.0;
            assert!((receiver - start - cycles).abs() < 1e-9, "{step} {receiver}");
            assert!((satellite - start - cycles).abs() < 1e-9, "{step} {satellite}");
        }
    }

    #[test]
    fn undefined_stays_as_it_was() {
        let (enu, _) = receiver();
        let nadir = -enu.row(2).transpose();
        let below = BodyAxes { x: nadir, y: nadir, z: nadir };
        for sight in [nadir, nadir * f64::NAN] {
            assert_eq!(wind_up(&below, &enu, &sight, Some(7.25)), 7.25);
            assert_eq!(wind_up(&below, &enu, &sight, None), 0.0);
        }
        let (enu, sight) = receiver();
        let cycles = wind_up(&axes(), &enu, &sight, Some(f64::NAN));
        assert!(cycles.abs() <= 0.5, "{cycles}");
    }
}
