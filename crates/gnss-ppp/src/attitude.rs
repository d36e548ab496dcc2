use nalgebra::Vector3;

/// The body axes of a satellite as unit vectors in ECEF, named by the convention of the IGS, to which ANTEX files
/// refer, whatever the manufacturer's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BodyAxes {
    /// The axis that completes the right-handed triad, on the side of the Sun.
    pub x: Vector3<f64>,
    /// The axis of the solar panels, perpendicular to the plane of Earth, satellite and Sun.
    pub y: Vector3<f64>,
    /// The axis towards the Earth's centre, along the antenna's beam.
    pub z: Vector3<f64>,
}

impl BodyAxes {
    /// The nominal attitude of a yaw-steering satellite: antenna to the Earth, panels perpendicular to the Sun.
    /// `satellite` and `sun` are ECEF positions (m) at the same instant.
    ///
    /// `None` where the yaw is undefined: if Earth, satellite and Sun are collinear, or a number is not finite. In the
    /// Earth's shadow and at noon real satellites turn more slowly than the nominal attitude, which is not modelled
    /// here (Montenbruck et al. 2015, *Adv. Space Res.* 56, section 3).
    pub fn nominal(satellite: &Vector3<f64>, sun: &Vector3<f64>) -> Option<Self> {
        // The sine below which rounding determines the yaw.
        const COLLINEAR: f64 = 1e-9;
        let z = (-satellite).try_normalize(f64::MIN_POSITIVE)?;
        let to_sun = (sun - satellite).try_normalize(f64::MIN_POSITIVE)?;
        let y = z.cross(&to_sun).try_normalize(COLLINEAR)?;
        let x = y.cross(&z);
        x.iter().all(|x| x.is_finite()).then_some(Self { x, y, z })
    }

    /// Converts a vector from body axes to ECEF.
    pub fn to_ecef(&self, body: &[f64; 3]) -> Vector3<f64> {
        let [x, y, z] = *body;
        self.x * x + self.y * y + self.z * z
    }

    /// Converts an ECEF vector to body axes.
    pub fn from_ecef(&self, vector: &Vector3<f64>) -> [f64; 3] {
        [self.x.dot(vector), self.y.dot(vector), self.z.dot(vector)]
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::BodyAxes;

    #[test]
    fn panels_see_the_sun_and_the_antenna_the_earth() {
        let satellite = Vector3::new(12e6, -21e6, 9e6);
        let sun = Vector3::new(-0.3, 0.9, 0.3) * 1.5e11;
        let axes = BodyAxes::nominal(&satellite, &sun).unwrap();
        let to_sun = (sun - satellite).normalize();
        assert!((axes.z + satellite.normalize()).norm() < 1e-15);
        assert!(axes.y.dot(&to_sun).abs() < 1e-15 && axes.x.dot(&to_sun) > 0.0);
        assert!((axes.x.cross(&axes.y) - axes.z).norm() < 1e-15);
        assert!((axes.to_ecef(&axes.from_ecef(&sun)) - sun).norm() < 1e-3);
    }

    /// Above the equator at noon + 6 h: the Sun in +Y of ECEF, the satellite on +X.
    #[test]
    fn a_known_attitude() {
        let axes =
            BodyAxes::nominal(&(Vector3::x() * 26e6), &Vector3::new(26e6, 1.5e11, 0.0)).unwrap();
        assert_eq!(axes.z, -Vector3::x());
        assert_eq!(axes.x, Vector3::y());
        assert_eq!(axes.y, -Vector3::z());
    }

    #[test]
    fn no_yaw_on_the_line_to_the_sun() {
        let satellite = Vector3::new(1.0, 2.0, 3.0) * 7e6;
        for sun in [satellite * 5e3, -satellite * 5e3, satellite, satellite * f64::NAN] {
            assert_eq!(BodyAxes::nominal(&satellite, &sun), None);
        }
        assert_eq!(BodyAxes::nominal(&Vector3::zeros(), &satellite), None);
        assert_eq!(BodyAxes::nominal(&(satellite * 1e300), &satellite), None);
    }
}
