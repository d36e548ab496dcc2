//! Recorded walks slowed down: the same footprints at a slower pace.

use host_sim::systems::pedestrian::recording::log;
use kestirim_replay::pedestrian::{Options, Sample, SensorClass, walk};
use kestirim_tests::recordings::{self, gcp};
use nalgebra::Vector3;

/// The samples of a walk that is slower by the factor `slower`: angular rates decrease by the factor, and the specific
/// force without gravity by its square.
fn slowed(samples: &[Sample], slower: f64) -> Vec<Sample> {
    let start = &samples[50..150];
    let mean = |of: fn(&Sample) -> [f64; 3]| {
        start.iter().map(|it| Vector3::from(of(it))).sum::<Vector3<f64>>() / start.len() as f64
    };
    let bias = mean(|it| it.angular_rate);
    let gravity = mean(|it| it.specific_force).norm();
    let forwards = verticals(samples.iter(), (bias, gravity));
    let backwards = verticals(samples.iter().rev(), (bias, gravity));
    let ups = forwards.iter().zip(backwards.iter().rev()).map(|(a, b)| (a + b).normalize());
    let slow = |(sample, up): (&Sample, Vector3<f64>)| {
        let (force, weight) = (Vector3::from(sample.specific_force), up * gravity);
        let rate = Vector3::from(sample.angular_rate) - bias;
        Sample {
            time_us: (sample.time_us as f64 * slower) as u64,
            specific_force: (weight + (force - weight) / (slower * slower)).into(),
            angular_rate: (bias + rate / slower).into(),
        }
    };
    samples.iter().zip(ups).map(slow).collect()
}

/// The vertical at each sample, as the gyroscope propagates it and standstills correct it, in either direction of time.
fn verticals<'a>(
    samples: impl Iterator<Item = &'a Sample>,
    (bias, gravity): (Vector3<f64>, f64),
) -> Vec<Vector3<f64>> {
    let mut before: Option<(f64, Vector3<f64>)> = None;
    let step = |sample: &Sample| {
        let (t, force) = (sample.time_us as f64 * 1e-6, Vector3::from(sample.specific_force));
        let rate = Vector3::from(sample.angular_rate) - bias;
        let (last, mut up) = before.unwrap_or((t, force));
        up += up.cross(&rate) * (t - last);
        if rate.norm() < 0.6 && (force.norm() - gravity).abs() < 0.4 {
            up += (force.normalize() - up) * 0.03;
        }
        up.normalize_mut();
        before = Some((t, up));
        up
    };
    samples.map(step).collect()
}

/// One stride in two seconds.
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
