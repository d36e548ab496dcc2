//! The accuracy of positions whose truth is known, by the paper's measures.

use kestirim_gnss_ppp::Geodetic;
use nalgebra::Vector3;

use super::Fix;
use crate::metrics::{error_over_sigma, rms};

/// Errors before this time belong to the beginning and do not enter root mean squares, s since the first epoch.
pub const BEGINNING: f64 = 3600.0;
/// The error below which a position may have converged, m.
const CONVERGED: f64 = 0.1;
/// The time for which the error must stay below `CONVERGED`, s.
const LASTING: f64 = 900.0;
/// Times closer together than this are the same, s.
const SAME: f64 = 1e-3;

/// The errors of positions against the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Accuracy {
    /// The distance of the last position from the truth, m.
    pub final_3d_m: f64,
    /// The root mean square distance from the truth, from an hour after the first epoch on, m.
    pub rms_3d_m: Option<f64>,
    /// Minutes from the first epoch to the one from which on the error is below 10 cm for 15 min.
    pub convergence_min: Option<f64>,
    /// The last position minus the truth, to the east, north and up, m.
    pub final_enu_m: [f64; 3],
    /// The root mean square errors to the east, north and up, from an hour after the first epoch on, m.
    pub rms_enu_m: Option<[f64; 3]>,
    /// The root mean square distance over the root mean square standard deviation, from an hour after the first epoch
    /// on.
    pub error_over_sigma: Option<f64>,
}

impl Accuracy {
    /// Compares positions in the order of time with the true one; `begin` is the time of the first epoch, with or
    /// without a position. `None` without positions.
    pub fn of(fixes: &[Fix], begin: f64, truth: &Vector3<f64>) -> Option<Self> {
        let rotation = Geodetic::from_ecef(truth).enu_from_ecef();
        let errors: Vec<(f64, Vector3<f64>)> =
            fixes.iter().map(|fix| (fix.t - begin, rotation * (fix.position - truth))).collect();
        let (_, last) = errors.last()?;
        let late: Vec<_> = errors.iter().filter(|(t, _)| *t >= BEGINNING).collect();
        let along = |axis: usize| rms(&late.iter().map(|(_, it)| it[axis]).collect::<Vec<_>>());
        let rms_enu = (!late.is_empty()).then(|| [0, 1, 2].map(along));
        Some(Self {
            final_3d_m: last.norm(),
            rms_3d_m: rms_enu.map(|enu| Vector3::from(enu).norm()),
            convergence_min: convergence(&errors).map(|seconds| seconds / 60.0),
            final_enu_m: (*last).into(),
            rms_enu_m: rms_enu,
            error_over_sigma: None,
        })
    }

    /// Adds the comparison with the filter's own standard deviations: to the east, north and up for each position, m.
    pub fn with_deviations(
        self,
        fixes: &[Fix],
        deviations: &[[f64; 3]],
        begin: f64,
        truth: &Vector3<f64>,
    ) -> Self {
        let late = fixes.iter().zip(deviations).filter(|(fix, _)| fix.t - begin >= BEGINNING);
        let told = late.map(|(fix, deviations)| {
            ((fix.position - truth).norm(), Vector3::from(*deviations).norm())
        });
        Self { error_over_sigma: error_over_sigma(told), ..self }
    }
}

/// The time from which on the error stays small for `LASTING`.
fn convergence(errors: &[(f64, Vector3<f64>)]) -> Option<f64> {
    let (end, _) = errors.last()?;
    let mut since = None;
    for (t, error) in errors {
        if since.is_some_and(|since| t - since > LASTING + SAME) {
            break;
        }
        if error.norm() < CONVERGED {
            since.get_or_insert(*t);
        } else {
            since = None;
        }
    }
    since.filter(|since| end - since >= LASTING - SAME)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixes(errors: impl IntoIterator<Item = f64>) -> (Vec<Fix>, Vector3<f64>) {
        let truth = Vector3::new(6_378_137.0, 0.0, 0.0);
        let fix = |(k, error): (usize, f64)| Fix {
            t: 1000.0 + 30.0 * k as f64,
            position: truth + Vector3::new(error, 0.0, 0.0),
        };
        (errors.into_iter().enumerate().map(fix).collect(), truth)
    }

    #[test]
    fn convergence_lasts_a_quarter_of_an_hour() {
        // Below 10 cm at once, but for 14.5 min only; then from epoch 31 on.
        let short = std::iter::repeat_n(0.05, 30);
        let (fixes, truth) = fixes(short.chain([0.2]).chain(std::iter::repeat_n(-0.03, 120)));
        let accuracy = Accuracy::of(&fixes, 1000.0, &truth).unwrap();
        assert_eq!(accuracy.convergence_min, Some(15.5));
        assert!((accuracy.final_3d_m - 0.03).abs() < 1e-9);
        assert!((accuracy.final_enu_m[2] + 0.03).abs() < 1e-9);
        assert!((accuracy.rms_3d_m.unwrap() - 0.03).abs() < 1e-9);
        let cut = Accuracy::of(&fixes[..60], 1000.0, &truth).unwrap();
        assert_eq!((cut.convergence_min, cut.rms_3d_m), (None, None));
        assert_eq!(Accuracy::of(&fixes[..62], 1000.0, &truth).unwrap().convergence_min, Some(15.5));
        assert_eq!(Accuracy::of(&[], 1000.0, &truth), None);
    }

    #[test]
    fn times_are_those_since_the_first_epoch() {
        let (fixes, truth) = fixes(std::iter::repeat_n(0.01, 60));
        let accuracy = Accuracy::of(&fixes, 400.0, &truth).unwrap();
        assert_eq!(accuracy.convergence_min, Some(10.0));
    }
}
