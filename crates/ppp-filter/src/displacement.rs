//! How far a receiver that is said to rest has gone since the epoch before, from its phases alone.

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use kestirim_scalar::Components;
use nalgebra::{SVector, Vector3};

/// What is not known of the place and of the clock, which codes tell to metres, m².
const UNKNOWN: [f64; 4] = [1e4; 4];
/// Fewer satellites do not show whether their changes agree.
const FEWEST: usize = 6;
/// A receiver has moved that is farther from where it was than so many standard deviations, by the noise that the changes show
/// themselves: four clean days of three stations stay below 7 of those.
const FARTHEST: f64 = 10.0;
/// The same by the changes of all satellites but any two.
const STILL_FAR: f64 = 5.0;
/// Changes that differ from a motion by more, in their variances, are slips.
const MISFIT: f64 = 9.0;
/// A part of a variance that is nothing beside it.
const EXACT: f64 = 1e-9;
/// What an epoch counts for in the noise of the changes.
const SHARE: f64 = 0.03;
/// The noise is never less than this part of the variances said.
const LEAST: f64 = 0.02;

/// Tells when a receiver that is said to rest goes elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Displacement {
    /// Mean square of the changes beside the clock's, in their variances.
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

    /// Where the phases' changes since the epoch before take a receiver, m, if that surely is another place, whichever two of
    /// them are left out: they may have slipped.
    ///
    /// Ambiguities do not change from one epoch to the next, nor do delays by much: what all phases change by in common is the clock
    /// and a motion (time-differenced carrier phases; van Graas and Soloviev 2004).
    #[inline(never)] // Of receivers at rest, once an epoch.
    pub(crate) fn of(&mut self, changes: &[Change]) -> Option<Vector3<f64>> {
        let freedom = changes.len().checked_sub(1).filter(|others| *others > FEWEST)?;
        let sum = |of: &dyn Fn(&Change) -> f64| changes.iter().map(of).sum::<f64>();
        let weight = sum(&|it| 1.0 / it.variance);
        let clock = sum(&|it| it.phase / it.variance) / weight;
        let unrest = sum(&|it| (it.phase - clock) * (it.phase - clock) / it.variance);
        let noise = self.noise.max(LEAST);
        let mut seen = unrest / freedom as f64;
        let mut moved = None;
        // No motion explains more than there is, and at rest there is little.
        if unrest > FARTHEST * FARTHEST * noise
            && let Some(all) = Motion::of(changes, None)
        {
            let count = changes.len();
            let others = |first| {
                (first..count).all(|second| {
                    let of_others = Motion::of(changes, Some([first, second]));
                    of_others.is_some_and(|it| it.is_beyond(STILL_FAR, noise))
                })
            };
            if all.is_beyond(FARTHEST, noise) && (0..count).all(others) {
                // What a motion explains is no noise.
                seen = all.misfit;
                moved = Some(all.step);
            }
        }
        self.noise += SHARE * (seen.min(MISFIT) - self.noise);
        moved
    }
}

/// A motion that explains changes.
#[derive(Clone, Copy, Debug)]
struct Motion {
    /// Where, m.
    step: Vector3<f64>,
    /// Its square, in its variances.
    square: f64,
    /// Mean square of what is left of the changes, in their variances.
    misfit: f64,
}

impl Motion {
    /// Of all changes, or all but two; none of too few.
    #[inline(never)] // Wanted at two places, once in flash.
    fn of(changes: &[Change], left_out: Option<[usize; 2]>) -> Option<Self> {
        let used = || {
            let numbered = changes.iter().enumerate();
            let is_left = move |index| left_out.is_some_and(|two| two.contains(&index));
            numbered.filter(move |(index, _)| !is_left(*index)).map(|(_, change)| change)
        };
        let count = used().count();
        if count < FEWEST {
            return None;
        }
        let mut moved = Gaussian::new(SVector::zeros(), Covariance::from_variances(&UNKNOWN));
        for change in used() {
            let row = change.row();
            let innovation = change.phase - row.dot(&moved.mean)?;
            moved.update(&row, innovation, change.variance).ok()?;
        }
        let left = |change: &Change| {
            let left = change.phase - change.row().dot(&moved.mean).unwrap_or(0.0);
            left * left / change.variance
        };
        let sum: f64 = used().map(left).sum();
        let step = moved.mean.xyz();
        // One coordinate after the other, each as those before leave it.
        let mut square = 0.0;
        for axis in 0..3 {
            let row = SparseRow::new([0, 1, 2, 3].map(|it| (it, f64::from(u8::from(it == axis)))));
            let variance = moved.covariance.get(axis, axis)?;
            let left = moved.mean.as_array().get(axis)?;
            square += left * left / variance;
            moved.update(&row, -left, EXACT * variance).ok()?;
        }
        Some(Self { step, square, misfit: sum / (count - 4) as f64 })
    }

    /// Whether it is farther than so many deviations, where this is the noise of changes before.
    fn is_beyond(self, deviations: f64, noise: f64) -> bool {
        let noise = self.misfit.max(noise);
        self.square > deviations * deviations * noise && self.misfit < MISFIT
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

    /// Nine satellites, whose phases a motion and a clock change, and noise of so many centimetres.
    fn changes(motion: [f64; 3], noise: f64) -> [Change; 9] {
        let of = |at: usize| {
            let (azimuth, elevation) = (at as f64 * 2.4, 0.3 + 0.13 * at as f64);
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
        assert_eq!(displacement(&changes([9.0, 0.0, 0.0], 0.0)[..7]), None, "they are too few");
        let mut one = changes([0.0; 3], 0.1);
        one[7].phase += 0.5;
        assert_eq!(displacement(&one), None, "without it there is no motion");
        one[3].phase -= 0.3;
        assert_eq!(displacement(&one), None, "nor without both");
        assert_eq!(displacement(&changes([f64::NAN, 0.0, 0.0], 0.1)), None);
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

    #[test]
    fn a_motion_that_goes_on_is_not_taken_for_noise() {
        let mut carried = Displacement::NEW;
        for _ in 0..100 {
            carried.of(&changes([0.0; 3], 0.2));
        }
        for step in 0..100 {
            assert!(carried.of(&changes([0.05, 0.0, 0.0], 0.2)).is_some(), "{step}");
        }
    }
}
