//! Result of a design.

use nalgebra::DMatrix;

/// Result of a design.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(untagged))]
pub enum Solution {
    /// An observer gain.
    Gain {
        /// L, the gain of the predictor form.
        #[cfg_attr(feature = "serde", serde(rename = "L", serialize_with = "rows"))]
        gain: DMatrix<f64>,
        /// Error of the worst pole relative to its magnitude.
        pole_error: f64,
        /// Number of digits lost, of the 16 of a double.
        digits_lost: f64,
    },
    /// A steady Kalman filter.
    Filter {
        /// P⁻, the prior covariance.
        #[cfg_attr(feature = "serde", serde(rename = "P", serialize_with = "rows"))]
        prior: DMatrix<f64>,
        /// The gain of the update.
        #[cfg_attr(feature = "serde", serde(rename = "K_filter", serialize_with = "rows"))]
        filter_gain: DMatrix<f64>,
        /// The gain of the observer in predictor form.
        #[cfg_attr(feature = "serde", serde(rename = "K_predictor", serialize_with = "rows"))]
        predictor_gain: DMatrix<f64>,
        /// Number of doublings until convergence.
        doublings: u32,
    },
    /// A system in discrete time.
    Discrete {
        /// A in discrete time, the transition.
        #[cfg_attr(feature = "serde", serde(rename = "Ad", serialize_with = "rows"))]
        a: DMatrix<f64>,
        /// B in discrete time, the input matrix.
        #[cfg_attr(feature = "serde", serde(rename = "Bd", serialize_with = "rows"))]
        b: DMatrix<f64>,
    },
    /// The covariance of an observer's error.
    Covariance {
        /// P, the covariance.
        #[cfg_attr(feature = "serde", serde(rename = "P", serialize_with = "rows"))]
        covariance: DMatrix<f64>,
    },
}

#[cfg(feature = "serde")]
fn rows<S: serde::Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()))
}
