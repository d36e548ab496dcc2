use kestirim_kalman as kalman;
use kestirim_uav_estimator as uav;

use super::{Log, Sample};

/// Why an estimator cannot follow a flight.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A sample is not later than the previous one.
    #[error("expected a later time than that of the sample before")]
    NotLater {
        /// The index of the sample, from 0.
        index: usize,
    },
    /// There are fewer than two samples, so there is no interval.
    #[error("expected at least two samples")]
    TooShort,
    /// The intervals between samples are irregular.
    #[error("expected samples at a regular interval, found {near} of {of} near {usual} s")]
    Irregular {
        /// The number of intervals that are close to the usual one.
        near: usize,
        /// The number of all intervals.
        of: usize,
        /// The usual interval, s.
        usual: f64,
    },
    /// Values are absolute, and the model has no trim to be subtracted from them.
    #[error("absolute values need a model with a trim")]
    NoTrim,
    /// Values are deviations, from which a grid of models cannot tell the airspeed.
    #[error("a grid of models needs absolute values: add --absolute")]
    GridOfDeviations,
    /// An estimator other than the Kalman filter was to use a grid of models.
    #[error(
        "a grid of models is for the Kalman filter: use --estimator kalman, or a model of one airspeed"
    )]
    GridOfObserver,
    /// A number exceeds the range of fixed point.
    #[error(
        "a number does not fit fixed point (Q16.16, below 32768 of the filter's units): use f32 or f64"
    )]
    BeyondRange,
    /// The estimator cannot be built.
    #[error("{0}")]
    Estimator(#[from] uav::Error),
    /// The estimator rejects a sample.
    #[error("{source}")]
    Sample {
        /// The index of the sample, from 0.
        index: usize,
        /// The reason.
        source: uav::Error,
    },
}

impl Error {
    /// Converts the error of a filter in fixed point: if everything measured is finite, a number that is not does not
    /// fit.
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
