use core::fmt;

/// Reason why a step was refused. Nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A number is NaN, infinite or at a limit of fixed point.
    NotFinite,
    /// A width, a weight or a deviation is negative, or a count is zero.
    NotPositive,
    /// There are more particles than there is room for.
    TooMany,
    /// Every weight is zero or not a number: no particle explains the measurement.
    Degenerate,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::NotPositive => "a number that must be positive is not",
            Self::TooMany => "there are more particles than there is room for",
            Self::Degenerate => "no particle explains what was measured",
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
        let all = [Error::NotFinite, Error::NotPositive, Error::TooMany, Error::Degenerate];
        let sentences: BTreeSet<_> = all.iter().map(ToString::to_string).collect();
        assert_eq!(sentences.len(), all.len());
        for sentence in &sentences {
            assert!(sentence.starts_with(char::is_lowercase) && !sentence.ends_with('.'));
            assert!(sentence.len() < 120, "{sentence}");
        }
    }
}
