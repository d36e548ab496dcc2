//! The height of a tag whose height is not given: determined from its ranges, or not at all.

use std::sync::OnceLock;

use kestirim_replay::robot::{Dimensions, FoundHeight, Setup};

use super::recording::{Heights, Recording};
use super::track::refused;
use crate::Error;
use crate::system::Settings;

/// The height found with uncalibrated and with calibrated anchors: searched for once, and read at every change of a
/// slider.
#[derive(Debug, Clone, Default)]
pub(super) struct FoundOnce([OnceLock<Result<FoundHeight, String>>; 2]);

/// Whether the height of the tag is not given.
pub(super) fn is_missing(recording: &Recording, settings: &Settings) -> bool {
    settings.chosen::<Dimensions>("dim") == Dimensions::Two
        && recording.heights == Heights::Unknown
        && !settings.is_given("height")
}

/// The height of a recording's tag, from its ranges alone.
///
/// # Errors
/// [`Error::Usage`] that names the missing option if the ranges do not determine the height.
pub(super) fn of_recording(recording: &Recording, setup: &Setup) -> Result<FoundHeight, Error> {
    let found = &recording.found_height.0[usize::from(setup.biases.is_some())];
    let parts = || recording.parts.iter().map(|part| part.events.as_slice());
    let search =
        || FoundHeight::of_parts(setup, parts()).map_err(|error| refused(error).to_string());
    found.get_or_init(search).clone().map_err(Error::Usage)
}

/// The height as text.
pub(super) fn in_words(found: &FoundHeight) -> String {
    let FoundHeight { metres, sigma_m, position_sigma_m, .. } = found;
    let moved = 100.0 * position_sigma_m;
    let whence = if found.is_of_ranges { " from the ranges" } else { ", anywhere" };
    format!("{metres:.2} ± {sigma_m:.2} m{whence}, the position ± {moved:.1} cm by it")
}
