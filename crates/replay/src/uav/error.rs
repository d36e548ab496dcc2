use kestirim_kalman as kalman;
use kestirim_uav_estimator as uav;

use super::{Log, Sample};

/// Why a flight is not followed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A sample is not later than the one before.
    #[error("expected a later time than that of the sample before")]
    NotLater {
        /// Which, counted from 0.
        index: usize,
    },
    /// An interval takes two samples.
    #[error("expected at least two samples")]
    TooShort,
    /// No interval is the usual one.
    #[error("expected samples at a regular interval, found {near} of {of} near {usual} s")]
    Irregular {
        /// Intervals that are nearly the usual one.
        near: usize,
        /// All intervals.
        of: usize,
        /// The usual one, s.
        usual: f64,
    },
    /// Values are absolute, and the model does not say what is to be taken from them.
    #[error("absolute values need a model with a trim")]
    NoTrim,
    /// Values are deviations, of which a grid of models cannot tell the airspeed.
    #[error("a grid of models needs absolute values: add --absolute")]
    GridOfDeviations,
    /// Another estimator than the Kalman filter is to use a grid of models.
    #[error(
        "a grid of models is for the Kalman filter: use --estimator kalman, or a model of one airspeed"
    )]
    GridOfObserver,
    /// Something is beyond the range of fixed point.
    #[error(
        "a number does not fit fixed point (Q16.16, below 32768 of the filter's units): use f32 or f64"
    )]
    BeyondRange,
    /// No such estimator can be built.
    #[error("{0}")]
    Estimator(#[from] uav::Error),
    /// The estimator refuses a sample.
    #[error("{source}")]
    Sample {
        /// Which, counted from 0.
        index: usize,
        /// Why.
        source: uav::Error,
    },
}

impl Error {
    /// The same of a filter in fixed point: where all that was measured is finite, what is not does not fit.
    pub(super) fn of_fixed_point(self, log: &Log) -> Self {
        let is_finite = |sample: &Sample| {
            let mut numbers = sample.input.iter().chain(sample.measured.iter().flatten());
            numbers.all(|number| number.is_finite())
        };
        let source = match self {
            Self::Estimator(source) => source,
            Self::Sample { index, source } if log.samples.get(index).is_some_and(is_finite) => {
                source
            }
            other => return other,
        };
        match source {
            uav::Error::NotFinite | uav::Error::Estimate(kalman::Error::NotFinite) => {
                Self::BeyondRange
            }
            _ => self,
        }
    }
}
