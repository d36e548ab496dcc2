use core::fmt;

/// The reason why a sample was refused. The tracker is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN, infinite or on a rail of fixed point.
    NotFinite,
    /// The range is below −1 m or above 200 m, which no radio measures.
    ImplausibleRange,
    /// The motion is beyond the limits of sensors on a robot (500 m/s², 100 m/s, 100 rad/s).
    ImplausibleMotion,
    /// There is no anchor with this index.
    NoSuchAnchor,
    /// There are more anchors than the tracker has room for.
    TooManyAnchors,
    /// There are fewer than three anchors, where a height is to be found.
    TooFewAnchors,
    /// A range of the same anchor with the same time was processed before.
    Duplicate,
    /// The sample is older than the estimate. If all samples are, the clock has jumped: create a new tracker.
    OutOfOrder,
    /// The Kalman filter refused the update.
    Estimate(kestirim_kalman::Error),
}

impl From<kestirim_kalman::Error> for Error {
    fn from(error: kestirim_kalman::Error) -> Self {
        Self::Estimate(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::ImplausibleRange => "no radio measures this range",
            Self::ImplausibleMotion => "no robot moves like this",
            Self::NoSuchAnchor => "there is no anchor of this number",
            Self::TooManyAnchors => "there are more anchors than the tracker has room for",
            Self::TooFewAnchors => "there are fewer than three anchors",
            Self::Duplicate => "this range came before",
            Self::OutOfOrder => "the sample is older than the estimate",
            Self::Estimate(error) => return error.fmt(formatter),
        })
    }
}

impl core::error::Error for Error {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Estimate(error) => Some(error),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::collections::BTreeSet;
    use std::string::ToString;

    use super::*;

    #[test]
    fn every_reason_is_a_sentence_of_its_own() {
        let all = [
            Error::Estimate(kestirim_kalman::Error::NotPositive),
            Error::NotFinite,
            Error::ImplausibleRange,
            Error::ImplausibleMotion,
            Error::NoSuchAnchor,
            Error::TooManyAnchors,
            Error::TooFewAnchors,
            Error::Duplicate,
            Error::OutOfOrder,
        ];
        let sentences: BTreeSet<_> = all.iter().map(ToString::to_string).collect();
        assert_eq!(sentences.len(), all.len());
        for sentence in &sentences {
            assert!(sentence.starts_with(char::is_lowercase) && !sentence.ends_with('.'));
            assert!(sentence.len() < 120, "{sentence}");
        }
        let has_source = |error: &&Error| core::error::Error::source(*error).is_some();
        assert_eq!(all.iter().filter(has_source).count(), 1);
    }
}
