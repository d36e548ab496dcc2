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
                let sentence = format!("expected an anchor from 0 to {}, found {anchor}", anchors - 1);
                return Err(refused_at(index, sentence));
            }
        }
        Ok(())
    }

    /// Times, µs.
    pub(super) fn times_us(&self) -> Vec<i64> {
        self.t.iter().map(|t| microseconds(*t)).collect()
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
        self.samples.extend(t.iter().zip(accel).map(sample));
    }

    /// No sensor's own samples are reordered; of two at the same time the IMU's comes first.
    pub(super) fn add_wheels(&mut self, t: &[f64], speed: &[f64], turn_rate: &[f64]) {
        self.wheels |= !t.is_empty();
        let mut first = std::mem::take(&mut self.samples).into_iter().peekable();
        for ((t, speed), turn_rate) in t.iter().zip(speed).zip(turn_rate) {
            let time_us = microseconds(*t);
            while let Some(before) = first.next_if(|(before_us, _)| *before_us <= time_us) {
                self.samples.push(before);
            }
            self.samples.push((time_us, Moved::Rolled([*speed, *turn_rate])));
        }
        self.samples.extend(first);
    }

    pub(super) fn has_wheels(&self) -> bool {
        self.wheels
    }
}
