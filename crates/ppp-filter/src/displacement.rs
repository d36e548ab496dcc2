//! Detection of a displacement since the preceding epoch, from the phases alone, of a receiver that should be at rest.

use crate::least_squares::Step;
use nalgebra::Vector3;

/// The prior variance of place and clock, m²: the codes determine both to metres.
const UNKNOWN: f64 = 1e6;
/// Indices for leaving out no change.
const NONE: [usize; 2] = [usize::MAX; 2];
/// The minimum number of satellites: fewer, without two of them, do not show whether their changes agree.
const FEWEST: usize = 8;
/// A receiver has moved if it is more than this many standard deviations from where it was. These follow from the noise
/// of its own phases: on four clean days of three stations none exceeded 6.6.
const FARTHEST: f64 = 10.0;
/// The number of standard deviations that a displacement must also exceed by the changes of all satellites but any two.
const STILL_FAR: f64 = 5.0;
/// The largest mean square of the changes about a motion, in their variances: larger ones are slips. The noise of one
/// epoch counts as no more than this many times the previous noise.
const MISFIT: f64 = 9.0;
/// The weight of one epoch in the mean noise.
const SHARE: f64 = 0.03;
/// The lower limit of the noise, as a share of the assumed variances.
const LEAST: f64 = 0.02;

/// Detects when a receiver that should be at rest moves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Displacement {
    /// The mean square of the changes apart from that of the clock, in their variances.
    noise: f64,
}

/// The change of a satellite's phase since it was last used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Change {
    /// The unit vector from the receiver to the satellite.
    pub(crate) sight: Vector3<f64>,
    /// By how much the phase is longer than it would be for a receiver at rest, m.
    pub(crate) phase: f64,
    /// The variance of the change, m².
    pub(crate) variance: f64,
}

impl Displacement {
    pub(crate) const NEW: Self = Self { noise: 1.0 };

    /// The displacement that explains the phases' changes since the preceding epoch, m, if it is significant whichever
    /// two satellites are left out, as these may have slipped.
    ///
    /// Ambiguities do not change from one epoch to the next, and delays hardly: what all phases change by in common is
    /// due to the clock and a motion (time-differenced carrier phases; van Graas and Soloviev 2004).
    #[inline(never)] // Of receivers at rest, once an epoch.
    pub(crate) fn of(&mut self, changes: &[Change]) -> Option<Vector3<f64>> {
        let count = changes.len();
        if count < FEWEST {
            return None;
        }
        let unrest = unrest(changes, NONE);
        let noise = self.noise.max(LEAST);
        let mut seen = unrest / (count - 1) as f64;
        let mut moved = None;
        // A quick test first: at rest the changes are too small for any motion.
        if unrest > FARTHEST * FARTHEST * noise
            && let Some(all) = Fit::beyond(FARTHEST, changes, NONE, noise)
        {
            let is_seen_without = |first: usize| {
                let mut seconds = first..count;
                let beyond = |left_out| Fit::beyond(STILL_FAR, changes, left_out, noise);
                seconds.all(|second| beyond([first, second]).is_some())
            };
            if (0..count).all(is_seen_without) {
                // Changes that a motion explains are no noise.
                seen = all.misfit;
                moved = Some(all.step);
            }
        }
        self.noise += SHARE * (seen.min(MISFIT * noise) - self.noise);
        moved
    }
}

/// All changes except two.
fn all_but(changes: &[Change], left_out: [usize; 2]) -> impl Iterator<Item = &Change> {
    let numbered = changes.iter().enumerate();
    numbered.filter(move |(index, _)| !left_out.contains(index)).map(|(_, change)| change)
}

/// The sum of the squared changes, except two, about a common clock change, in their variances.
#[inline(never)] // Wanted at two places, once in flash.
fn unrest(changes: &[Change], left_out: [usize; 2]) -> f64 {
    let (mut weights, mut sum, mut squares) = (0.0, 0.0, 0.0);
    // Relative to the first, so that no precision is lost where a clock leaps far.
    let origin = changes.first().map_or(0.0, |it| it.phase);
    for change in all_but(changes, left_out) {
        let (weight, phase) = (1.0 / change.variance, change.phase - origin);
        weights += weight;
        sum += weight * phase;
        squares += weight * phase * phase;
    }
    squares - sum * sum / weights
}

/// A motion that explains the changes.
#[derive(Clone, Copy, Debug)]
struct Fit {
    /// The displacement, m.
    step: Vector3<f64>,
    /// The mean square of the residuals of the changes, in their variances.
    misfit: f64,
}

impl Fit {
    /// The motion that fits all changes except two, if it exceeds a number of standard deviations; `noise` is that of
    /// earlier epochs.
    #[inline(never)] // Wanted at two places, once in flash.
    fn beyond(
        deviations: f64,
        changes: &[Change],
        left_out: [usize; 2],
        noise: f64,
    ) -> Option<Self> {
        let mut moved = Step::unknown(UNKNOWN);
        let (mut count, mut left) = (0_u8, 0.0);
        for change in all_but(changes, left_out) {
            left += moved.take_in(&change.sight, change.phase, change.variance).ok()?;
            count = count.saturating_add(1);
        }
        let misfit = left / f64::from(count.saturating_sub(4));
        // The part that the motion explains beyond the clock: its square, in its variances.
        let square = unrest(changes, left_out) - left;
        let is_beyond = square > deviations * deviations * misfit.max(noise) && misfit < MISFIT;
        is_beyond.then_some(Self { step: moved.coordinates(), misfit })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The changes of nine satellites due to a motion and a clock, with noise of `noise` centimetres.
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
