/// Why a tag cannot be tracked.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No tracker accepts these anchors.
    #[error("these anchors cannot be used: {0}")]
    Anchors(#[from] kestirim_uwb_tracker::Error),
    /// The published filter is not built for this number of anchors.
    #[error("the published filter is built for 3 to 8 anchors")]
    CountOfAnchors,
    /// The height of the tag is not given, and its ranges do not tell it.
    #[error("the ranges do not tell the tag's height")]
    HeightUnknown,
    /// The ranges do not tell the height well enough.
    #[error(
        "the ranges tell the tag's height to ± {sigma_m:.2} m only, and its position to ± {moved:.0} cm",
        moved = 100.0 * position_sigma_m
    )]
    HeightVague {
        /// Standard deviation of the height, m.
        sigma_m: f64,
        /// The standard deviation that it would add to the position, m.
        position_sigma_m: f64,
    },
    /// The times of a sensor fall back, and too many of them to be mistakes.
    #[error(
        "times fall back: {dropped} of {count} {what} are more than 10 s off the times around them, as where a clock begins anew: split the log there"
    )]
    Times {
        /// The samples.
        what: &'static str,
        /// Number of samples off the times around them.
        dropped: usize,
        /// Number of all samples.
        count: usize,
    },
}
