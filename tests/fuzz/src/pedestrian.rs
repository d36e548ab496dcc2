//! Feeds arbitrary samples of a foot to the pedestrian filters, in three number types: each is refused, or the estimate
//! stays finite.

use arbitrary::{Result, Unstructured};
use kestirim_pedestrian::{Config, EkfTracker, ImuSample, LiteTracker};
use kestirim_scalar::{Q12_20, Scalar};
use nalgebra::Vector3;

use super::{later, number};

type Sample = (u64, [f64; 6]);

fn samples(bytes: &[u8]) -> Result<Vec<Sample>> {
    let (mut bytes, mut time_us, mut samples) =
        (Unstructured::new(bytes), 1_000_000_u64, Vec::new());
    while !bytes.is_empty() {
        time_us = time_us.saturating_add_signed(later(&mut bytes, 10_000)?);
        let mut axes = [0.0; 6];
        for (index, axis) in axes.iter_mut().enumerate() {
            *axis = number(&mut bytes, if index < 3 { 160.0 } else { 35.0 })?;
        }
        // Repeating a sample creates standstills and stalls from few bytes.
        for _ in 0..=bytes.arbitrary::<u8>()? {
            samples.push((time_us, axes));
            time_us = time_us.saturating_add(10_000);
        }
    }
    Ok(samples)
}

fn feed_in<T: Scalar>(samples: &[Sample]) {
    let mut ekf = EkfTracker::<T>::new(Config::default());
    let mut lite = LiteTracker::<T>::new(Config::default());
    for &(time_us, [ax, ay, az, gx, gy, gz]) in samples {
        let vector = |x, y, z| Vector3::new(T::from_f64(x), T::from_f64(y), T::from_f64(z));
        let (specific_force, angular_rate) = (vector(ax, ay, az), vector(gx, gy, gz));
        let sample = ImuSample { time_us, specific_force, angular_rate };
        let updates = [ekf.update(&sample), lite.update(&sample)];
        let ranges = [ekf.warnings(), lite.warnings()].map(|warnings| warnings.out_of_range);
        for (update, out_of_range) in updates.into_iter().zip(ranges) {
            let Ok(estimate) = update else { continue };
            let mut numbers = estimate.position.iter().chain(estimate.velocity.iter());
            // A fixed-point number at the end of its range does not count as finite.
            assert!(out_of_range || numbers.all(|x| x.is_finite()));
        }
    }
    // A length that has reached the end of the range does not count as finite either.
    assert!(ekf.warnings().out_of_range || ekf.path_length().is_finite());
    assert!(lite.warnings().out_of_range || lite.path_length().is_finite());
}

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let Ok(samples) = samples(bytes) else { return };
    feed_in::<f32>(&samples);
    feed_in::<f64>(&samples);
    feed_in::<Q12_20>(&samples);
}
