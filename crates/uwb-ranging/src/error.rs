use core::fmt;

/// Reason for which there is no result. Nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument, or the answer, is NaN, infinite or on a rail of fixed point.
    NotFinite,
    /// A variance is not positive.
    NotPositive,
    /// Fewer ranges than unknowns.
    TooFewRanges,
    /// The anchors stand so that the answer is not determined: in a line, or in a plane where three
    /// dimensions are asked for.
    DegenerateGeometry,
    /// The iterations ran out.
    NotConverged,
    /// An exchange of which all intervals are zero.
    EmptyExchange,
    /// A table whose entries are not in rising order.
    UnorderedTable,
    /// No anchor has this number.
    NoSuchAnchor,
    /// This message, or a later one of the same anchor, came before.
    Repeated,
    /// A clock that differs by more than 100 ppm from another is none: an anchor has begun anew.
    ImplausibleClock,
    /// A difference of distances that is larger than the distance between the anchors.
    ImplausibleDifference,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a variance is not positive",
            Self::TooFewRanges => "there are fewer ranges than unknowns",
            Self::DegenerateGeometry => "the anchors' places do not determine the answer",
            Self::NotConverged => "the iterations did not converge",
            Self::EmptyExchange => "the intervals of an exchange are zero",
            Self::UnorderedTable => "the entries of a table are not in rising order",
            Self::NoSuchAnchor => "there is no anchor of this number",
            Self::Repeated => "this message came before",
            Self::ImplausibleClock => "no clock differs so much from another",
            Self::ImplausibleDifference => "the difference is larger than the anchors' distance",
        })
    }
}

impl core::error::Error for Error {}
