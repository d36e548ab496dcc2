//! Which class a sensor is of, from what its gyroscope shows at rest.

use kestirim_pedestrian::{Config, LiteTracker, SensorClass};

use super::imu_sample;
use crate::systems::pedestrian::Sample;
use crate::systems::pedestrian::recording::Recording;

/// A calibrated unit's gyroscope is off by less, rad/s. At rest those of the walks in the book were off by 1 to
/// 9 mrad/s, bare chips by 15 to 21.
const CALIBRATED: f64 = 0.012;

/// The class of a recording's sensor, looked for once; that of bare chips if it never stood still. Truth is not asked.
pub(in crate::systems::pedestrian) fn class_of(recording: &Recording) -> SensorClass {
    *recording.class.get_or_init(|| of_samples(&recording.log.samples))
}

fn of_samples(samples: &[Sample]) -> SensorClass {
    // The tracker learns the bias at each standstill.
    let mut tracker = LiteTracker::<f64>::new(Config::default());
    for sample in samples {
        // A sample that it does not take is told by the tracker of the class.
        let _ = tracker.update(&imu_sample(sample));
    }
    let is_calibrated = tracker.alignment().gyro_bias().norm() < CALIBRATED;
    if is_calibrated && !tracker.warnings().never_still {
        SensorClass::Industrial
    } else {
        SensorClass::Consumer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bias_at_rest_tells_the_class() {
        let still = |bias: f64| {
            let sample = |k: u64| Sample {
                time_us: 10_000 * k,
                specific_force: [0.0, 0.02, 9.8],
                angular_rate: [bias, 0.001 * (k % 3) as f64, 0.0],
            };
            (0..300).map(sample).collect::<Vec<_>>()
        };
        assert_eq!(of_samples(&still(0.004)), SensorClass::Industrial);
        assert_eq!(of_samples(&still(0.02)), SensorClass::Consumer);
        assert_eq!(of_samples(&[]), SensorClass::Consumer);
    }
}
