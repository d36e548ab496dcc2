use crate::watch::Watch;
use kestirim_gnss_ppp::{Arc, Slip};

/// What is remembered of a satellite as long as its ambiguity is.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Channel {
    /// Which GPS satellite (PRN).
    pub(crate) satellite: u8,
    /// What its combinations were, for slips to be seen.
    pub(crate) arc: Arc,
    /// Phase wind-up of its last epoch, cycles.
    pub(crate) wind_up: f64,
    /// How its phase behaves.
    pub(crate) watch: Watch,
}

impl Channel {
    /// A slip by two witnesses: the wide lane is off, and the phase was not heard. Only an estimator
    /// with patience for slips listens.
    pub(crate) fn agrees(&self, patience: Option<u8>) -> Option<Slip> {
        let both = self.arc.is_suspicious() && self.watch.is_unheard();
        (both && patience.is_some()).then_some(Slip::MelbourneWuebbena)
    }
}
