//! What a design gives.

use nalgebra::DMatrix;

/// What a design gives.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(untagged))]
pub enum Solution {
    /// An observer gain.
    Gain {
        /// L.
        #[cfg_attr(feature = "serde", serde(rename = "L", serialize_with = "rows"))]
        gain: DMatrix<f64>,
        /// How far the worst pole is off, beside its size.
        pole_error: f64,
        /// Of the 16 digits of a double.
        digits_lost: f64,
    },
    /// A steady Kalman filter.
    Filter {
        /// The prior covariance.
        #[cfg_attr(feature = "serde", serde(rename = "P", serialize_with = "rows"))]
        prior: DMatrix<f64>,
        /// The gain of the update.
        #[cfg_attr(feature = "serde", serde(rename = "K_filter", serialize_with = "rows"))]
        filter_gain: DMatrix<f64>,
        /// The gain of the observer in predictor form.
        #[cfg_attr(feature = "serde", serde(rename = "K_predictor", serialize_with = "rows"))]
        predictor_gain: DMatrix<f64>,
        /// How many it took.
        doublings: u32,
    },
    /// A system in discrete time.
    Discrete {
        /// The transition.
        #[cfg_attr(feature = "serde", serde(rename = "Ad", serialize_with = "rows"))]
        a: DMatrix<f64>,
        /// The input matrix.
        #[cfg_attr(feature = "serde", serde(rename = "Bd", serialize_with = "rows"))]
        b: DMatrix<f64>,
    },
    /// The covariance of an observer's error.
    Covariance {
        /// P.
        #[cfg_attr(feature = "serde", serde(rename = "P", serialize_with = "rows"))]
        covariance: DMatrix<f64>,
    },
}

#[cfg(feature = "serde")]
fn rows<S: serde::Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()))
}
