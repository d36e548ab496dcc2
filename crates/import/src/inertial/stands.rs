//! Stretches in which a sensor is held still in one attitude: a calibration needs long ones.

use super::Sample;
use super::motion::angle;
use super::raw::Raw;
use super::rest::{Rest, Window, length_of};
use super::turns::{raw_of, usual_step};

/// The largest angle by which gravity turns between two windows of one stand, and within it, rad: a creeping hand
/// exceeds it, the sensor's noise in a window does not.
const SAME: f64 = 0.02;
/// The largest deviation of a still window's mean rate from that at rest, rad/s: the force does not show a turn about
/// the vertical.
const STILL_RATE: f64 = 0.05;
/// The deviation of the norm that is allowed for an uncalibrated accelerometer: one that is off by a quarter measures
/// gravity so differently on its sides.
const NORM: f64 = 0.25;

/// A stretch of samples in which a sensor is held still.
#[derive(Debug, Clone, PartialEq)]
pub struct Stand {
    /// The indices of its samples, without those at either end, where a hand lets go and grips again.
    pub samples: std::ops::Range<usize>,
    /// The duration of these samples, s.
    pub seconds: f64,
}

/// The stretches of at least `shortest` seconds in which a sensor is held still in one attitude, in order of time.
///
/// One short window is cut from either end of each.
pub fn stands(samples: &[Sample], shortest: f64) -> Vec<Stand> {
    let raw = raw_of(samples);
    let Some(usual) = usual_step(&raw) else { return Vec::new() };
    let Some(mut rest) = Rest::put_down(&raw, usual, NORM) else { return Vec::new() };
    for window in &mut rest.windows {
        window.is_still &= apart(window.rate, rest.bias) < STILL_RATE;
    }
    let mut stands = Vec::new();
    let mut first = 0;
    for end in 1..=rest.windows.len() {
        let goes_on = rest
            .windows
            .get(end)
            .is_some_and(|next| continues(&rest.windows[first], &rest.windows[end - 1], next));
        if !goes_on {
            stands.extend(stand(&raw, &rest.windows[first..end], shortest));
            first = end;
        }
    }
    stands
}

fn continues(first: &Window, last: &Window, next: &Window) -> bool {
    first.is_still
        && next.is_still
        && angle(first.force, next.force) < SAME
        && angle(last.force, next.force) < SAME
}

fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    length_of(std::array::from_fn(|axis| a[axis] - b[axis]))
}

fn stand(raw: &[Raw], windows: &[Window], shortest: f64) -> Option<Stand> {
    let [_, inner @ .., _] = windows else { return None };
    let (first, last) = (inner.first()?, inner.last()?);
    // A window extends equally far to either side of its middle.
    let half = last.middle.checked_sub(first.middle)? / (inner.len().max(2) - 1) / 2;
    let samples = first.middle.saturating_sub(half)..(last.middle + half).min(raw.len());
    let (begin, end) = (raw.get(samples.start)?, raw.get(samples.end.checked_sub(1)?)?);
    let seconds = end.time - begin.time;
    (first.is_still && seconds >= shortest).then_some(Stand { samples, seconds })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples at 100 Hz, with a little noise, of a sensor that is held for 2 s, turned about x for 1 s, and so on.
    fn held(turns: u32) -> Vec<Sample> {
        let sample = |i: u32| {
            let t = f64::from(i) / 100.0;
            let (whole, rest) = ((t / 3.0).floor(), t % 3.0);
            let angle = 1.2 * (whole + (rest - 2.0).max(0.0));
            let noise = 0.02 * f64::from(i * 7919 % 100) / 100.0;
            Sample {
                time_us: u64::from(i) * 10_000,
                specific_force: [noise, 9.8 * angle.sin(), 9.8 * angle.cos() + noise],
                angular_rate: [if rest > 2.0 { 1.2 } else { 0.03 }, noise * 0.1, 0.0],
            }
        };
        (0..300 * turns).map(sample).collect()
    }

    #[test]
    fn each_stand_is_found_once_and_without_its_ends() {
        let samples = held(6);
        let found = stands(&samples, 1.0);
        assert_eq!(found.len(), 6);
        for (i, stand) in found.iter().enumerate() {
            let (begin, end) = (300 * i, 300 * i + 200);
            assert!(stand.samples.start >= begin && stand.samples.end <= end, "{i}: {stand:?}");
            assert!((1.5..2.0).contains(&stand.seconds), "{stand:?}");
        }
        assert_eq!(stands(&samples, 2.5), []);
    }

    #[test]
    fn a_turn_about_the_vertical_is_no_stand() {
        let mut samples = held(6);
        for sample in &mut samples {
            sample.specific_force = [0.1, 0.2, 9.8];
            let turns = sample.angular_rate[0] > 1.0;
            sample.angular_rate = [0.03, 0.0, if turns { 1.2 } else { 0.0 }];
        }
        let found = stands(&samples, 0.5);
        assert_eq!(found.len(), 6);
        assert!(found.iter().all(|stand| stand.samples.end % 300 <= 200), "{found:?}");
    }

    #[test]
    fn what_turns_slowly_is_no_stand() {
        let mut samples = held(4);
        for (i, sample) in samples.iter_mut().enumerate() {
            let angle = 0.05 * i as f64 / 100.0;
            sample.specific_force = [0.0, 9.8 * angle.sin(), 9.8 * angle.cos()];
            sample.angular_rate = [0.05, 0.0, 0.0];
        }
        assert_eq!(stands(&samples, 1.0), []);
        assert_eq!(stands(&[], 1.0), []);
        assert_eq!(stands(&samples[..1], 1.0), []);
    }
}
