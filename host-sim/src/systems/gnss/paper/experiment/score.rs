//! How good a day's solution is, as the paper has it.

use kestirim_replay::gnss::{Accuracy, Fix};
use nalgebra::Vector3;
use serde::Serialize;

/// Errors of a station-day.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Score {
    /// Absolute error of the last solution: north, east, up and in three dimensions, mm.
    pub final_mm: [f64; 4],
    /// Root mean square over all epochs after the first hour, mm.
    pub rms_mm: [f64; 4],
    /// Time from the first epoch to that from which the error stays below 10 cm for 15 minutes.
    pub convergence_min: Option<f64>,
    /// Epochs without a solution.
    pub unsolved: usize,
}

impl Score {
    /// Of a day of so many epochs that begins at midnight.
    pub(super) fn of(fixes: &[Fix], epochs: usize, truth: &Vector3<f64>) -> Self {
        let unsolved = epochs - fixes.len();
        let Some(accuracy) = Accuracy::of(fixes, 0.0, truth) else {
            return Self { final_mm: [f64::NAN; 4], unsolved, ..Self::default() };
        };
        let mm = |[east, north, up]: [f64; 3], all: f64| {
            [north, east, up, all].map(|metres: f64| 1e3 * metres.abs())
        };
        let (rms_enu, rms_3d) = (accuracy.rms_enu_m, accuracy.rms_3d_m);
        Self {
            final_mm: mm(accuracy.final_enu_m, accuracy.final_3d_m),
            rms_mm: mm(rms_enu.unwrap_or_default(), rms_3d.unwrap_or_default()),
            convergence_min: accuracy.convergence_min,
            unsolved,
        }
    }
}
