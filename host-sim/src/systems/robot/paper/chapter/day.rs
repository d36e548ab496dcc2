//! One day in the office, followed by every tracker.

use kestirim_replay::ScalarKind;
use kestirim_replay::robot::{Beginning, Noise, Setup, Trace, TrackerKind, build_published};

use crate::Error;
use crate::systems::robot::recording::{Recording, Truth};
use crate::systems::robot::settings::of_the_office;
use crate::systems::robot::track::{Tracks, track, track_by};

/// A recording, and what each tracker makes of it.
pub(super) struct Day {
    /// What was recorded.
    pub(super) recording: Recording,
    /// Trilateration alone.
    pub(super) unfiltered: Vec<Trace>,
    /// The paper's filters, begun at the first trilateration: plain and adaptive.
    pub(super) honest: [Vec<Trace>; 2],
    /// The same, begun where the tag truly was.
    pub(super) from_the_truth: [Vec<Trace>; 2],
    /// Our default without calibration …
    pub(super) ours: Vec<Trace>,
    /// … and with it, smoothed, too.
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

/// The paper's protocol: the surveyed point of each part is given to the filter as its start.
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
