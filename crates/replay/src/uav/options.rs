//! Options of the estimators.

use super::Poles;
use super::poles::MIDDLE;
use crate::ScalarKind;

/// The kind of estimator.
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

/// All options of the estimators.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The kind of estimator.
    pub estimator: EstimatorKind,
    /// The poles of the observer, 1/s.
    pub poles: Poles,
    /// Standard deviations of the inputs' noise; `None` stands for those of usual sensors.
    pub inputs: Option<[f64; 2]>,
    /// Standard deviations of the outputs' noise; `None` stands for those of usual sensors.
    pub outputs: Option<[f64; 4]>,
    /// The ratio Q/R of the filter, relative to that of the noise.
    pub ratio: f64,
    /// Number type.
    pub scalar: ScalarKind,
}

impl Options {
    /// The options with another estimator.
    pub const fn with(&self, estimator: EstimatorKind) -> Self {
        Self { estimator, ..*self }
    }

    /// Scales standard deviations of the inputs' noise to this Q/R.
    pub fn weighted(&self, inputs: [f64; 2]) -> [f64; 2] {
        inputs.map(|sigma| sigma * self.ratio.sqrt())
    }
}

impl Default for Options {
    /// The Kalman filter, for usual sensors.
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
