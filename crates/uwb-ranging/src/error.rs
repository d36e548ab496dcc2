use core::fmt;

/// The reason why there is no result. The state is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument, or the answer, is NaN, infinite or on a rail of fixed point.
    NotFinite,
    /// A variance is not positive.
    NotPositive,
    /// There are fewer ranges than unknowns.
    TooFewRanges,
    /// The anchors' positions do not determine the answer: they are collinear, or coplanar where three dimensions
    /// are requested.
    DegenerateGeometry,
    /// The iterations did not converge.
    NotConverged,
    /// All intervals of an exchange are zero.
    EmptyExchange,
    /// The entries of a table are not in increasing order.
    UnorderedTable,
    /// There is no anchor with this index.
    NoSuchAnchor,
    /// This message, or a later one of the same anchor, was processed before.
    Repeated,
    /// Two clocks differ by more than 100 ppm, which no real ones do: an anchor has restarted.
    ImplausibleClock,
    /// A difference of distances exceeds the distance between the anchors.
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
