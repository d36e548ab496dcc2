use core::fmt;

use crate::State;

/// Reason why an estimate is not good.
// The order is part of the stored form: add a new one at the end, here and in `ALL`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(::serde::Serialize, ::serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Reason {
    /// A sensor reached the end of its range.
    Saturated,
    /// A sensor keeps repeating the same value.
    Stuck,
    /// Data are missing, or there are too few.
    Dropout,
    /// More measurements than usual contradict the estimate and were rejected.
    Rejected,
    /// A quantity that the estimate needs is not observable in the data.
    NotObservable,
    /// Time stamps run too fast or too slow, some data are later than others, or products belong to another time.
    Time,
    /// Data seem to be in another unit or to have another sign.
    Units,
    /// Axes seem to be swapped or mirrored.
    Axes,
    /// Measurements and geometry contradict each other.
    Geometry,
    /// One anchor, or two that seem swapped, contradict the others.
    Anchor,
    /// The height that was given contradicts the measurements.
    Height,
    /// The innovations of the measurements exceed their bound.
    Innovations,
    /// The estimate left the range of its number type.
    Range,
}

impl Reason {
    /// All reasons, in the order of their declaration.
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

    /// The degree to which an estimate can be relied upon in spite of this reason.
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

    /// The reason in words for people.
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
