use crate::phase_monitor::PhaseMonitor;
use kestirim_gnss_ppp::{Arc, Slip};

/// The state of a satellite while its ambiguity is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Channel {
    /// The satellite's number.
    pub(crate) satellite: u8,
    /// Combinations of the satellite's phases and codes, for cycle slip detection.
    pub(crate) arc: Arc,
    /// The phase wind-up at the last epoch, cycles.
    pub(crate) wind_up: f64,
    /// The monitor of the satellite's phase.
    pub(crate) monitor: PhaseMonitor,
}

impl Channel {
    /// A slip that two signs confirm: the wide lane is off, and the phase was rejected. An estimator without patience,
    /// which does not look for rejected phases, relies on the wide lane alone, if that stays off.
    pub(crate) fn agrees(&self, patience: Option<u8>) -> Option<Slip> {
        let slipped = match patience {
            Some(_) => self.arc.is_suspicious() && self.monitor.is_rejected(),
            None => self.arc.stays_away(),
        };
        slipped.then_some(Slip::MelbourneWuebbena)
    }
}
