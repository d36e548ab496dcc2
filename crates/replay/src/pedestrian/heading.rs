//! Correction of the heading of a recorded walk by a magnetometer, where the foot stands twice at the same place.

use kestirim_pedestrian::{Ekf, MagneticHeading, OfflineTracker, PathUncertainty};
use nalgebra::SVector;

use super::walk::imu_sample;
use super::{Options, Sample, Walk, position_at};

/// Standard deviation of the position of a foot that returns to an earlier place, m.
const PUT_BACK: f64 = 0.1;

/// The rate at which the heading of a walk drifts, rad/s, if the magnetometer shows it; an error if the field turns as
/// no gyroscope of this class does.
fn heading_rate(
    samples: &[Sample],
    field: &[[f64; 3]],
    options: &Options,
) -> Result<Option<f64>, String> {
    let Some(rate) = shown(samples, field, options) else { return Ok(None) };
    if options.config::<f64>().sensor.drifts_by(rate) {
        return Ok(Some(rate));
    }
    Err(format!(
        "the magnetometer is not used: where the foot stood twice its field turned by {:.0} °/min, faster than gyroscopes \
         of this class drift: iron came near, or it is stuck, or the class is another (--sensor)",
        60.0 * rate.abs().to_degrees()
    ))
}

fn shown(samples: &[Sample], field: &[[f64; 3]], options: &Options) -> Option<f64> {
    let samples: Vec<_> = samples.iter().map(imu_sample::<f64>).collect();
    let config = options.config();
    let mut energy = vec![0.0; samples.len()];
    let mut tracker = OfflineTracker::<f64, Ekf<f64>>::new(config, &samples, &mut energy).ok()?;
    let (mut heading, mut uncertainty) =
        (MagneticHeading::default(), PathUncertainty::new(config.sensor));
    let mut deviation = PUT_BACK;
    for (sample, field) in samples.iter().zip(field) {
        let estimate = tracker.next()?;
        if let Some(stride) = &estimate.stride {
            uncertainty.add(stride);
            let [x, y, _] = uncertainty.standard_deviation().into();
            deviation = x.hypot(y).hypot(PUT_BACK);
        }
        heading.update(sample, &estimate, Some(&SVector::from(*field)), deviation);
    }
    heading.finish(deviation);
    heading.rate()
}

impl Walk {
    /// Removes the drift of the heading if the log's magnetometer shows it, or warns why not.
    ///
    /// The `field` is measured at each sample, in body axes and any unit, and `NaN` where it was not measured.
    pub fn correct_heading(&mut self, samples: &[Sample], field: &[[f64; 3]], options: &Options) {
        match heading_rate(samples, field, options) {
            Ok(Some(rate)) => self.turn_back(rate),
            Ok(None) => {}
            Err(refused) => self.warnings.push(refused),
        }
    }

    /// Turns each step back by the accumulated drift of the heading at this rate, rad/s.
    pub fn turn_back(&mut self, rate: f64) {
        let Some(first) = self.track.first().copied() else { return };
        let (mut before, mut now) = (first.position, first.position);
        for point in &mut self.track {
            let (sine, cosine) = (-rate * (point.time_us - first.time_us) as f64 * 1e-6).sin_cos();
            let [dx, dy] = [point.position[0] - before[0], point.position[1] - before[1]];
            before = point.position;
            now = [now[0] + cosine * dx - sine * dy, now[1] + sine * dx + cosine * dy, before[2]];
            point.position = now;
        }
        for stride in &mut self.strides {
            stride.position = position_at(&self.track, stride.time_us).unwrap_or(stride.position);
            stride.heading_change_rad -= rate * stride.duration_s;
        }
        self.closure_m = now[0].hypot(now[1]);
        self.heading_rate = Some(self.heading_rate.unwrap_or(0.0) + rate);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pedestrian::TrackPoint;

    #[test]
    fn a_drift_is_turned_back() {
        // A circle walked at a constant rate, with a drifting heading.
        let drift = 0.001;
        let mut at = [0.0, 0.0];
        let track = (0..=100).map(|k| {
            let heading = (0.01 * std::f64::consts::TAU + drift) * f64::from(k);
            let position = [at[0], at[1], 0.0];
            at = [at[0] + heading.cos(), at[1] + heading.sin()];
            TrackPoint { time_us: 1_000_000 * u64::try_from(k).expect("a time"), position }
        });
        let mut walk = Walk { track: track.collect(), ..Walk::default() };
        // A step is turned by the drift at its end, one step late.
        walk.turn_back(drift);
        assert!(walk.closure_m < 0.01, "{} m", walk.closure_m);
        assert_eq!(walk.heading_rate, Some(drift));
    }
}
