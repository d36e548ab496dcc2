//! The horizontal accuracy of positions.

use kestirim_replay::robot::{Course, Epoch, Trace};
use serde::Serialize;

use crate::metrics::{distance, error_over_sigma, mean, median, percentile, ratio_in_words, rms};
use crate::systems::robot::recording::{Recording, Truth};

/// Statistics of the horizontal errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Accuracy {
    /// The number of positions compared.
    pub positions: usize,
    /// The number of times, or points, with a truth but no position.
    pub missed: usize,
    /// The root mean square error (m).
    pub rmse_m: f64,
    /// The mean error (m).
    pub mean_m: f64,
    /// The median error (m).
    pub median_m: f64,
    /// The 95th percentile of the errors (m).
    pub p95_m: f64,
    /// The largest error (m).
    pub max_m: f64,
    /// The root mean square error divided by the root mean square standard deviation; `None` for a tracker without
    /// standard deviations.
    pub error_over_sigma: Option<f64>,
}

impl Accuracy {
    /// The accuracy of a recording's tracks: at every epoch of a moving tag, at the last of each point; `None` if the
    /// truth is not known.
    pub fn of_recording(recording: &Recording, traces: &[Trace]) -> Option<Self> {
        Self::of_parts(recording, traces.iter().map(|trace| trace.epochs.as_slice()))
    }

    /// The accuracy of the epochs of each part of a recording.
    pub fn of_parts<'a>(
        recording: &Recording,
        parts: impl IntoIterator<Item = &'a [Epoch]>,
    ) -> Option<Self> {
        let mut points = Vec::new();
        for (part, epochs) in recording.parts.iter().zip(parts) {
            match &part.truth {
                Some(Truth::Course(course)) => return Self::of_track(epochs, course),
                Some(Truth::Point(point)) => points.push((epochs.last(), *point)),
                None => {}
            }
        }
        Self::of_epochs(&points)
    }

    /// Compares epochs, where there are any, with true positions.
    fn of_epochs(points: &[(Option<&Epoch>, [f64; 2])]) -> Option<Self> {
        let pairs: Vec<_> = points
            .iter()
            .map(|(epoch, point)| (epoch.and_then(|it| it.position), *point))
            .collect();
        let told = points.iter().filter_map(|(epoch, truth)| {
            let [x, y, _] = epoch.as_ref()?.position?;
            Some((distance([x, y], *truth), epoch.as_ref()?.sigma_m()?))
        });
        Some(Self { error_over_sigma: error_over_sigma(told), ..Self::of(&pairs)? })
    }

    /// Compares pairs of estimated and true positions; `None` if there is nothing to compare.
    pub fn of(pairs: &[(Option<[f64; 3]>, [f64; 2])]) -> Option<Self> {
        let found = pairs.iter().filter_map(|(ours, truth)| Some((ours.as_ref()?, truth)));
        let errors: Vec<f64> = found.map(|(&[x, y, _], &truth)| distance([x, y], truth)).collect();
        if errors.is_empty() {
            return None;
        }
        Some(Self {
            positions: errors.len(),
            missed: pairs.len() - errors.len(),
            rmse_m: rms(&errors),
            mean_m: mean(&errors),
            median_m: median(&errors),
            p95_m: percentile(&errors, 95.0),
            max_m: percentile(&errors, 100.0),
            error_over_sigma: None,
        })
    }

    /// The names and values as text.
    pub fn in_words(&self) -> [(&'static str, String); 6] {
        let centimetres = |metres: f64| format!("{:.1} cm", 100.0 * metres);
        [
            ("positions compared", self.positions.to_string()),
            ("RMSE", centimetres(self.rmse_m)),
            ("mean error", centimetres(self.mean_m)),
            ("95 % below", centimetres(self.p95_m)),
            ("largest error", centimetres(self.max_m)),
            ("error over standard deviation", ratio_in_words(self.error_over_sigma)),
        ]
    }

    /// Compares a track with a truth known over time, at every epoch within it.
    pub fn of_track(epochs: &[Epoch], truth: &Course<2>) -> Option<Self> {
        let epochs = epochs.iter();
        let points: Vec<_> =
            epochs.filter_map(|epoch| Some((Some(epoch), truth.within(epoch.time_us)?))).collect();
        Self::of_epochs(&points)
    }
}
