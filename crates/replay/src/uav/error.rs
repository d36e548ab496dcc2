use kestirim_kalman as kalman;
use kestirim_uav_estimator as uav;

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
    /// Something is beyond the range of fixed point.
    #[error("a number is beyond ±32768 units, as far as Q16.16 goes: f32 and f64 have room")]
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
    /// The same of an estimator in fixed point: what is read is finite, so what is not does not fit.
    pub(super) fn of_fixed_point(self) -> Self {
        match self {
            Self::Estimator(source) | Self::Sample { source, .. } => match source {
                uav::Error::NotFinite | uav::Error::Estimate(kalman::Error::NotFinite) => {
                    Self::BeyondRange
                }
                _ => self,
            },
            other => other,
        }
    }
}
