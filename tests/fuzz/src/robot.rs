//! Feeds arbitrary ranges, accelerations and wheel speeds of a tag to the tracker, in three number types: each is
//! refused, or the estimate stays finite.

use arbitrary::{Result, Unstructured};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_tracker::{Anchor, Config, InertialSample, OdometrySample, RangeSample, Tracker};
use nalgebra::Vector3;

use super::{later, number};

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 2.0], [8.0, 0.0, 0.3], [8.0, 6.0, 2.0], [0.0, 6.0, 0.3]];

fn feed_in<T: Scalar, const D: usize, const N: usize>(
    config: Config<T>,
    bytes: &[u8],
) -> Result<()> {
    let anchors = CORNERS
        .map(|place| Anchor { position: Vector3::from(place.map(T::from_f64)), bias: T::ZERO });
    let mut tracker = Tracker::<T, D, N, 4>::new(config, &anchors).expect("a room");
    let (mut bytes, mut time_us) = (Unstructured::new(bytes), 1_000_000_u64);
    while !bytes.is_empty() {
        time_us = time_us.saturating_add_signed(later(&mut bytes, 25_000)?);
        // A refused sample leaves the tracker unchanged.
        let _ = match bytes.arbitrary::<u8>()? {
            0..200 => {
                let anchor = usize::from(bytes.arbitrary::<u8>()? % 5);
                let range = T::from_f64(number(&mut bytes, 12.0)?.abs());
                tracker.range(&RangeSample { time_us, anchor, range }).map(drop)
            }
            200..230 => {
                let [x, y] =
                    [number(&mut bytes, 20.0)?, number(&mut bytes, 20.0)?].map(T::from_f64);
                let acceleration = Vector3::new(x, y, T::from_f64(9.81));
                let push = bytes.arbitrary::<bool>()?.then_some([x; D]);
                tracker.inertial(&InertialSample { time_us, acceleration, push }).map(drop)
            }
            230.. => {
                let speed = T::from_f64(number(&mut bytes, 2.0)?);
                let turn_rate = T::from_f64(number(&mut bytes, 3.0)?);
                tracker.odometry(&OdometrySample { time_us, speed, turn_rate }).map(drop)
            }
        };
        if let Some(estimate) = tracker.estimate() {
            assert!(estimate.mean.iter().all(|x| x.is_finite()));
            let covariance = estimate.covariance.to_matrix();
            assert!(covariance.diagonal().iter().all(|variance| *variance > T::ZERO));
        }
    }
    Ok(())
}

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let _ = feed_in::<f64, 2, 4>(Config::calibrated(1.0), bytes);
    let _ = feed_in::<f32, 2, 5>(Config::uncalibrated(1.0), bytes);
    let _ = feed_in::<f32, 3, 6>(Config::calibrated(1.0), bytes);
    let _ = feed_in::<Q12_20, 2, 4>(Config::calibrated(Q12_20::ONE), bytes);
}
