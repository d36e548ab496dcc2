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
