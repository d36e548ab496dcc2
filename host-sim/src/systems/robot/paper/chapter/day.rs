//! One day in the office, tracked by every tracker.

use kestirim_replay::ScalarKind;
use kestirim_replay::robot::{Beginning, Noise, Setup, Trace, TrackerKind, build_published};

use crate::Error;
use crate::systems::robot::recording::{Recording, Truth};
use crate::systems::robot::settings::of_the_office;
use crate::systems::robot::track::{Tracks, track, track_by};

/// A recording, with the results of each tracker.
pub(super) struct Day {
    /// The recording that is tracked.
    pub(super) recording: Recording,
    /// The traces of trilateration alone.
    pub(super) unfiltered: Vec<Trace>,
    /// The traces of the paper's filters started at the first trilateration: plain and adaptive.
    pub(super) honest: [Vec<Trace>; 2],
    /// The traces of the paper's filters started at the tag's true position: plain and adaptive.
    pub(super) from_the_truth: [Vec<Trace>; 2],
    /// The traces of our default without calibration.
    pub(super) ours: Vec<Trace>,
    /// The tracks of our default with calibration, including the smoothed one.
    pub(super) calibrated: Tracks,
}

impl Day {
    pub(super) fn follow(recording: Recording, scalar: ScalarKind) -> Result<Self, Error> {
        let plain = of_the_office(scalar);
        let calibrated = Setup { biases: recording.biases.clone(), ..plain.clone() };
        let unfiltered = Setup { tracker: TrackerKind::Lsq, ..plain.clone() };
        let kinds = [Noise::Fixed, Noise::Adapted];
        let honest = kinds.map(|noise| {
            let beginning = Beginning { start: None, noise };
            track_by(&recording, &plain, |_, setup| build_published(setup, beginning))
        });
        let from_the_truth = kinds.map(|noise| each_from_its_truth(&recording, &plain, noise));
        let [ekf, aekf] = honest;
        let [true_ekf, true_aekf] = from_the_truth;
        Ok(Self {
            unfiltered: track(&recording, &unfiltered)?,
            honest: [ekf?, aekf?],
            from_the_truth: [true_ekf?, true_aekf?],
            ours: track(&recording, &plain)?,
            calibrated: Tracks::smoothed_too(&recording, &calibrated)?,
            recording,
        })
    }
}

/// Tracks by the paper's protocol: the filter is started at the surveyed point of each part.
fn each_from_its_truth(
    recording: &Recording,
    setup: &Setup,
    noise: Noise,
) -> Result<Vec<Trace>, Error> {
    track_by(recording, setup, |part, setup| {
        let start = start(recording.parts[part].truth.as_ref());
        build_published(setup, Beginning { start, noise })
    })
}

fn start(truth: Option<&Truth>) -> Option<[f64; 2]> {
    match truth? {
        Truth::Point(point) => Some(*point),
        Truth::Course(course) => course.rows().first().map(|(_, place)| *place),
    }
}
