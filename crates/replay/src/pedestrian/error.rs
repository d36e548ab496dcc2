/// Why a tracker makes no walk of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Too short to integrate anything.
    #[error("expected a log of at least {needed} samples, found {found}")]
    TooShort {
        /// Samples of the log.
        found: usize,
        /// Samples it takes.
        needed: usize,
    },
    /// The tracker refuses a sample.
    #[error("sample {index}: {source}")]
    Sample {
        /// Counted from 1.
        index: usize,
        /// Why.
        source: kestirim_pedestrian::Error,
    },
}
