//! The heading of a recorded walk, corrected by a magnetometer where the foot stands twice at the same place.

use kestirim_pedestrian::{Ekf, MagneticHeading, OfflineTracker, PathUncertainty};
use nalgebra::SVector;

use super::{Log, Options, Walk};

/// Standard deviation of where a foot stands that is put back to where it stood, m.
const PUT_BACK: f64 = 0.1;

/// The rate at which the heading of a walk drifts, rad/s, where the magnetometer shows it; none of a log that no tracker
/// takes, which its own tracker tells.
pub(super) fn rate(log: &Log<'_>, field: &[[f64; 3]], options: Options) -> Option<f64> {
    let (config, samples) = (options.config::<f64>(), log.samples::<f64>().ok()?);
    let mut memory = vec![0.0; samples.len()];
    let mut tracker = OfflineTracker::<f64, Ekf<f64>>::new(config, &samples, &mut memory).ok()?;
    let (mut heading, mut uncertainty) =
        (MagneticHeading::default(), PathUncertainty::new(config.sensor));
    let mut deviation = PUT_BACK;
    for (sample, field) in samples.iter().zip(field) {
        let estimate = tracker.next()?;
        if let Some(stride) = &estimate.stride {
            uncertainty.add(stride);
            let [x, y, _] = uncertainty.standard_deviation().into();
            deviation = f64::hypot(x, y).hypot(PUT_BACK);
        }
        heading.update(sample, &estimate, Some(&SVector::from(*field)), deviation);
    }
    heading.finish(deviation);
    heading.rate()
}

impl Walk {
    /// Turns each step back by how far the heading has drifted until then, at this rate, rad/s.
    pub(super) fn turn_back(&mut self, rate: f64) {
        let (Some(&first), Some(&first_us)) = (self.position.first(), self.time_us.first()) else {
            return;
        };
        let (mut before, mut now) = (first, first);
        for (position, time_us) in self.position.iter_mut().zip(&self.time_us) {
            let (sine, cosine) = (-rate * (time_us - first_us) as f64 * 1e-6).sin_cos();
            let [dx, dy] = [position[0] - before[0], position[1] - before[1]];
            before = *position;
            now = [now[0] + cosine * dx - sine * dy, now[1] + sine * dx + cosine * dy, before[2]];
            *position = now;
        }
        let mut strides = std::mem::take(&mut self.strides);
        for stride in &mut strides {
            if let Some(position) = self.position_at(stride.time_us) {
                stride.position = position.into();
            }
            stride.heading_change -= rate * stride.duration;
        }
        self.strides = strides;
        self.heading_rate = Some(rate);
    }

    /// The position at a time, interpolated linearly between neighbours and held beyond the ends.
    fn position_at(&self, time_us: u64) -> Option<[f64; 3]> {
        let after = self.time_us.partition_point(|other| *other <= time_us);
        let next = if after < self.time_us.len() { after } else { after.checked_sub(1)? };
        let before = after.saturating_sub(1);
        let (from, to) = (self.position.get(before)?, self.position.get(next)?);
        let span = self.time_us[next] - self.time_us[before];
        if span == 0 {
            return Some(*from);
        }
        let share = (time_us - self.time_us[before]) as f64 / span as f64;
        Some(std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis])))
    }
}
