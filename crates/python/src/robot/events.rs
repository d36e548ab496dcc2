//! What the sensors say, in the order in which a tracker takes it: as `host-sim` reads it from files.

use pyo3::PyResult;

use crate::arrays::microseconds;
use crate::error::refused_at;

/// Ranges in the order of their log, of which one that did not come is not a number; and the tag's height over time.
pub(super) struct Rows<'a> {
    pub(super) t: &'a [f64],
    pub(super) anchor: &'a [i64],
    pub(super) range: &'a [f64],
    pub(super) heights: Option<(&'a [f64], &'a [f64])>,
}

impl Rows<'_> {
    /// Refuses what no log can mean.
    pub(super) fn check(&self, anchors: usize) -> PyResult<()> {
        for (index, (t, anchor)) in self.t.iter().zip(self.anchor).enumerate() {
            if t.is_nan() || t.abs() > 1e12 {
                return Err(refused_at(index, format!("expected a time in s, found {t}")));
            }
            if !(0..anchors as i64).contains(anchor) {
                let sentence =
                    format!("expected an anchor from 0 to {}, found {anchor}", anchors - 1);
                return Err(refused_at(index, sentence));
            }
        }
        Ok(())
    }

    /// Times, µs, and their rows, without those far ahead of what follows them.
    pub(super) fn times_us(&self) -> Vec<(i64, usize)> {
        let rows = self.t.iter().enumerate().map(|(row, t)| (microseconds(*t), row));
        without_far_ahead(rows.collect())
    }

    /// The height at a time (µs), m: in between linear, beyond the ends what is known there.
    pub(super) fn height_at(&self, time_us: i64) -> Option<f64> {
        let (t, z) = self.heights?;
        let us = |index: usize| microseconds(t[index]);
        let time_us = time_us.clamp(microseconds(*t.first()?), microseconds(*t.last()?));
        let after = t.partition_point(|t| microseconds(*t) < time_us);
        let next = *z.get(after)?;
        let Some(before) = after.checked_sub(1) else { return Some(next) };
        let share = (time_us - us(before)) as f64 / (us(after) - us(before)).max(1) as f64;
        Some(z[before] + share * (next - z[before]))
    }
}

/// Later samples may go back behind a time by this, µs; one that they go back behind farther was wrong, and would make
/// everything after it too late.
const LARGEST_STEP_BACK_US: i64 = 10_000_000;

fn without_far_ahead<S>(mut samples: Vec<(i64, S)>) -> Vec<(i64, S)> {
    let mut earliest_us = i64::MAX;
    let mut kept = Vec::with_capacity(samples.len());
    while let Some((time_us, sample)) = samples.pop() {
        if time_us.saturating_sub(LARGEST_STEP_BACK_US) <= earliest_us {
            earliest_us = earliest_us.min(time_us);
            kept.push((time_us, sample));
        }
    }
    kept.reverse();
    kept
}

/// A sample of IMU or wheels.
#[derive(Clone, Copy)]
pub(super) enum Moved {
    /// Acceleration, m/s², body.
    Accelerated([f64; 3]),
    /// Speed, m/s, and turn rate, rad/s.
    Rolled([f64; 2]),
}

/// Samples of IMU and wheels in the order of their times, µs.
#[derive(Default)]
pub(super) struct Motion {
    pub(super) samples: Vec<(i64, Moved)>,
    wheels: bool,
}

impl Motion {
    pub(super) fn add_imu(&mut self, t: &[f64], accel: &[[f64; 3]]) {
        let sample = |(t, accel): (&f64, &[f64; 3])| (microseconds(*t), Moved::Accelerated(*accel));
        self.samples.extend(without_far_ahead(t.iter().zip(accel).map(sample).collect()));
    }

    /// No sensor's own samples are reordered; of two at the same time the IMU's comes first.
    pub(super) fn add_wheels(&mut self, t: &[f64], speed: &[f64], turn_rate: &[f64]) {
        self.wheels |= !t.is_empty();
        let mut first = std::mem::take(&mut self.samples).into_iter().peekable();
        let sample = |((t, speed), turn_rate): ((&f64, &f64), &f64)| {
            (microseconds(*t), Moved::Rolled([*speed, *turn_rate]))
        };
        let rolled = t.iter().zip(speed).zip(turn_rate).map(sample).collect();
        for (time_us, rolled) in without_far_ahead(rolled) {
            while let Some(before) = first.next_if(|(before_us, _)| *before_us <= time_us) {
                self.samples.push(before);
            }
            self.samples.push((time_us, rolled));
        }
        self.samples.extend(first);
    }

    pub(super) fn has_wheels(&self) -> bool {
        self.wheels
    }
}
