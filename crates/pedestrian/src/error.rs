use core::fmt;

/// The reason why a sample was refused. The tracker is unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Error {
    /// A component is NaN, infinite or at the limit of a fixed-point type.
    NotFinite,
    /// No sensor can have measured the value: beyond 1000 g or 10⁵ °/s.
    Implausible,
    /// The time stamp precedes that of the last accepted sample.
    TimeBackwards,
    /// The working memory has fewer entries than the recording has samples.
    NoMemory,
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotFinite => "a component of the sample is not finite",
            Self::Implausible => "no sensor measures beyond 1000 g or 100000 degrees a second",
            Self::TimeBackwards => "the sample is older than the one before it",
            Self::NoMemory => "the working memory is shorter than the recording",
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
        let all = [Error::NotFinite, Error::Implausible, Error::TimeBackwards, Error::NoMemory];
        let sentences: BTreeSet<_> = all.iter().map(ToString::to_string).collect();
        assert_eq!(sentences.len(), all.len());
        for sentence in &sentences {
            assert!(sentence.starts_with(char::is_lowercase) && !sentence.ends_with('.'));
            assert!(sentence.len() < 120, "{sentence}");
        }
    }
}
