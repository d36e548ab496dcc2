use core::fmt;

/// Reason why a prediction or an update was refused. The estimate is as it was before the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument or the resulting estimate is NaN, infinite or at a limit of fixed point.
    NotFinite,
    /// A variance is negative, or the innovation's variance is not positive, so nothing can be
    /// weighed with it.
    NotPositive,
    /// A measurement row names a state that the estimate does not have.
    IndexOutOfRange,
    /// The covariance does not settle: a growing state is not observed, or a mode is so slow that
    /// the iterations ran out.
    NotConverged,
    /// A measurement's model has no derivative at this mean, or none that can be trusted.
    NotLinearisable,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a variance is not positive",
            Self::NotConverged => "the covariance does not settle",
            Self::NotLinearisable => "a measurement cannot be linearised at this state",
            Self::IndexOutOfRange => "a measurement row names a state that does not exist",
        })
    }
}

impl core::error::Error for Error {}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::collections::BTreeSet;
    use std::string::ToString;

    use super::*;

    #[test]
    fn every_reason_is_a_sentence_of_its_own() {
        let all = [
            Error::NotFinite,
            Error::NotPositive,
            Error::IndexOutOfRange,
            Error::NotConverged,
            Error::NotLinearisable,
        ];
        let sentences: BTreeSet<_> = all.iter().map(ToString::to_string).collect();
        assert_eq!(sentences.len(), all.len());
        for sentence in &sentences {
            assert!(sentence.starts_with(char::is_lowercase) && !sentence.ends_with('.'));
            assert!(sentence.len() < 120, "{sentence}");
        }
    }
}
