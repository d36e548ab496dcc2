//! More than the path: how fast the foot was and whether it stood, at every sample, and what comes out
//! without zero-velocity updates.

use kestirim_pedestrian::detector::{Adaptive, Motion, StanceDetector, Verdict};
use kestirim_scalar::Scalar;

use super::{RunError, Walk};
use crate::systems::pedestrian::Sample;
use crate::systems::pedestrian::settings::Options;

/// What a tracker says of one sample beside the position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// In the room frame, m/s.
    pub velocity: [f64; 3],
    /// Whether the foot stands.
    pub stance: bool,
}

/// What is called with every [`Moment`] of a walk, in order.
pub(in crate::systems::pedestrian) type See<'a> = dyn FnMut(Moment) + 'a;

/// When zero velocities are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::systems::pedestrian) enum Updates {
    /// Whenever the chosen detector finds that the foot stands.
    InStance,
    /// Until the foot is lifted for the first time.
    OnlyAtStart,
}

/// A walk and its moments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trace {
    /// As [`walk`](super::walk) gives it.
    pub walk: Walk,
    /// One for every position of its track.
    pub moments: Vec<Moment>,
}

/// Tracks a walk and keeps every moment of it.
///
/// # Errors
/// As [`walk`](super::walk).
pub fn trace(samples: &[Sample], options: &Options) -> Result<Trace, RunError> {
    keep(samples, options, Updates::InStance)
}

/// The same without zero-velocity updates: the standstill before the walk is used, no stance after it.
///
/// # Errors
/// As [`walk`](super::walk).
pub fn without_updates(samples: &[Sample], options: &Options) -> Result<Trace, RunError> {
    keep(samples, options, Updates::OnlyAtStart)
}

fn keep(samples: &[Sample], options: &Options, updates: Updates) -> Result<Trace, RunError> {
    let mut moments = Vec::with_capacity(samples.len());
    let walk = super::watched(samples, options, updates, &mut |moment| moments.push(moment))?;
    Ok(Trace { walk, moments })
}

/// A detector that sees the foot stand before its first step and never again.
#[derive(Debug, Clone, Copy)]
pub(in crate::systems::pedestrian) struct OnlyAtStart<T> {
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
    use crate::systems::pedestrian::recording::{Recording, Walked};

    #[test]
    fn a_trace_is_the_walk_and_more() {
        let Recording { log, .. } = Recording::synthetic(Walked::Route, 100.0, 1, 0).unwrap();
        let options = Options::default();
        let trace = trace(&log.samples, &options).unwrap();
        assert_eq!(
            trace.walk,
            crate::systems::pedestrian::track::walk(&log.samples, &options).unwrap()
        );
        assert_eq!(trace.moments.len(), log.samples.len());
        let standing = trace.moments.iter().filter(|moment| moment.stance).count();
        assert!((0.3..0.8).contains(&(standing as f64 / log.samples.len() as f64)));
    }

    #[test]
    fn without_updates_the_foot_never_stands_again_and_the_velocity_drifts() {
        let Recording { log, .. } = Recording::synthetic(Walked::Route, 100.0, 1, 0).unwrap();
        let options = Options::default();
        let drifting = without_updates(&log.samples, &options).unwrap();
        let left = drifting.moments.iter().position(|moment| !moment.stance).unwrap();
        assert!(left > 150 && drifting.moments[left..].iter().all(|moment| !moment.stance));
        let last_speed = |trace: &Trace| {
            let [x, y, z] = trace.moments.last().unwrap().velocity;
            x.hypot(y).hypot(z)
        };
        assert!(last_speed(&drifting) > 0.2, "{}", last_speed(&drifting));
        assert!(last_speed(&trace(&log.samples, &options).unwrap()) < 0.05);
    }
}
