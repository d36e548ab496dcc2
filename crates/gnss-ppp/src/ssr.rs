//! Corrections of broadcast orbits, as services send them (state-space representation, SSR).

use crate::OrbitState;
use crate::constants::EARTH_ROTATION;
use nalgebra::Vector3;

impl OrbitState {
    /// The state after subtraction of an orbit correction: radial, along-track and cross-track, m. `None` for a state without
    /// a plane of motion.
    ///
    /// The axes are those of the position and of the velocity in the Earth-fixed frame. (IGS SSR 1.00, 4.1.)
    pub fn corrected(&self, [radial, along, cross]: [f64; 3]) -> Option<Self> {
        let Self { position, velocity } = *self;
        let carried = Vector3::new(-EARTH_ROTATION * position.y, EARTH_ROTATION * position.x, 0.0);
        let e_along = (velocity - carried).try_normalize(0.0)?;
        let e_cross = position.cross(&e_along).try_normalize(0.0)?;
        let e_radial = e_along.cross(&e_cross);
        let offset = e_radial * radial + e_along * along + e_cross * cross;
        Some(Self { position: position - offset, velocity })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_an_orbit_in_the_equator() {
        // At rest in the rotating frame but for 1 km/s towards y.
        let position = Vector3::new(26e6, 0.0, 0.0);
        let velocity = Vector3::new(0.0, EARTH_ROTATION * 26e6 + 1e3, 0.0);
        let state = OrbitState { position, velocity };
        let corrected = state.corrected([1.0, 2.0, 4.0]).expect("an orbit");
        assert!((corrected.position - Vector3::new(26e6 - 1.0, -2.0, -4.0)).norm() < 1e-6);
        assert_eq!(corrected.velocity, velocity);
        let velocity = Vector3::new(0.0, EARTH_ROTATION * 26e6, 0.0);
        assert_eq!(OrbitState { position, velocity }.corrected([0.0; 3]), None);
    }
}
