//! Recorded walks as a slow walker would have walked them: the same footprints, at a slower pace.

use host_sim::systems::pedestrian::recording::log;
use kestirim_replay::pedestrian::{Options, Sample, SensorClass, walk};
use kestirim_tests::recordings::{self, gcp};
use nalgebra::Vector3;

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;

/// What the sensor would have measured `slower` times as slow: rates fall as much, and with its square all of the force that is
/// not gravity's.
fn slowed(samples: &[Sample], slower: f64) -> Vec<Sample> {
    let bias = mean_rate(&samples[..samples.len().min(400)]);
    let mut up = Vector3::from(samples[0].specific_force).normalize();
    let mut last_us = samples[0].time_us;
    let mut slow = Vec::with_capacity(samples.len());
    for sample in samples {
        let force = Vector3::from(sample.specific_force);
        let rate = Vector3::from(sample.angular_rate) - bias;
        let seconds = (sample.time_us - last_us) as f64 / 1e6;
        last_us = sample.time_us;
        // The gyroscope carries the vertical, and each standstill corrects it.
        up += up.cross(&rate) * seconds;
        if rate.norm() < 0.3 && (force.norm() - GRAVITY).abs() < 0.3 {
            up += (force.normalize() - up) * seconds.min(1.0) * 5.0;
        }
        up.normalize_mut();
        let weight = up * GRAVITY;
        slow.push(Sample {
            time_us: (sample.time_us as f64 * slower) as u64,
            specific_force: (weight + (force - weight) / (slower * slower)).into(),
            angular_rate: (bias + rate / slower).into(),
        });
    }
    slow
}

fn mean_rate(samples: &[Sample]) -> Vector3<f64> {
    let sum: Vector3<f64> = samples.iter().map(|it| Vector3::from(it.angular_rate)).sum();
    sum / samples.len() as f64
}

/// A stride in two seconds.
#[test]
fn a_slow_walker_walks_as_far() {
    let Some(folder) = recordings::folder() else { return };
    for (file, _) in gcp(&folder, &[36, 46, 57, 72]) {
        let samples = log::read(&file, &log::Options::default()).expect("a log").samples;
        let options = Options { sensor: SensorClass::Industrial, ..Options::default() };
        let usual = walk(&samples, &options).expect("a walk");
        let slow = walk(&slowed(&samples, 1.7), &options).expect("a walk");
        let short = 1.0 - slow.path_length_m / usual.path_length_m;
        println!(
            "{}: {:.1} % shorter in {} strides in place of {}",
            file.display(),
            100.0 * short,
            slow.strides.len(),
            usual.strides.len()
        );
        assert!(short.abs() <= 0.015, "{}: {short}", file.display());
        assert_eq!(slow.strides.len(), usual.strides.len(), "{}", file.display());
    }
}
