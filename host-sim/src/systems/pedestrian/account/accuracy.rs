//! The accuracy of a tracked walk.

use kestirim_replay::pedestrian::{Footprint, TrackPoint, Walk, position_at};
use serde::Serialize;

use crate::metrics::{
    aligned_errors, error_over_sigma, polyline_length, ratio_in_words, relative_error_percent, rms,
};
use crate::systems::pedestrian::recording::Recording;

/// The horizontal errors of a walk, after a least-squares yaw alignment about the start.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accuracy {
    /// The root mean square error over all true positions, the start included (m).
    pub rmse_m: f64,
    /// The error at the last true position (m).
    pub final_error_m: f64,
    /// The error at the last true position in percent of the true path length; `None` if that is zero.
    pub final_error_percent: Option<f64>,
    /// The error of the stance-to-stance path length in percent of the true one, positive if too long; `None` if the
    /// true one is zero.
    pub path_length_error_percent: Option<f64>,
    /// The root mean square error divided by the root mean square standard deviation, at all true positions but the
    /// first; `None` without standard deviations.
    pub error_over_sigma: Option<f64>,
}

impl Accuracy {
    /// The accuracy relative to the truth of the recording; `None` if that is not known.
    pub fn of(recording: &Recording, walk: &Walk) -> Option<Self> {
        match &recording.log.truth {
            _ if !recording.footprints.is_empty() => {
                Some(against_footprints(walk, &recording.footprints))
            }
            Some(truth) => Some(against_truth(walk, truth)),
            None => None,
        }
    }

    /// The names and values as text.
    pub fn in_words(&self) -> [(&'static str, String); 5] {
        let percent = |value: Option<f64>| match value {
            Some(value) => format!("{value:+.2} %"),
            None => "—".to_owned(),
        };
        [
            ("RMSE", format!("{:.3} m", self.rmse_m)),
            ("error at the end", format!("{:.3} m", self.final_error_m)),
            ("  of the path", percent(self.final_error_percent)),
            ("path length error", percent(self.path_length_error_percent)),
            ("error over standard deviation", ratio_in_words(self.error_over_sigma)),
        ]
    }
}

/// Compares with measured footprints: positions at their times, and the path length with that of the line through them.
pub fn against_footprints(walk: &Walk, footprints: &[Footprint]) -> Accuracy {
    let truth: Vec<_> = footprints.iter().map(|footprint| footprint.position).collect();
    let times: Vec<_> = footprints.iter().map(|footprint| footprint.time_us).collect();
    compare(walk, &times, &truth, polyline_length(&truth))
}

/// Compares with a truth that is known at every sample.
///
/// The sensor's true arc is longer than the distance walked, so the true path length is also taken from stance to
/// stance: along the true positions at the start and at the ends of our own strides. Strides that the tracker missed
/// therefore shorten both.
pub fn against_truth(walk: &Walk, truth: &[TrackPoint]) -> Accuracy {
    let start = truth.first().map(|point| point.time_us);
    let stances = start.into_iter().chain(walk.strides.iter().map(|stride| stride.time_us));
    let true_length_m = polyline_length(&horizontal_at(truth, stances));
    let times: Vec<_> = truth.iter().map(|point| point.time_us).collect();
    let truth: Vec<_> = truth.iter().map(TrackPoint::horizontal).collect();
    compare(walk, &times, &truth, true_length_m)
}

fn horizontal_at(track: &[TrackPoint], times_us: impl Iterator<Item = u64>) -> Vec<[f64; 2]> {
    times_us.filter_map(|time| position_at(track, time)).map(|[x, y, _]| [x, y]).collect()
}

/// Compares with true positions at these times.
fn compare(walk: &Walk, times_us: &[u64], truth: &[[f64; 2]], true_length_m: f64) -> Accuracy {
    let ours = horizontal_at(&walk.track, times_us.iter().copied());
    let errors = aligned_errors(&ours, truth);
    let final_error_m = errors.last().copied().unwrap_or_default();
    let sigmas = walk.sigmas_m(times_us.iter().copied()).map(|[x, y, _]| x.hypot(y));
    Accuracy {
        rmse_m: rms(&errors),
        final_error_m,
        final_error_percent: (true_length_m > 0.0).then(|| 100.0 * final_error_m / true_length_m),
        path_length_error_percent: relative_error_percent(walk.path_length_m, true_length_m),
        error_over_sigma: error_over_sigma(errors.iter().copied().zip(sigmas).skip(1)),
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;
    use kestirim_replay::pedestrian::Stride;

    /// A walk straight ahead along y at 1 m/s with one stride per second, lengthened by the factor `stretch`.
    fn straight(stretch: f64) -> Walk {
        let position = |i: u64| [0.0, i as f64 * stretch, 0.0];
        let stride = |i| Stride {
            time_us: i * 1_000_000,
            position: position(i),
            length_m: stretch,
            duration_s: 1.0,
            heading_change_rad: 0.0,
            unseen_s: 0.0,
            bridged_rad: 0.0,
            gravity_off: 0.0,
            sigma_m: [0.0; 3],
        };
        Walk {
            track: (0..=4)
                .map(|i| TrackPoint { time_us: i * 1_000_000, position: position(i) })
                .collect(),
            strides: (1..=4).map(stride).collect(),
            path_length_m: 4.0 * stretch,
            closure_m: 4.0 * stretch,
            warnings: vec![],
            doubts: crate::system::Health::GOOD,
            ..Walk::default()
        }
    }

    #[test]
    fn footprints_in_another_frame_show_only_the_stretch() {
        let footprint =
            |i: u64| Footprint { time_us: i * 1_000_000, position: [5.0 - i as f64, 7.0] };
        let footprints: Vec<_> = (0..=4).map(footprint).collect();
        let accuracy = against_footprints(&straight(1.1), &footprints);
        assert!((accuracy.final_error_m - 0.4).abs() < 1e-12);
        assert!((accuracy.final_error_percent.unwrap() - 10.0).abs() < 1e-9);
        assert!((accuracy.path_length_error_percent.unwrap() - 10.0).abs() < 1e-9);
        assert!((accuracy.rmse_m - (0.30_f64 / 5.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn continuous_truth_is_measured_from_stance_to_stance() {
        let truth = straight(1.0).track;
        let accuracy = against_truth(&straight(0.9), &truth);
        assert!((accuracy.path_length_error_percent.unwrap() + 10.0).abs() < 1e-9);
    }

    #[test]
    fn a_truth_that_stands_still_gives_no_percentages() {
        let truth: Vec<_> =
            straight(1.0).track.iter().map(|p| TrackPoint { position: [0.0; 3], ..*p }).collect();
        let accuracy = against_truth(&straight(1.0), &truth);
        assert_eq!(accuracy.final_error_percent, None);
        assert_eq!(accuracy.final_error_m, 4.0);
    }
}
