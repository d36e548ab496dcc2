//! Gates that leave out spikes, and nothing else.

/// So many measurements in a row are left out at most: more contradictions are the estimate's fault.
const PATIENCE: u8 = 5;

/// Leaves out a measurement that contradicts the estimate, unless many before it did: then all are taken in until one
/// agrees, as if there were no gate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Gate {
    /// In a row.
    rejected: u8,
}

impl Gate {
    /// One that nothing has contradicted.
    pub(crate) const NEW: Self = Self { rejected: 0 };

    /// Whether a measurement is to be taken in.
    pub(crate) fn admits(&mut self, contradicts: bool) -> bool {
        let is_left_out = contradicts && self.rejected < PATIENCE;
        if !contradicts {
            self.rejected = 0;
        }
        self.rejected += u8::from(is_left_out);
        !is_left_out
    }

    /// Whether too many in a row have contradicted the estimate for another to be left out.
    pub(crate) const fn is_open(self) -> bool {
        self.rejected >= PATIENCE
    }
}
