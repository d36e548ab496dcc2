//! What a tracker finds suspicious, in words.

use kestirim_pedestrian::Warnings;

use crate::system::{HealthState, Reason};

/// A sentence for each warning that was raised.
pub(crate) fn sentences(warnings: Warnings) -> Vec<String> {
    raised(warnings).map(|(_, sentence)| sentence.to_owned()).collect()
}

/// Why the path suffers, for each warning that was raised.
pub(crate) fn reasons(warnings: Warnings) -> Vec<Reason> {
    raised(warnings).map(|(reason, _)| reason).collect()
}

/// How far the path can be relied upon for all that.
pub(crate) fn state(warnings: Warnings) -> HealthState {
    raised(warnings).map(|(reason, _)| reason.state()).max().unwrap_or_default()
}

fn raised(warnings: Warnings) -> impl Iterator<Item = (Reason, &'static str)> {
    [
        (
            warnings.accelerometer_saturated,
            Reason::Saturated,
            "the accelerometer saturated: choose a wider range than the walker's steps",
        ),
        (
            warnings.gyroscope_saturated,
            Reason::Saturated,
            "the gyroscope saturated: choose a wider range than the walker's steps",
        ),
        (
            warnings.gravity_implausible,
            Reason::Units,
            "at rest the accelerometer does not show 9.8 m/s²: wrong unit, or uncalibrated",
        ),
        (
            warnings.rate_implausible,
            Reason::Units,
            "angular rates beyond any foot's: degrees a second where radians are expected?",
        ),
        (
            warnings.axes_inconsistent,
            Reason::Axes,
            "accelerometer and gyroscope contradict each other: axes swapped or mirrored?",
        ),
        (
            warnings.tilt_lost,
            Reason::Dropout,
            "the tilt was lost and found again: samples are missing or wrong, and what the foot turned meanwhile is not known",
        ),
        (
            warnings.landings_implausible,
            Reason::Innovations,
            "stride by stride too large a velocity is left over: the gyroscope is clipped, late, or its scale or zero is \
             wrong (calibrate pedestrian), or the clock runs wrong",
        ),
        (warnings.gaps, Reason::Dropout, "samples are missing for more than 0.1 s"),
        (
            warnings.out_of_range,
            Reason::Range,
            "the path is longer than the 2048 m of Q12.20, beyond which its length stands still: choose --scalar f32",
        ),
        (
            warnings.never_still,
            Reason::NotObservable,
            "no standstill of half a second was found: the gyro bias is unknown",
        ),
    ]
    .into_iter()
    .filter(|(raised, ..)| *raised)
    .map(|(_, reason, sentence)| (reason, sentence))
}
