//! Feeds an arbitrary flight to filter and observer, in three number types: each sample is refused, or the state stays
//! finite.

use arbitrary::{Result, Unstructured};
use kestirim_observer_design::Complex;
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{Dynamics, FlightFilter, FlightObserver, Noise, Sample};
use kestirim_uav_longitudinal::{rate_airspeed_and_pitch, thesis_like};
use nalgebra::{Vector2, Vector3};

use super::{later, number};

const USUAL_S: f64 = 0.01;

fn feed_in<T: Scalar>(bytes: &[u8]) -> Result<()> {
    let (dynamics, c) = (Dynamics::Continuous(thesis_like()), rate_airspeed_and_pitch());
    let noise =
        Noise { inputs: Vector2::new(0.009, 0.02), outputs: Vector3::new(0.009, 0.5, 0.009) };
    let poles = [-3.0, -3.5, -4.0, -4.5].map(|pole: f64| Complex::from((pole * USUAL_S).exp()));
    let mut filter = FlightFilter::<T, 3>::new(&dynamics, &c, &noise, USUAL_S).expect("a filter");
    let mut observer =
        FlightObserver::<T, 3>::new(&dynamics, &c, &poles, USUAL_S).expect("an observer");
    let (mut bytes, mut time_us) = (Unstructured::new(bytes), 1_000_000_i64);
    while !bytes.is_empty() {
        time_us = time_us.saturating_add(later(&mut bytes, 10_000)?);
        let input = Vector2::new(number(&mut bytes, 0.5)?, number(&mut bytes, 1.0)?);
        let mut measured = [None; 3];
        for (output, scale) in measured.iter_mut().zip([8.7, 100.0, 3.1]) {
            if bytes.ratio(7, 8)? {
                *output = Some(number(&mut bytes, scale)?);
            }
        }
        let sample = Sample { time_us, input, measured };
        // A refused sample leaves both unchanged.
        let (_, _) = (filter.take(&sample), observer.take(&sample));
        let (estimate, sigma) = (filter.filter().estimate(), filter.filter().sigma());
        assert!(estimate.iter().chain(sigma.iter()).all(|x| x.is_finite()));
        assert!(observer.estimate().iter().all(|x| x.is_finite()));
    }
    Ok(())
}

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let _ = feed_in::<f32>(bytes);
    let _ = feed_in::<f64>(bytes);
    let _ = feed_in::<Q16_16>(bytes);
}
