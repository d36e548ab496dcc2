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
