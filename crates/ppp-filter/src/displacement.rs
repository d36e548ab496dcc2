//! How far a receiver that is said to rest has gone since the epoch before, from its phases alone.

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use nalgebra::{SVector, Vector3};

/// What is not known of the place and of the clock, which codes tell to metres, m².
const UNKNOWN: [f64; 4] = [1e4; 4];
/// Fewer satellites do not show whether their changes agree.
const FEWEST: usize = 6;
/// A receiver has moved that is farther from where it was than so many standard deviations, by the noise that the changes show
/// themselves: on four clean days of three stations none is farther than 6.6.
const FARTHEST: f64 = 10.0;
/// Changes that differ from a motion by more, in their variances, are slips.
const MISFIT: f64 = 9.0;
/// What an epoch counts for in the noise of the changes.
const SHARE: f64 = 0.03;
/// The noise is never less than this part of the variances said.
const LEAST: f64 = 0.02;

/// Tells when a receiver that is said to rest goes elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Displacement {
    /// Mean square of what is left of the changes, in their variances.
    noise: f64,
}

/// What changed of a satellite since it was last used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// Unit vector from the receiver to it.
    pub(crate) sight: Vector3<f64>,
    /// By how much its phase is longer than a receiver at rest would have it, m.
    pub(crate) phase: f64,
    /// The variance of that, m².
    pub(crate) variance: f64,
}

impl Displacement {
    pub(crate) const NEW: Self = Self { noise: 1.0 };

    /// Where the phases' changes since the epoch before take a receiver, m, if that surely is another place.
    ///
    /// Ambiguities do not change from one epoch to the next, nor do delays by much: what all phases change by in common is the clock
    /// and a motion (time-differenced carrier phases; van Graas and Soloviev 2004).
    #[inline(never)] // Of receivers at rest, once an epoch.
    pub(crate) fn of(&mut self, changes: &[Change]) -> Option<Vector3<f64>> {
        if changes.len() < FEWEST {
            return None;
        }
        let mut moved = Gaussian::new(SVector::zeros(), Covariance::from_variances(&UNKNOWN));
        for change in changes {
            let row = change.row();
            let innovation = change.phase - row.dot(&moved.mean)?;
            moved.update(&row, innovation, change.variance).ok()?;
        }
        let left = |change: &Change| {
            let left = change.phase - change.row().dot(&moved.mean).unwrap_or(0.0);
            left * left / change.variance
        };
        let sum: f64 = changes.iter().map(left).sum();
        let misfit = sum / (changes.len() - 4) as f64;
        let step = moved.mean.xyz();
        // Of a covariance that is not definite nothing is sure.
        let size = moved.covariance.to_matrix().fixed_view::<3, 3>(0, 0).try_inverse()?;
        let square = (step.transpose() * size * step).x;
        let noise = misfit.max(self.noise).max(LEAST);
        self.noise += SHARE * (misfit.min(MISFIT) - self.noise);
        (square > FARTHEST * FARTHEST * noise && misfit < MISFIT).then_some(step)
    }
}

impl Change {
    fn row(&self) -> SparseRow<f64, 4> {
        let [x, y, z] = self.sight.into();
        SparseRow::new([(0, -x), (1, -y), (2, -z), (3, 1.0)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight satellites, whose phases a motion and a clock change, and noise of so many centimetres.
    fn changes(motion: [f64; 3], noise: f64) -> [Change; 8] {
        let of = |at: usize| {
            let (azimuth, elevation) = (at as f64 * 2.4, 0.3 + 0.15 * at as f64);
            let (along, up) = (elevation.cos(), elevation.sin());
            let sight = Vector3::new(along * azimuth.cos(), along * azimuth.sin(), up);
            let noise = 0.01 * noise * ((7 * at * at) as f64).sin();
            let phase = 12.5 - sight.dot(&Vector3::from(motion)) + noise;
            Change { sight, phase, variance: 1e-4 }
        };
        core::array::from_fn(of)
    }

    fn displacement(changes: &[Change]) -> Option<Vector3<f64>> {
        let mut fresh = Displacement::NEW;
        fresh.of(changes)
    }

    #[test]
    fn a_receiver_at_rest_has_not_moved_and_a_knocked_one_has() {
        assert_eq!(displacement(&changes([0.0; 3], 1.0)), None);
        assert_eq!(displacement(&changes([0.03, 0.0, 0.0], 1.0)), None, "it may be noise");
        for motion in [[0.15, 0.0, 0.0], [0.0, -0.3, 0.0], [0.1, 0.1, 0.5], [30.0, -20.0, 10.0]] {
            let moved = displacement(&changes(motion, 1.0)).expect("a motion");
            assert!((moved - Vector3::from(motion)).norm() < 0.05, "{moved}");
        }
    }

    #[test]
    fn noise_is_no_motion_and_slips_are_none() {
        assert_eq!(displacement(&changes([0.15, 0.0, 0.0], 20.0)), None, "noise is as large");
        let mut slipped = changes([0.0; 3], 1.0);
        slipped[2].phase += 0.19;
        slipped[5].phase -= 0.48;
        assert_eq!(displacement(&slipped), None);
        assert_eq!(displacement(&changes([9.0, 0.0, 0.0], 0.0)[..5]), None, "they are too few");
        assert_eq!(displacement(&[changes([9.0, 0.0, 0.0], 0.0)[0]; 8]), None, "of one direction");
    }

    #[test]
    fn of_phases_that_were_quiet_less_is_a_motion() {
        let mut quiet = Displacement::NEW;
        let small = changes([0.03, 0.0, 0.0], 0.2);
        assert_eq!(quiet.of(&small), None);
        for _ in 0..100 {
            assert_eq!(quiet.of(&changes([0.0; 3], 0.2)), None);
        }
        assert!(quiet.of(&small).is_some());
    }
}
