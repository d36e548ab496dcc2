/// Why a tracker cannot compute a walk from a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The log is too short to integrate anything.
    #[error("expected a log of at least {needed} samples, found {found}")]
    TooShort {
        /// The number of samples in the log.
        found: usize,
        /// The number of samples that are needed.
        needed: usize,
    },
    /// The tracker rejects a sample.
    #[error("sample {index}: {source}")]
    Sample {
        /// The number of the sample, counted from 1.
        index: usize,
        /// The reason.
        source: kestirim_pedestrian::Error,
    },
}
