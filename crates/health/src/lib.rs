#![doc = include_str!("../README.md")]
#![no_std]

mod reason;
#[cfg(feature = "serde")]
mod serde;

use core::fmt;

pub use reason::Reason;

/// Degree to which an estimate can be relied upon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(::serde::Serialize, ::serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum State {
    /// The estimate is as good as its standard deviation says.
    #[default]
    Good,
    /// The estimate is worse than with better data; its stated accuracy still holds approximately.
    Degraded,
    /// The estimate may be wrong by far more than its stated accuracy.
    Bad,
}

impl State {
    /// The word for the state.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Degraded => "degraded",
            Self::Bad => "bad",
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// Whether an estimate can be relied upon, and all reasons why it cannot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Health {
    /// One bit for each reason.
    bits: u16,
}

impl Health {
    /// A good estimate, with no reason against it.
    pub const GOOD: Self = Self { bits: 0 };

    /// Adds a reason.
    pub const fn add(&mut self, reason: Reason) {
        self.bits |= reason.bit();
    }

    /// The same health with this reason added if `is_so`.
    #[must_use]
    pub const fn with(self, reason: Reason, is_so: bool) -> Self {
        Self { bits: self.bits | if is_so { reason.bit() } else { 0 } }
    }

    /// The health with the reasons of both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self { bits: self.bits | other.bits }
    }

    /// Whether `reason` is among the reasons.
    pub const fn has(self, reason: Reason) -> bool {
        self.bits & reason.bit() != 0
    }

    /// The reasons as bits, in a form that is kept from version to version: for telemetry and storage.
    pub const fn bits(self) -> u16 {
        self.bits
    }

    /// The health with these [bits](Self::bits); `None` if one of them is a reason of a later version.
    pub const fn from_bits(bits: u16) -> Option<Self> {
        let unknown = bits >> Reason::ALL.len();
        if unknown == 0 { Some(Self { bits }) } else { None }
    }

    /// The state of the worst reason.
    pub fn state(self) -> State {
        self.reasons().map(Reason::state).max().unwrap_or_default()
    }

    /// The reasons, each once, in the order of their declaration.
    pub fn reasons(self) -> impl Iterator<Item = Reason> {
        Reason::ALL.into_iter().filter(move |reason| self.has(*reason))
    }
}

impl From<Reason> for Health {
    fn from(reason: Reason) -> Self {
        Self { bits: reason.bit() }
    }
}

impl FromIterator<Reason> for Health {
    fn from_iter<I: IntoIterator<Item = Reason>>(reasons: I) -> Self {
        reasons.into_iter().fold(Self::GOOD, |health, reason| health.and(reason.into()))
    }
}

/// Writes `good`, or the state and its reasons: `bad: dropout, innovations`.
impl fmt::Display for Health {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.state().word())?;
        for (index, reason) in self.reasons().enumerate() {
            f.write_str(if index == 0 { ": " } else { ", " })?;
            f.write_str(reason.words())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::string::ToString;

    #[test]
    fn the_worst_reason_decides() {
        let mut health = Health::GOOD;
        assert_eq!(health.to_string(), "good");
        health.add(Reason::Dropout);
        assert_eq!(health.to_string(), "degraded: dropout");
        for reason in [Reason::Anchor, Reason::Saturated, Reason::Anchor] {
            health.add(reason);
        }
        assert_eq!(health.to_string(), "bad: saturated, dropout, anchor");
        assert_eq!(health.with(Reason::Stuck, false), health);
    }

    #[test]
    fn each_reason_has_a_bit_of_its_own() {
        let all: Health = Reason::ALL.into_iter().collect();
        assert!(all.reasons().eq(Reason::ALL));
        assert_eq!(all.bits().count_ones() as usize, Reason::ALL.len());
        assert_eq!(Health::from_bits(all.bits()), Some(all));
        assert_eq!(Health::from_bits(all.bits() + 1), None);
    }

    #[cfg(feature = "serde")]
    #[test]
    fn people_read_words() {
        let health: Health = [Reason::NotObservable, Reason::Range].into_iter().collect();
        let written = serde_json::to_string(&health).expect("text");
        assert_eq!(written, r#"{"state":"bad","reasons":["not-observable","range"]}"#);
        assert_eq!(serde_json::from_str::<Health>(&written).expect("a health"), health);
    }
}
