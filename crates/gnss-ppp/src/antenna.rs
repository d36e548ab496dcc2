use nalgebra::Vector3;

use crate::{BodyAxes, Direction};

/// The phase centre of an antenna on one frequency, as an ANTEX file describes it.
///
/// Values lie on a grid: one row of zenith angles (receivers) or nadir angles (satellites) without azimuth, and, if the
/// calibration covers azimuth, one such row for each azimuth from 0° to 360°.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pattern<'a> {
    /// The mean phase centre, m: for a receiver north, east and up of the antenna's reference point; for a satellite
    /// along X, Y and Z of its body.
    pub offset: [f64; 3],
    /// The first angle of the grid, degrees.
    pub first: f64,
    /// The step of the grid, degrees.
    pub step: f64,
    /// The azimuth-independent phase centre variations (`NOAZI`), m.
    pub mean: &'a [f64],
    /// The step of the azimuths, degrees; zero if the grid has none.
    pub azimuth_step: f64,
    /// The rows of all azimuths one after the other, each as long as `mean`, m; empty if there are none.
    pub by_azimuth: &'a [f64],
}

impl Pattern<'_> {
    /// The variation of the phase centre, m: the excess of the range over that from the mean phase centre, at an angle
    /// (rad) from the zenith or nadir and, optionally, an azimuth (rad).
    ///
    /// Linear between the grid points, constant beyond the edges. An azimuth counts only if the grid has complete rows
    /// for it; without a positive step the variation is 0.
    pub fn variation(&self, angle: f64, azimuth: Option<f64>) -> f64 {
        let place = (angle.to_degrees() - self.first) / self.step;
        if !(self.step > 0.0 && place.is_finite()) {
            return 0.0;
        }
        azimuth
            .and_then(|azimuth| self.across_azimuths(place, azimuth.to_degrees()))
            .or_else(|| between(self.mean, place))
            .unwrap_or(0.0)
    }

    /// Interpolates between the two rows around an azimuth (degrees).
    fn across_azimuths(&self, place: f64, azimuth: f64) -> Option<f64> {
        let width = self.mean.len();
        let whole = width > 0 && self.by_azimuth.len().is_multiple_of(width);
        let row = (azimuth - 360.0 * libm::floor(azimuth / 360.0)) / self.azimuth_step;
        if !(whole && self.azimuth_step > 0.0 && row.is_finite()) {
            return None;
        }
        let below = libm::floor(row);
        let mut rows = self.by_azimuth.chunks_exact(width);
        let first = rows.clone().next()?;
        let left = rows.nth(below as usize)?;
        // A grid that ends before 360° continues at 0°.
        let right = rows.next().unwrap_or(first);
        let (left, right) = (between(left, place)?, between(right, place)?);
        Some(left + (right - left) * (row - below))
    }

    /// The contribution of a receiver's antenna to the modelled range from its reference point to a satellite, m.
    ///
    /// The phase centre `offset` shortens the range by its component along the line of sight, the variation lengthens
    /// it: what RTKLIB's `antmodel` calls `dant` and subtracts from the observations. The antenna is assumed level and
    /// facing north.
    pub fn receiver_range(&self, direction: Direction) -> f64 {
        self.receiver_range_along(direction, &direction.local())
    }

    /// [`Self::receiver_range`] for a direction whose unit vector to the east, north and up is known.
    pub(crate) fn receiver_range_along(&self, direction: Direction, local: &Vector3<f64>) -> f64 {
        let [north, east, up] = self.offset;
        let nearer = local.dot(&Vector3::new(east, north, up));
        let zenith = core::f64::consts::FRAC_PI_2 - direction.elevation;
        self.variation(zenith, Some(direction.azimuth)) - nearer
    }

    /// The mean phase centre relative to the satellite's centre of mass, ECEF m: add it to the position of an orbit
    /// product, which is that of the centre of mass.
    pub fn satellite_offset(&self, axes: &BodyAxes) -> Vector3<f64> {
        axes.to_ecef(&self.offset)
    }

    /// The phase centre variation of a satellite's antenna, m, towards a receiver that sees it along `sight` (ECEF unit
    /// vector from the receiver to the satellite). Add it to the modelled range.
    ///
    /// The variation depends on the nadir angle and, where the satellite has rows for it, on the azimuth from the
    /// body's Y axis towards its X axis (ANTEX 1.4).
    pub fn satellite_variation(&self, axes: &BodyAxes, sight: &Vector3<f64>) -> f64 {
        let [x, y, z] = axes.from_ecef(&-sight);
        self.variation(libm::atan2(libm::hypot(x, y), z), Some(libm::atan2(x, y)))
    }

    /// The contribution of a satellite's antenna to the modelled range from its centre of mass, m: the offset along the
    /// line of sight and the variation.
    ///
    /// It equals [`Self::satellite_offset`] and [`Self::satellite_variation`] together, up to the curvature of the wave
    /// front (below 0.1 µm).
    pub fn satellite_range(&self, axes: &BodyAxes, sight: &Vector3<f64>) -> f64 {
        self.satellite_offset(axes).dot(sight) + self.satellite_variation(axes, sight)
    }
}

