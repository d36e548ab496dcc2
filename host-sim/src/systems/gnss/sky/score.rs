//! How good a day's solution is, as the paper has it.

use nalgebra::Vector3;
use serde::Serialize;

use super::times::INTERVAL_S;

/// Epochs of the first hour, which does not count among the RMS.
const FIRST_HOUR: usize = 120;
/// A converged solution is nearer to the truth than this, m, …
const CONVERGED_M: f64 = 0.1;
/// … and stays so for so many epochs: 15 minutes.
const STAYS: usize = 30;

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
    /// Of the errors (north, east, up; m) of all epochs of a day.
    pub fn of(errors: &[Option<Vector3<f64>>]) -> Self {
        let four = |error: Vector3<f64>| [error.x, error.y, error.z, error.norm()];
        let last = errors.iter().rev().find_map(|error| *error);
        let settled = || errors.iter().skip(FIRST_HOUR).flatten();
        let squares = settled().fold([0.0; 4], |mut sums, error| {
            for (sum, part) in sums.iter_mut().zip(four(*error)) {
                *sum += part * part;
            }
            sums
        });
        let count = settled().count().max(1) as f64;
        let near = |error: &Option<Vector3<f64>>| error.is_some_and(|it| it.norm() < CONVERGED_M);
        let converged = errors.windows(STAYS + 1).position(|window| window.iter().all(near));
        Self {
            final_mm: last.map_or([f64::NAN; 4], |error| four(error).map(|part| 1e3 * part.abs())),
            rms_mm: squares.map(|sum| 1e3 * (sum / count).sqrt()),
            convergence_min: converged.map(|epoch| epoch as f64 * INTERVAL_S / 60.0),
            unsolved: errors.iter().filter(|error| error.is_none()).count(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn convergence_must_last_a_quarter_of_an_hour() {
        let near = Some(Vector3::new(0.03, 0.0, -0.04));
        let far = Some(Vector3::new(0.0, 0.3, 0.0));
        let mut errors = vec![far; 10];
        errors.extend(vec![near; 30]);
        assert_eq!(Score::of(&errors).convergence_min, None);
        errors.extend([far, None]);
        errors.extend(vec![near; 200]);
        let score = Score::of(&errors);
        assert_eq!(score.convergence_min, Some(21.0));
        assert_eq!(score.unsolved, 1);
        for ours in [score.final_mm, score.rms_mm] {
            for (ours, expected) in ours.into_iter().zip([30.0, 0.0, 40.0, 50.0]) {
                assert!((ours - expected).abs() < 1e-9);
            }
        }
    }
}
