//! Alignment of a track with a plan for display: an inertial tracker knows neither its start nor its initial heading.

use kestirim_replay::pedestrian::{TrackPoint, position_at};

use crate::metrics::best_turn;

/// The transformation from the frame of a track to that of a truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// The position in the track at the time at which the truth begins (m).
    ours: [f64; 2],
    /// The true position at that time (m).
    truth: [f64; 2],
    /// The sine and cosine of the rotation from the track to the truth.
    turn: (f64, f64),
}

impl Placement {
    /// The alignment by which errors are measured; the identity if no truth is known.
    pub fn of(track: &[TrackPoint], truth: &[TrackPoint]) -> Self {
        let ours: Vec<_> = truth
            .iter()
            .filter_map(|point| position_at(track, point.time_us))
            .map(|[x, y, _]| [x, y])
            .collect();
        let truth: Vec<_> = truth.iter().map(TrackPoint::horizontal).collect();
        let first = |points: &[[f64; 2]]| points.first().copied().unwrap_or_default();
        Self { ours: first(&ours), truth: first(&truth), turn: best_turn(&ours, &truth).sin_cos() }
    }

    /// Transforms a point of the track to the plan.
    pub fn onto_plan(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turned([x - self.ours[0], y - self.ours[1]]);
        [x + self.truth[0], y + self.truth[1]]
    }

    /// Rotates a direction, such as a velocity, to the plan.
    pub fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let (sin, cos) = self.turn;
        [cos * x - sin * y, sin * x + cos * y]
    }

    /// Transforms a point of the plan to the frame of the track.
    pub fn from_plan(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let ((sin, cos), [x, y]) = (self.turn, [x - self.truth[0], y - self.truth[1]]);
        [cos * x + sin * y + self.ours[0], cos * y - sin * x + self.ours[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(points: &[[f64; 2]]) -> Vec<TrackPoint> {
        let point = |(i, &[x, y]): (usize, &[f64; 2])| TrackPoint {
            time_us: 1000 * i as u64,
            position: [x, y, 0.0],
        };
        points.iter().enumerate().map(point).collect()
    }

    #[test]
    fn a_turned_track_comes_to_lie_on_the_truth_and_back() {
        let ours = [[1.0, 1.0], [2.0, 1.0], [2.0, 3.0]];
        let truth = [[5.0, 0.0], [5.0, 1.0], [3.0, 1.0]];
        let placement = Placement::of(&track(&ours), &track(&truth));
        for (ours, truth) in ours.into_iter().zip(truth) {
            assert!(crate::metrics::distance(placement.onto_plan(ours), truth) < 1e-12);
            assert!(crate::metrics::distance(placement.from_plan(truth), ours) < 1e-12);
        }
    }

    #[test]
    fn without_truth_nothing_moves() {
        let placement = Placement::of(&track(&[[1.0, 2.0], [3.0, 4.0]]), &[]);
        assert_eq!(placement.onto_plan([3.0, 4.0]), [3.0, 4.0]);
        assert_eq!(placement.turned([3.0, 4.0]), [3.0, 4.0]);
    }
}
