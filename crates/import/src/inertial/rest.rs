//! Moments of rest, found without knowing any unit: short windows in which the accelerometer changes little relative to
//! its mean.

use super::raw::Raw;

/// The length of a window, s: shorter than a stance, longer than a few samples.
const WINDOW: f64 = 0.08;
/// The smallest and the largest number of samples in a window.
const SAMPLES: (f64, f64) = (5.0, 800.0);
/// The share of the windows, the stillest ones, from which the norm at rest is computed.
const STILLEST: f64 = 0.04;
/// The share of the windows that count as still if they change little enough: a foot stands for longer.
const OFTEN: f64 = 0.15;
/// The relative change above which even the stillest windows are not rest.
const MOST_CHANGE: f64 = 0.08;
/// A window is still if it changes by at most this multiple of what the stillest windows do.
const AS_STILL: f64 = 2.5;
/// A window is still if it changes by at most this share of the norm.
const STILL: f64 = 0.02;
/// The largest deviation of a still window's norm from the norm at rest, as a share of the latter.
const NORM: f64 = 0.06;
/// The smallest number of windows from which anything is concluded.
const FEWEST_WINDOWS: usize = 5;

/// A window of samples.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    /// The index of its middle sample.
    pub(crate) middle: usize,
    /// The mean of the accelerometer.
    pub(crate) force: [f64; 3],
    /// The mean of the gyroscope.
    pub(crate) rate: [f64; 3],
    /// The standard deviation of the accelerometer, as a share of the norm of its mean.
    pub(crate) change: f64,
    /// Whether it is a moment of rest.
    pub(crate) is_still: bool,
}

/// The moments of rest in a log.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    /// All windows, in order of time.
    pub(crate) windows: Vec<Window>,
    /// The accelerometer's norm at rest, in its own unit.
    pub(crate) norm: f64,
    /// The gyroscope's mean at rest, in its own unit: its bias.
    pub(crate) bias: [f64; 3],
}

impl Rest {
    /// Finds rest in samples whose median spacing is `step` seconds; `None` if there is none.
    pub(crate) fn find(raw: &[Raw], step: f64) -> Option<Self> {
        Self::within(raw, step, NORM, leave_out_repeated)
    }

    /// Finds the rest of a sensor that is put down on purpose: its norm may deviate by `share` from that at rest, and
    /// repeated values are accepted, because a log with few digits repeats itself.
    pub(crate) fn put_down(raw: &[Raw], step: f64, share: f64) -> Option<Self> {
        Self::within(raw, step, share, |_| ())
    }

    fn within(
        raw: &[Raw],
        step: f64,
        share: f64,
        leave_out: impl Fn(&mut [Window]),
    ) -> Option<Self> {
        let length = (WINDOW / step).round().clamp(SAMPLES.0, SAMPLES.1) as usize;
        let mut windows: Vec<_> = raw
            .chunks_exact(length)
            .enumerate()
            .map(|(i, part)| window(i * length, part))
            .collect();
        if windows.len() < FEWEST_WINDOWS {
            return None;
        }
        leave_out(&mut windows);
        let stillest = least(&windows, STILLEST);
        let limit = windows[*stillest.last()?].change;
        if limit >= MOST_CHANGE {
            return None;
        }
        let norm = median(stillest.iter().map(|&i| length_of(windows[i].force)).collect());
        let bias = std::array::from_fn(|axis| {
            median(stillest.iter().map(|&i| windows[i].rate[axis]).collect())
        });
        // A log that begins with a long stand also contains other rest.
        let often = least(&windows, OFTEN).last().map_or(limit, |&i| windows[i].change);
        let limit = (limit * AS_STILL).max(STILL).max(often).min(MOST_CHANGE);
        for window in &mut windows {
            let off = (length_of(window.force) - norm).abs();
            window.is_still = window.change <= limit && off <= share * norm;
        }
        Some(Self { windows, norm, bias })
    }
}

/// Excludes windows without any noise if others have some: a sensor that repeats itself to the last digit is stuck, not
/// at rest.
fn leave_out_repeated(windows: &mut [Window]) {
    // More than the rounding error of a mean.
    const NOTHING: f64 = 1e-12;
    let noisy = windows.iter().filter(|window| window.change > NOTHING).count();
    if 2 * noisy < windows.len() {
        return;
    }
    for window in windows.iter_mut().filter(|window| window.change <= NOTHING) {
        window.change = f64::INFINITY;
    }
}

fn window(start: usize, part: &[Raw]) -> Window {
    let count = part.len() as f64;
    let (mut force, mut rate) = ([0.0; 3], [0.0; 3]);
    for sample in part {
        for axis in 0..3 {
            force[axis] += sample.force[axis] / count;
            rate[axis] += sample.rate[axis] / count;
        }
    }
    let mut variance = 0.0;
    for sample in part {
        for axis in 0..3 {
            variance += (sample.force[axis] - force[axis]).powi(2) / count;
        }
    }
    let norm = length_of(force);
    let change = if norm > 0.0 { variance.sqrt() / norm } else { f64::INFINITY };
    Window { middle: start + part.len() / 2, force, rate, change, is_still: false }
}

/// The indices of a share of the windows, those that change least; the least still of them is last.
fn least(windows: &[Window], share: f64) -> Vec<usize> {
    let count = ((windows.len() as f64 * share) as usize).max(FEWEST_WINDOWS.min(windows.len()));
    let mut places: Vec<_> = (0..windows.len()).collect();
    let by_change = |&a: &usize, &b: &usize| windows[a].change.total_cmp(&windows[b].change);
    places.select_nth_unstable_by(count - 1, by_change);
    places.truncate(count);
    places
}

pub(crate) fn length_of(vector: [f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The median; NaN if there are no values.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
