use crate::phase_monitor::PhaseMonitor;
use kestirim_gnss_ppp::{Arc, Slip};

/// State of a satellite as long as its ambiguity is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Channel {
    /// Number of the satellite.
    pub(crate) satellite: u8,
    /// Combinations of its phases and codes, for the detection of slips.
    pub(crate) arc: Arc,
    /// Phase wind-up of its last epoch, cycles.
    pub(crate) wind_up: f64,
    /// Monitor of its phase.
    pub(crate) monitor: PhaseMonitor,
}

impl Channel {
    /// A slip by two signs: the wide lane is off, and the phase was rejected. An estimator without patience, which
    /// does not look for rejected phases, has the wide lane alone, if that stays off.
    pub(crate) fn agrees(&self, patience: Option<u8>) -> Option<Slip> {
        let slipped = match patience {
            Some(_) => self.arc.is_suspicious() && self.monitor.is_rejected(),
            None => self.arc.stays_away(),
        };
        slipped.then_some(Slip::MelbourneWuebbena)
    }
}
