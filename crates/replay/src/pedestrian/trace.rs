//! Traces of walks: velocity and stance at every sample, and the result without zero-velocity updates.

use kestirim_pedestrian::detector::{Adaptive, Motion, StanceDetector, Verdict};
use kestirim_scalar::Scalar;

use super::{Error, Options, Sample, Walk};

/// The estimate for one sample, beside the position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// The velocity in the room frame, m/s.
    pub velocity: [f64; 3],
    /// The quaternion from body to room: w, x, y, z.
    pub orientation: [f64; 4],
    /// Whether the foot stands.
    pub stance: bool,
}

/// A callback for every [`Moment`] of a walk, in order.
pub(super) type See<'a> = dyn FnMut(Moment) + 'a;

/// The times at which zero-velocity updates are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Updates {
    /// Whenever the chosen detector finds that the foot stands.
    InStance,
    /// Until the foot is lifted for the first time.
    OnlyAtStart,
}

/// A walk and its moments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// The walk, as [`walk`](super::walk) returns it.
    pub walk: Walk,
    /// The moments, one for every position of the track.
    pub moments: Vec<Moment>,
}

impl Trace {
    /// Turns velocities and orientations as the track was turned after the walk ([`Walk::correct_heading`] and others): call it
    /// once, after the last correction.
    pub fn turn_moments(&mut self) {
        let (Some(rate), Some(first)) = (self.walk.heading_rate, self.walk.track.first()) else {
            return;
        };
        for (moment, point) in self.moments.iter_mut().zip(&self.walk.track) {
            let angle = -rate * (point.time_us - first.time_us) as f64 * 1e-6;
            let (sine, cosine) = angle.sin_cos();
            let [x, y, z] = moment.velocity;
            moment.velocity = [cosine * x - sine * y, sine * x + cosine * y, z];
            // A turn about the vertical before that of the body.
            let (sine, cosine) = (0.5 * angle).sin_cos();
            let [w, x, y, z] = moment.orientation;
            moment.orientation = [
                cosine * w - sine * z,
                cosine * x - sine * y,
                cosine * y + sine * x,
                cosine * z + sine * w,
            ];
        }
    }
}

/// Tracks a walk and keeps every moment of it.
///
/// # Errors
/// Those of [`walk`](super::walk).
pub fn trace(samples: &[Sample], options: &Options) -> Result<Trace, Error> {
    keep(samples, options, Updates::InStance)
}

/// Tracks a walk without zero-velocity updates: the standstill before the walk is used, but no later stance.
///
/// # Errors
/// Those of [`walk`](super::walk).
pub fn without_updates(samples: &[Sample], options: &Options) -> Result<Trace, Error> {
    keep(samples, options, Updates::OnlyAtStart)
}

fn keep(samples: &[Sample], options: &Options, updates: Updates) -> Result<Trace, Error> {
    let mut moments = Vec::with_capacity(samples.len());
    let walk = super::walk::watched(samples, options, updates, &mut |moment| moments.push(moment))?;
    Ok(Trace { walk, moments })
}

/// A detector that sees the foot stand before its first step and never again.
#[derive(Debug, Clone, Copy)]
pub(super) struct OnlyAtStart<T> {
    adaptive: Adaptive<T>,
    stood: bool,
    left: bool,
}

impl<T: Scalar> Default for OnlyAtStart<T> {
    fn default() -> Self {
        Self { adaptive: Adaptive::default(), stood: false, left: false }
    }
}

impl<T: Scalar> StanceDetector<T> for OnlyAtStart<T> {
    fn update(&mut self, motion: &Motion<T>) -> Verdict<T> {
        let verdict = self.adaptive.update(motion);
        self.stood |= verdict.stance;
        self.left |= self.stood && !verdict.stance;
        Verdict { stance: verdict.stance && !self.left, ..verdict }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pedestrian::TrackPoint;

    #[test]
    fn moments_are_turned_with_the_track() {
        // Along the x axis with a heading that seems to turn by 0.01 rad/s.
        let turned = |k: u64| (0.01 * k as f64).sin_cos();
        let moment = |k: u64| {
            let (sine, cosine) = turned(k);
            let (half_sine, half_cosine) = (0.005 * k as f64).sin_cos();
            let orientation = [half_cosine, 0.0, 0.0, half_sine];
            Moment { velocity: [cosine, sine, 0.1], orientation, stance: false }
        };
        let point = |k: u64| TrackPoint { time_us: 1_000_000 * k, position: [0.0; 3] };
        let walk = Walk { track: (0..100).map(point).collect(), ..Walk::default() };
        let mut trace = Trace { walk, moments: (0..100).map(moment).collect() };
        trace.turn_moments();
        assert_eq!(trace.moments[50], moment(50), "nothing was turned");
        trace.walk.turn_back(0.01);
        trace.turn_moments();
        for moment in &trace.moments {
            let [x, y, z] = moment.velocity;
            assert!((x - 1.0).abs() + y.abs() + (z - 0.1).abs() < 1e-12, "{moment:?}");
            let [w, x, y, z] = moment.orientation;
            assert!((w - 1.0).abs() + x.abs() + y.abs() + z.abs() < 1e-12, "{moment:?}");
        }
    }
}
