//! Whether the turns that a gyroscope measured are as large as gravity shows them.

use super::Sample;
use super::motion::{Axes, Motion};
use super::raw::Raw;
use super::rest::{Rest, median};

/// Fewer stretches of motion tell nothing.
const FEWEST_STRETCHES: usize = 2;
/// How far the search goes either way, as a factor.
const FARTHEST: f64 = 4.0;
/// Steps of the search from the smallest to the largest factor.
const STEPS: i32 = 48;

/// How large the measured turns are, against those that the directions of gravity show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turns {
    /// By what the measured turns have to be multiplied to explain the directions of gravity best.
    pub factor: f64,
    /// What then is left in disagreement: 0.1 are 6° or a tenth of gravity.
    pub error: f64,
    /// What is left with the turns as measured.
    pub error_as_measured: f64,
    /// How many stretches of motion between moments of rest there were.
    pub stretches: usize,
}

/// Compares turns and gravity between moments of rest. A factor far from one means a gyroscope of another scale, or times
/// that run too fast or too slow. None if there is too little rest or motion.
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

/// The samples, with times in s.
pub(super) fn raw_of(samples: &[Sample]) -> Vec<Raw> {
    let raw = |sample: &Sample| Raw {
        time: sample.time_us as f64 * 1e-6,
        force: sample.specific_force,
        rate: sample.angular_rate,
    };
    samples.iter().map(raw).collect()
}

/// The median spacing of samples; none of less than two moments.
pub(super) fn usual_step(raw: &[Raw]) -> Option<f64> {
    let steps = raw.windows(2).map(|pair| pair[1].time - pair[0].time);
    let usual = median(steps.filter(|step| *step > 0.0).collect());
    (!usual.is_nan()).then_some(usual)
}
