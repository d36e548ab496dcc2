//! Compares the rotation that a gyroscope measured with what the direction of gravity shows.

use super::Sample;
use super::motion::{Axes, Motion};
use super::raw::Raw;
use super::rest::{Rest, median};

/// The smallest number of stretches of motion from which anything is concluded.
const FEWEST_STRETCHES: usize = 2;
/// The range of the search in either direction, as a factor.
const FARTHEST: f64 = 4.0;
/// The number of steps from the smallest to the largest factor.
const STEPS: i32 = 48;

/// The size of the measured rotations, relative to those that the directions of gravity show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turns {
    /// The factor on the measured rotations that explains the directions of gravity best.
    pub factor: f64,
    /// The disagreement that remains with this factor: 0.1 is 6° or a tenth of gravity.
    pub error: f64,
    /// The disagreement of the rotations as measured.
    pub error_as_measured: f64,
    /// The number of stretches of motion between moments of rest.
    pub stretches: usize,
}

/// Compares rotations and gravity between moments of rest; `None` if there is too little rest or motion.
///
/// A factor far from one means that the gyroscope's scale is wrong, or that times run too fast or too slow.
pub fn turns(samples: &[Sample]) -> Option<Turns> {
    let raw = raw_of(samples);
    let usual = usual_step(&raw)?;
    let motion = Motion::find(&raw, &Rest::find(&raw, usual)?, usual, usual);
    let stretches = motion.count();
    if stretches < FEWEST_STRETCHES {
        return None;
    }
    let error = |factor: f64| motion.error(factor, Axes::SAME);
    let tried = (-STEPS..=STEPS).map(|i| FARTHEST.powf(f64::from(i) / f64::from(STEPS)));
    let best = tried.map(|factor| (factor, error(factor))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Turns { factor: best.0, error: best.1, error_as_measured: error(1.0), stretches })
}

/// The samples as raw ones, with times in s.
pub(super) fn raw_of(samples: &[Sample]) -> Vec<Raw> {
    let raw = |sample: &Sample| Raw {
        time: sample.time_us as f64 * 1e-6,
        force: sample.specific_force,
        rate: sample.angular_rate,
    };
    samples.iter().map(raw).collect()
}

/// The median spacing of the samples; `None` if there are fewer than two different times.
pub(super) fn usual_step(raw: &[Raw]) -> Option<f64> {
    let steps = raw.windows(2).map(|pair| pair[1].time - pair[0].time);
    let usual = median(steps.filter(|step| *step > 0.0).collect());
    (!usual.is_nan()).then_some(usual)
}
