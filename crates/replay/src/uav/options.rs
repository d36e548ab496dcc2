//! What can be chosen about an estimator.

use super::Poles;
use super::poles::MIDDLE;
use crate::ScalarKind;

/// Which estimator follows a flight.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "lowercase"))]
pub enum EstimatorKind {
    /// A Kalman filter
    #[default]
    Kalman,
    /// A Luenberger observer
    Luenberger,
}

/// Everything that can be chosen about the estimators.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Which one.
    pub estimator: EstimatorKind,
    /// Of the observer, 1/s.
    pub poles: Poles,
    /// Standard deviations of the inputs' noise; none is those of usual sensors.
    pub inputs: Option<[f64; 2]>,
    /// The same of the outputs.
    pub outputs: Option<[f64; 4]>,
    /// Q/R of the filter, times that of the noise.
    pub ratio: f64,
    /// Number type.
    pub scalar: ScalarKind,
}

impl Options {
    /// The same with another estimator.
    pub const fn with(&self, estimator: EstimatorKind) -> Self {
        Self { estimator, ..*self }
    }

    /// Standard deviations of the inputs' noise with this Q/R.
    pub fn weighted(&self, inputs: [f64; 2]) -> [f64; 2] {
        inputs.map(|sigma| sigma * self.ratio.sqrt())
    }
}

impl Default for Options {
    /// The filter, for usual sensors.
    fn default() -> Self {
        Self {
            estimator: EstimatorKind::default(),
            poles: MIDDLE,
            inputs: None,
            outputs: None,
            ratio: 1.0,
            scalar: ScalarKind::F64,
        }
    }
}
