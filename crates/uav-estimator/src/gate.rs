//! Gates that reject spikes only.

/// Largest number of successive rejections: further contradictions are due to the estimate.
const PATIENCE: u8 = 5;

/// Rejects a measurement that contradicts the estimate, unless many before it did: then all are admitted until one
/// agrees, as without a gate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Gate {
    /// Number of successive rejections.
    rejected: u8,
}

impl Gate {
    /// A gate without rejections.
    pub(crate) const NEW: Self = Self { rejected: 0 };

    /// Whether a measurement is to be used.
    pub(crate) fn admits(&mut self, contradicts: bool) -> bool {
        let is_left_out = contradicts && self.rejected < PATIENCE;
        if !contradicts {
            self.rejected = 0;
        }
        self.rejected += u8::from(is_left_out);
        !is_left_out
    }

    /// Whether the gate is open because of too many successive contradictions.
    pub(crate) const fn is_open(self) -> bool {
        self.rejected >= PATIENCE
    }
}
