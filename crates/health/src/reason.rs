use core::fmt;

use crate::State;

/// Why an estimate is not good.
// The order is part of what is stored: a new one goes to the end, here and in `ALL`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(::serde::Serialize, ::serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Reason {
    /// A sensor was at its end.
    Saturated,
    /// A sensor repeated itself.
    Stuck,
    /// Data are missing, or too few.
    Dropout,
    /// More measurements than usual contradict the estimate and were left out.
    Rejected,
    /// What the estimate needs cannot be seen in the data.
    NotObservable,
    /// Times run too fast or too slow, some data are later than others, or products belong to another time.
    Time,
    /// Data seem to be in another unit, or of another sign.
    Units,
    /// Axes seem to be swapped or mirrored.
    Axes,
    /// Measurements and geometry contradict each other.
    Geometry,
    /// One anchor, or two that seem swapped, contradict the others.
    Anchor,
    /// The height that was said contradicts the measurements.
    Height,
    /// What is left of the measurements is beyond its bound.
    Innovations,
    /// The estimate left the range of its numbers.
    Range,
}

impl Reason {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Saturated,
        Self::Stuck,
        Self::Dropout,
        Self::Rejected,
        Self::NotObservable,
        Self::Time,
        Self::Units,
        Self::Axes,
        Self::Geometry,
        Self::Anchor,
        Self::Height,
        Self::Innovations,
        Self::Range,
    ];

    /// How far an estimate can be relied upon for all that.
    pub const fn state(self) -> State {
        match self {
            Self::Saturated
            | Self::Stuck
            | Self::Dropout
            | Self::Rejected
            | Self::NotObservable => State::Degraded,
            Self::Time
            | Self::Units
            | Self::Axes
            | Self::Geometry
            | Self::Anchor
            | Self::Height
            | Self::Innovations
            | Self::Range => State::Bad,
        }
    }

    /// As people read it.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Saturated => "saturated",
            Self::Stuck => "stuck",
            Self::Dropout => "dropout",
            Self::Rejected => "rejected",
            Self::NotObservable => "not observable",
            Self::Time => "time",
            Self::Units => "units",
            Self::Axes => "axes",
            Self::Geometry => "geometry",
            Self::Anchor => "anchor",
            Self::Height => "height",
            Self::Innovations => "innovations",
            Self::Range => "range",
        }
    }

    pub(crate) const fn bit(self) -> u16 {
        1 << self as u16
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())
    }
}
