//! Precise orbits: interpolation between samples.

use crate::GpsTime;
use crate::constants::EARTH_ROTATION;
use nalgebra::Vector3;

/// The number of samples that a polynomial goes through: degree 10 follows a GPS orbit sampled every 15 minutes to
/// millimetres.
const POINTS: usize = 11;
/// How far the polynomial is extrapolated beyond the samples, s.
const BEYOND: f64 = 1.0;

/// One sample of a precise orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OrbitSample {
    /// Seconds since the orbit's reference instant.
    pub second: f64,
    /// The centre of mass, m, in the inertial frame that coincides with the Earth-fixed one at the reference instant,
    /// in which an orbit is smooth.
    pub position: Vector3<f64>,
}

impl OrbitSample {
    /// Converts a position of the centre of mass (ECEF at `time`, m) to a sample of an orbit with this reference.
    pub fn from_ecef(reference: GpsTime, time: GpsTime, position: &Vector3<f64>) -> Self {
        let second = time.since(reference);
        Self { second, position: rotated(position, EARTH_ROTATION * second) }
    }
}

/// The position and velocity of a satellite's centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OrbitState {
    /// The position, m, ECEF at the requested instant.
    pub position: Vector3<f64>,
    /// The velocity, m/s, in the inertial frame that coincides with the ECEF one at that instant.
    pub velocity: Vector3<f64>,
}

/// A satellite's precise orbit: samples in chronological order.
#[derive(Clone, Copy, Debug)]
pub struct Orbit<'a> {
    /// The reference instant of the samples' times.
    pub reference: GpsTime,
    /// The samples, in ascending order of time.
    pub samples: &'a [OrbitSample],
}

impl Orbit<'_> {
    /// The state at `time`, from the polynomial through the 11 nearest samples.
    ///
    /// `None` where one of the 11 is missing, or more than a second outside the samples; the second is needed because
    /// what is received at the time of the first sample was sent before it.
    pub fn at(&self, time: GpsTime) -> Option<OrbitState> {
        let second = time.since(self.reference);
        let (first, last) = (self.samples.first()?.second, self.samples.last()?.second);
        if !(first - BEYOND..=last + BEYOND).contains(&second) {
            return None;
        }
        let after = self.samples.partition_point(|sample| sample.second <= second);
        let start =
            after.saturating_sub(POINTS / 2 + 1).min(self.samples.len().checked_sub(POINTS)?);
        let window = self.samples.get(start..)?.first_chunk::<POINTS>()?;
        let step = window[1].second - window[0].second;
        let complete = window.windows(2).all(|pair| match pair {
            [earlier, later] => (later.second - earlier.second - step).abs() < 1e-3,
            _ => false,
        });
        if !(complete && step > 0.0) {
            return None;
        }
        let (position, velocity) = through(window, (second - window[0].second) / step);
        let angle = -EARTH_ROTATION * second;
        Some(OrbitState {
            position: rotated(&position, angle),
            velocity: rotated(&velocity, angle) / step,
        })
    }
}

/// Evaluates the polynomial through equidistant samples and its derivative, `place` steps after the first.
fn through(samples: &[OrbitSample; POINTS], place: f64) -> (Vector3<f64>, Vector3<f64>) {
    /// Barycentric weights of equidistant points: binomials of alternating sign.
    const WEIGHTS: [f64; POINTS] =
        [1.0, -10.0, 45.0, -120.0, 210.0, -252.0, 210.0, -120.0, 45.0, -10.0, 1.0];
    let mut position = Vector3::zeros();
    let mut velocity = Vector3::zeros();
    let (mut sum, mut slope) = (0.0, 0.0);
    // Positions are relative to the nearest sample: beside it, where its share grows without bounds, all digits count.
    let nearest = (place + 0.5).clamp(0.0, POINTS as f64 - 1.0) as usize;
    let origin = samples.get(nearest).map_or_else(Vector3::zeros, |sample| sample.position);
    for (index, (sample, weight)) in samples.iter().zip(WEIGHTS).enumerate() {
        let distance = place - index as f64;
        // On a sample the formula is 0/0, but not an attostep beside it.
        let distance = if distance.abs() < 1e-18 { 1e-18 } else { distance };
        let share = weight / distance;
        let relative = sample.position - origin;
        sum += share;
        slope -= share / distance;
        position += relative * share;
        velocity -= relative * (share / distance);
    }
    let position = position / sum;
    (origin + position, (velocity - position * slope) / sum)
}

/// `vector` turned about the Earth's axis by `angle` rad, east positive.
fn rotated(vector: &Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(angle);
    Vector3::new(cosine * vector.x - sine * vector.y, sine * vector.x + cosine * vector.y, vector.z)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    const REFERENCE: GpsTime = GpsTime::new_in_day(59_025, 0.0);
    const RADIUS: f64 = 26_560e3;
    /// rad/s
    const MEAN_MOTION: f64 = 1.458_5e-4;

    fn inertial(second: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (sine, cosine) = (MEAN_MOTION * second).sin_cos();
        (
            Vector3::new(cosine, sine * 0.57, sine * 0.82) * RADIUS,
            Vector3::new(-sine, cosine * 0.57, cosine * 0.82) * (RADIUS * MEAN_MOTION),
        )
    }

    fn samples() -> Vec<OrbitSample> {
        (0..97)
            .map(|index| {
                let second = 900.0 * f64::from(index);
                let ecef = rotated(&inertial(second).0, -EARTH_ROTATION * second);
                OrbitSample::from_ecef(REFERENCE, REFERENCE.plus(second), &ecef)
            })
            .collect()
    }

    #[test]
    fn a_circular_orbit_is_followed_to_a_micrometre() {
        let samples = samples();
        let orbit = Orbit { reference: REFERENCE, samples: &samples };
        for second in [4_500.0, 30_000.0, 43_650.3, 45_000.0, 80_000.0] {
            let state = orbit.at(REFERENCE.plus(second)).unwrap();
            let (position, velocity) = inertial(second);
            let angle = -EARTH_ROTATION * second;
            let missed = (state.position - rotated(&position, angle)).norm();
            assert!(missed < 1e-5, "{second} {missed}");
            let missed = (state.velocity - rotated(&velocity, angle)).norm();
            assert!(missed < 1e-5, "{second} {missed}");
        }
    }

    #[test]
    fn there_is_no_orbit_outside_of_the_samples_or_across_a_gap() {
        let mut samples = samples();
        let at = |samples: &[OrbitSample], second| {
            Orbit { reference: REFERENCE, samples }.at(REFERENCE.plus(second)).is_some()
        };
        assert!(!at(&samples, -1.1) && at(&samples, -0.9) && at(&samples, 86_400.9));
        assert!(!at(&samples, 86_401.1) && !at(&samples, f64::NAN) && !at(&samples[..10], 900.0));
        samples.remove(50);
        assert!(!at(&samples, 45_000.0) && at(&samples, 80_000.0));
    }
}
