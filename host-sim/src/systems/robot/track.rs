//! Tracks a recording, part by part.

use kestirim_replay::robot::{self, Epoch, Follow, Setup, Smoothed, Trace, Tracked, Unsmoothed};

use super::recording::Recording;
use crate::Error;

/// What helps if the ranges do not tell the height.
const MISSING: &str = "expected --height, metres above the floor or a file (or --dim 3)";

/// What the tracker made of every part of a recording, and the smoother of all, if it was asked for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tracks {
    /// The tracker's, part by part.
    pub traces: Vec<Trace>,
    /// The smoother's.
    pub smoothed: Option<Result<Smoothed, Unsmoothed>>,
}

impl Tracks {
    /// What the smoother found, if it was asked for and found anything.
    pub fn smoothed(&self) -> Option<&Smoothed> {
        self.smoothed.as_ref()?.as_ref().ok()
    }

    /// Tracked, and smoothed, too.
    ///
    /// # Errors
    /// As [`track`].
    pub fn smoothed_too(recording: &Recording, setup: &Setup) -> Result<Self, Error> {
        let traces = track(recording, setup)?;
        let smoothed = Some(smooth(recording, setup, &traces));
        Ok(Self { traces, smoothed })
    }

    /// What the smoother found as a tracker would tell it.
    pub fn smoothed_traces(&self) -> Option<Vec<Trace>> {
        let parts = self.smoothed()?.parts.iter();
        let of_part = |epochs: &Vec<Epoch>| Trace { epochs: epochs.clone(), ..Trace::default() };
        Some(parts.map(of_part).collect())
    }

    /// The best that is known of each part: smoothed, or else as tracked.
    pub fn best(&self) -> Vec<&[Epoch]> {
        match self.smoothed() {
            Some(smoothed) => smoothed.parts.iter().map(Vec::as_slice).collect(),
            None => self.traces.iter().map(|trace| trace.epochs.as_slice()).collect(),
        }
    }
}

/// Smooths what was tracked.
fn smooth(recording: &Recording, setup: &Setup, traces: &[Trace]) -> Result<Smoothed, Unsmoothed> {
    let parts = recording.parts.iter().zip(traces);
    let parts: Vec<_> =
        parts.map(|(part, trace)| Tracked { events: &part.events, trace }).collect();
    robot::smooth(setup, &parts, recording.is_static())
}

/// Tracks every part of a recording by itself, with a tracker that is built for it.
///
/// # Errors
/// [`Error::Usage`] if the anchors will not do.
pub fn track(recording: &Recording, setup: &Setup) -> Result<Vec<Trace>, Error> {
    track_by(recording, setup, |_, setup| robot::build(setup))
}

/// The same with trackers of one's own, each built for a part, counted from 0.
///
/// # Errors
/// Those of `build`.
pub fn track_by(
    recording: &Recording,
    setup: &Setup,
    build: impl Fn(usize, &Setup) -> Result<Box<dyn Follow>, robot::Error>,
) -> Result<Vec<Trace>, Error> {
    let parts = recording.parts.iter().enumerate().map(|(number, part)| {
        let height_m = part.height_m.unwrap_or(setup.height_m);
        let setup = Setup { height_m, ..setup.clone() };
        Ok(Trace::by(build(number, &setup)?.as_mut(), &setup, &part.events))
    });
    parts.collect::<Result<_, _>>().map_err(refused)
}

/// A tracker that cannot be made, or a height that is missing.
pub(super) fn refused(error: robot::Error) -> Error {
    Error::Usage(match error {
        robot::Error::HeightUnknown | robot::Error::HeightVague { .. } => {
            format!("{error}: {MISSING}")
        }
        other => other.to_string(),
    })
}
