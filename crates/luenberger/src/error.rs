use core::fmt;

/// Reason why an observer was not built or did not step. The estimate is as it was before the call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// An argument or the resulting estimate is NaN, infinite or at a limit of fixed point.
    NotFinite,
    /// The coefficients of a row add up to more than the scalar type can hold.
    TooLarge,
    /// The index of a measured state does not exist, or is given twice.
    WrongState,
    /// A lower limit is above the upper one, or is not a number.
    WrongLimits,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a number is not finite",
            Self::TooLarge => "the coefficients do not fit the scalar",
            Self::WrongState => "a measured state does not exist or is named twice",
            Self::WrongLimits => "a lower limit is above the upper one",
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
        let all = [Error::NotFinite, Error::TooLarge, Error::WrongState, Error::WrongLimits];
        let sentences: BTreeSet<_> = all.iter().map(ToString::to_string).collect();
        assert_eq!(sentences.len(), all.len());
        for sentence in &sentences {
            assert!(sentence.starts_with(char::is_lowercase) && !sentence.ends_with('.'));
            assert!(sentence.len() < 120, "{sentence}");
        }
    }
}
