use core::fmt;

/// Reason why a step was refused. The filter is as it was before the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// The underlying estimate refused the step.
    Estimate(kestirim_kalman::Error),
    /// No measurement has this index.
    NoSuchMeasurement,
    /// A forgetting factor is not in 0..=1, or the limits of a variance are negative, out of order
    /// or not finite.
    InvalidLearning,
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
            Self::NoSuchMeasurement => {
                formatter.write_str("there is no measurement of this number")
            }
            Self::InvalidLearning => {
                formatter.write_str("a forgetting factor or a limit makes no sense")
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
            Error::NoSuchMeasurement,
            Error::InvalidLearning,
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
