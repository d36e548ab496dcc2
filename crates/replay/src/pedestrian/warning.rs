//! The warnings of a tracker, in words.

use kestirim_pedestrian::Warnings;

/// A sentence for each warning that was raised.
pub fn sentences(warnings: Warnings) -> Vec<String> {
    [
        (
            warnings.accelerometer_saturated,
            "the accelerometer saturated: choose a wider range than the walker's steps",
        ),
        (
            warnings.gyroscope_saturated,
            "the gyroscope saturated: choose a wider range than the walker's steps",
        ),
        (
            warnings.gravity_implausible,
            "at rest the accelerometer does not show 9.8 m/s²: wrong unit, or uncalibrated",
        ),
        (
            warnings.rate_implausible,
            "angular rates beyond any foot's: degrees a second where radians are expected?",
        ),
        (
            warnings.axes_inconsistent,
            "accelerometer and gyroscope contradict each other: axes swapped or mirrored?",
        ),
        (
            warnings.tilt_lost,
            "the tilt was lost and found again: samples are missing or wrong, and what the foot turned meanwhile is not known",
        ),
        (
            warnings.landings_implausible,
            "when the foot stands, its computed velocity is too far from zero, stride by stride: it shuffles, the gyroscope is clipped, \
             late or not calibrated (calibrate pedestrian), or the clock runs wrong",
        ),
        (warnings.gaps, "samples are missing: more than 60 ms at once, or 40 ms and three times the step before"),
        (
            warnings.out_of_range,
            "the path leads beyond the 2048 m of Q12.20, where its numbers stand still: choose --scalar f32",
        ),
        (
            warnings.never_still,
            "no standstill of half a second was found: the gyro bias is unknown",
        ),
    ]
    .into_iter()
    .filter(|(raised, _)| *raised)
    .map(|(_, sentence)| sentence.to_owned())
    .collect()
}
