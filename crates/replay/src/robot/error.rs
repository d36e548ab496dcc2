/// Why a tag is not followed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No tracker takes these anchors.
    #[error("these anchors cannot be used: {0}")]
    Anchors(#[from] kestirim_uwb_tracker::Error),
    /// The published filter is not built for so many anchors.
    #[error("the published filter is built for 3 to 8 anchors")]
    CountOfAnchors,
    /// Nobody says how high the tag is, and its ranges do not tell.
    #[error("the ranges do not tell the tag's height")]
    HeightUnknown,
    /// They do not tell it well enough.
    #[error(
        "the ranges tell the tag's height to ± {sigma_m:.2} m only, and its position to ± {moved:.0} cm",
        moved = 100.0 * position_sigma_m
    )]
    HeightVague {
        /// Standard deviation of the height, m.
        sigma_m: f64,
        /// What it would add to the position's standard deviation, m.
        position_sigma_m: f64,
    },
}
