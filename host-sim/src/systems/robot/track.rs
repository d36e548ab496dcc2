//! Tracks a recording, part by part.

use kestirim_replay::robot::{self, Follow, Setup, Trace};

use super::recording::Recording;
use crate::Error;

/// What helps if the ranges do not tell the height.
const MISSING: &str = "expected --height, metres above the floor or a file (or --dim 3)";

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
