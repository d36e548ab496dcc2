//! Moments of rest, found without knowing any unit: a short window in which the accelerometer changes little beside what it
//! shows.

use super::raw::Raw;

/// How long a window is, s: shorter than a footprint, longer than a few samples.
const WINDOW: f64 = 0.08;
/// Fewest and most samples of a window.
const SAMPLES: (f64, f64) = (5.0, 800.0);
/// The share of the windows that are the stillest, from which the norm at rest comes.
const STILLEST: f64 = 0.04;
/// The share of the windows that are taken for still, if they change little enough: a foot stands longer.
const OFTEN: f64 = 0.15;
/// Beyond this share of change the stillest windows are no rest.
const MOST_CHANGE: f64 = 0.08;
/// A window is still if it changes at most so many times as much as the stillest do, …
const AS_STILL: f64 = 2.5;
/// … or this share of the norm, …
const STILL: f64 = 0.02;
/// … and if its norm is within this share of the norm at rest.
const NORM: f64 = 0.06;
/// Fewer windows tell nothing.
const FEWEST_WINDOWS: usize = 5;

/// A window of samples.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    /// Its middle: the place of a sample.
    pub(crate) middle: usize,
    /// Mean of the accelerometer.
    pub(crate) force: [f64; 3],
    /// Mean of the gyroscope.
    pub(crate) rate: [f64; 3],
    /// Standard deviation of the accelerometer as a share of the mean's norm.
    pub(crate) change: f64,
    /// Whether it is a moment of rest.
    pub(crate) is_still: bool,
}

/// What a log holds of rest.
#[derive(Debug, Clone)]
pub(crate) struct Rest {
    /// All windows, in the order of time.
    pub(crate) windows: Vec<Window>,
    /// The accelerometer's norm, in its own unit.
    pub(crate) norm: f64,
    /// The gyroscope's mean, in its own unit: its bias.
    pub(crate) bias: [f64; 3],
}

impl Rest {
    /// Looks for rest in samples whose median spacing is `step` seconds; none if there is not any.
    pub(crate) fn find(raw: &[Raw], step: f64) -> Option<Self> {
        Self::within(raw, step, NORM, leave_out_repeated)
    }

    /// The same of a sensor that is put down on purpose: its norm is within another share of that at rest, and a log of few
    /// digits shows the same again and again.
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
        // A log that begins with a long stand has other rest, too.
        let often = least(&windows, OFTEN).last().map_or(limit, |&i| windows[i].change);
        let limit = (limit * AS_STILL).max(STILL).max(often).min(MOST_CHANGE);
        for window in &mut windows {
            let off = (length_of(window.force) - norm).abs();
            window.is_still = window.change <= limit && off <= share * norm;
        }
        Some(Self { windows, norm, bias })
    }
}

/// A sensor that repeats itself to the last digit where it has noise elsewhere is stuck, not at rest.
fn leave_out_repeated(windows: &mut [Window]) {
    // Beyond the rounding of a mean.
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

/// The places of a share of the windows, those that change least; the least still of them last.
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

/// The middle one; not a number of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
