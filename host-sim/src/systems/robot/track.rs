//! Tracking of a recording, part by part.

use kestirim_replay::robot::{self, Epoch, Follow, Setup, Smoothed, Trace, Tracked, Unsmoothed};

use super::recording::Recording;
use crate::Error;

/// The remedy if the ranges do not determine the height.
const MISSING: &str = "expected --height, metres above the floor or a file (or --dim 3)";

/// The tracker's results for every part of a recording, and those of the smoother over all, if requested.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tracks {
    /// The traces of the tracker, part by part.
    pub traces: Vec<Trace>,
    /// The result of the smoother, if requested.
    pub smoothed: Option<Result<Smoothed, Unsmoothed>>,
}

impl Tracks {
    /// The smoothed track, if it was requested and the smoother succeeded.
    pub fn smoothed(&self) -> Option<&Smoothed> {
        self.smoothed.as_ref()?.as_ref().ok()
    }

    /// Tracks and smooths a recording.
    ///
    /// # Errors
    /// Those of [`track`].
    pub fn smoothed_too(recording: &Recording, setup: &Setup) -> Result<Self, Error> {
        let traces = track(recording, setup)?;
        let smoothed = Some(smooth(recording, setup, &traces));
        Ok(Self { traces, smoothed })
    }

    /// The smoothed epochs in the form of a tracker's traces.
    pub fn smoothed_traces(&self) -> Option<Vec<Trace>> {
        let parts = self.smoothed()?.parts.iter();
        let of_part = |epochs: &Vec<Epoch>| Trace { epochs: epochs.clone(), ..Trace::default() };
        Some(parts.map(of_part).collect())
    }

    /// The best epochs of each part: smoothed, or else as tracked.
    pub fn best(&self) -> Vec<&[Epoch]> {
        match self.smoothed() {
            Some(smoothed) => smoothed.parts.iter().map(Vec::as_slice).collect(),
            None => self.traces.iter().map(|trace| trace.epochs.as_slice()).collect(),
        }
    }
}

/// Smooths the traces of a recording.
fn smooth(recording: &Recording, setup: &Setup, traces: &[Trace]) -> Result<Smoothed, Unsmoothed> {
    let parts = recording.parts.iter().zip(traces);
    let parts: Vec<_> =
        parts.map(|(part, trace)| Tracked { events: &part.events, trace }).collect();
    robot::smooth(setup, &parts, recording.is_static())
}

/// Tracks every part of a recording separately, each with a new tracker.
///
/// # Errors
/// [`Error::Usage`] if the anchors are unsuitable.
pub fn track(recording: &Recording, setup: &Setup) -> Result<Vec<Trace>, Error> {
    track_by(recording, setup, |_, setup| robot::build(setup))
}

/// Tracks every part of a recording with a tracker from `build`, which is given the index of the part.
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

/// The error for a tracker that cannot be built, or a missing height.
pub(super) fn refused(error: robot::Error) -> Error {
    Error::Usage(match error {
        robot::Error::HeightUnknown | robot::Error::HeightVague { .. } => {
            format!("{error}: {MISSING}")
        }
        other => other.to_string(),
    })
}
