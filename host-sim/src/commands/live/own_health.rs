//! How far a sender relies on its own estimate.

use std::fmt;

use kestirim_health::{Health, State};
use serde::{Serialize, Serializer};

/// The health of a sender's estimate, as an `EstimateHealth` tells it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnHealth {
    /// A health that this version knows.
    Known(Health),
    /// A health with a reason of a later version.
    Unknown,
}

impl OwnHealth {
    /// From the reasons as bits.
    pub(super) fn from_bits(reasons: u16) -> Self {
        Health::from_bits(reasons).map_or(Self::Unknown, Self::Known)
    }

    /// Whether the estimate may be wrong by far more than it says; so may one with an unknown reason.
    pub(super) fn is_bad(self) -> bool {
        match self {
            Self::Known(health) => health.state() == State::Bad,
            Self::Unknown => true,
        }
    }
}

impl fmt::Display for OwnHealth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Known(health) => health.fmt(f),
            Self::Unknown => f.write_str("a reason that this version does not know"),
        }
    }
}

/// As a [`Health`] is written; the reason of an unknown one is `unknown`.
impl Serialize for OwnHealth {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Unknown {
            state: State,
            reasons: [&'static str; 1],
        }
        match self {
            Self::Known(health) => health.serialize(serializer),
            Self::Unknown => {
                Unknown { state: State::Bad, reasons: ["unknown"] }.serialize(serializer)
            }
        }
    }
}