/// Linear interpolation at a position counted in steps, constant beyond the ends.
fn between(values: &[f64], place: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let place = place.clamp(0.0, last as f64);
    let below = libm::floor(place);
    let left = *values.get(below as usize)?;
    let right = values.get(below as usize + 1).copied().unwrap_or(left);
    Some(left + (right - left) * (place - below))
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use nalgebra::Vector3;

    use super::Pattern;
    use crate::{BodyAxes, Direction};

    const MEAN: [f64; 3] = [0.0, 1.0, 4.0];
    /// 0°, 120°, 240°, 360°.
    const ROWS: [f64; 12] = [0.0, 1.0, 2.0, 0.0, 4.0, 5.0, 0.0, 7.0, 8.0, 0.0, 1.0, 2.0];

    fn pattern() -> Pattern<'static> {
        Pattern {
            offset: [1.0, 2.0, 3.0],
            first: 0.0,
            step: 5.0,
            mean: &MEAN,
            azimuth_step: 120.0,
            by_azimuth: &ROWS,
        }
    }

    fn close(value: f64, expected: f64) {
        assert!((value - expected).abs() < 1e-12, "{value} {expected}");
    }

    #[test]
    fn linear_between_angles_and_held_at_the_ends() {
        for (angle, expected) in [(-3.0, 0.0), (2.5, 0.5), (7.5, 2.5), (10.0, 4.0), (80.0, 4.0)] {
            close(pattern().variation(f64::to_radians(angle), None), expected);
        }
        let offset = Pattern { first: 5.0, ..pattern() };
        close(offset.variation(10_f64.to_radians(), None), 1.0);
    }

    #[test]
    fn linear_between_azimuths_and_round_the_circle() {
        let at = |azimuth: f64| pattern().variation(5_f64.to_radians(), Some(azimuth.to_radians()));
        for (azimuth, expected) in
            [(0.0, 1.0), (60.0, 2.5), (180.0, 5.5), (300.0, 4.0), (-60.0, 4.0), (420.0, 2.5)]
        {
            close(at(azimuth), expected);
        }
        let open = Pattern { by_azimuth: &ROWS[..9], ..pattern() };
        close(open.variation(5_f64.to_radians(), Some(300_f64.to_radians())), 4.0);
    }

    #[test]
    fn malformed_grids_say_what_they_can() {
        let angle = 5_f64.to_radians();
        let broken = |pattern: Pattern| pattern.variation(angle, Some(1.0));
        close(broken(Pattern { by_azimuth: &ROWS[..11], ..pattern() }), 1.0);
        close(broken(Pattern { by_azimuth: &ROWS[..3], ..pattern() }), 1.0);
        close(broken(Pattern { azimuth_step: 0.0, ..pattern() }), 1.0);
        close(broken(Pattern { azimuth_step: f64::NAN, ..pattern() }), 1.0);
        for step in [0.0, -5.0, f64::NAN, 1e-320] {
            let value = broken(Pattern { step, ..pattern() });
            assert!(value == 0.0, "{value}");
        }
        close(broken(Pattern { mean: &[], ..pattern() }), 0.0);
        close(pattern().variation(f64::NAN, Some(f64::INFINITY)), 0.0);
    }

    #[test]
    fn a_phase_centre_towards_the_satellite_shortens_the_range() {
        let flat = Pattern { mean: &[], by_azimuth: &[], ..pattern() };
        let range = |elevation, azimuth| flat.receiver_range(Direction { elevation, azimuth });
        close(range(FRAC_PI_2, 0.0), -3.0);
        close(range(0.0, 0.0), -1.0);
        close(range(0.0, FRAC_PI_2), -2.0);
        let bent = Pattern { offset: [0.0; 3], by_azimuth: &[], ..pattern() };
        close(bent.receiver_range(Direction { elevation: FRAC_PI_2, azimuth: 1.0 }), 0.0);
        close(bent.receiver_range(Direction { elevation: 85_f64.to_radians(), azimuth: 1.0 }), 1.0);
    }

    #[test]
    fn a_satellite_that_looks_down_is_nearer_by_its_offset() {
        let satellite = Vector3::new(0.0, 26e6, 0.0);
        let axes = BodyAxes::nominal(&satellite, &(Vector3::x() * 1.5e11)).unwrap();
        let below = pattern().satellite_range(&axes, &Vector3::y());
        close(below, -3.0);
        let moved = satellite + pattern().satellite_offset(&axes);
        let receiver = Vector3::new(1e6, 6e6, 1e6);
        let sight = (satellite - receiver).normalize();
        let exact = (moved - receiver).norm() - (satellite - receiver).norm();
        let variation = pattern().satellite_variation(&axes, &sight);
        assert!((pattern().satellite_range(&axes, &sight) - variation - exact).abs() < 1e-6);
        // 5° off the nadir towards +X is azimuth 90°, towards −Y 180°.
        let (sine, cosine) = 5_f64.to_radians().sin_cos();
        let towards = |across: Vector3<f64>| {
            pattern().satellite_variation(&axes, &-(axes.z * cosine + across * sine))
        };
        close(towards(axes.x), 1.0 + 3.0 * 0.75);
        close(towards(-axes.y), 5.5);
    }
}
