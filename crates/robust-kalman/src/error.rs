use core::fmt;

/// Reason why an update was refused. The estimate is as it was before the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// The estimate refused a measurement.
    Estimate(kestirim_kalman::Error),
    /// The slice for the decisions is shorter than that of the measurements.
    TooFewDecisions,
    /// The block is empty, names states that the estimate does not have, or has more than
    /// [`MOST_STATES`](crate::MOST_STATES) of them.
    InvalidBlock,
    /// A threshold is not positive or out of order, or a floor is not in (0, 1].
    InvalidConfiguration,
}

impl From<kestirim_kalman::Error> for Error {
    fn from(error: kestirim_kalman::Error) -> Self {
        Self::Estimate(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Estimate(error) => error.fmt(formatter),
            Self::TooFewDecisions => {
                formatter.write_str("a measurement has no place for its decision")
            }
            Self::InvalidBlock => formatter.write_str("the block is not one of the state"),
            Self::InvalidConfiguration => {
                formatter.write_str("a threshold or a floor makes no sense")
            }
        }
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
            Error::TooFewDecisions,
            Error::InvalidBlock,
            Error::InvalidConfiguration,
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
