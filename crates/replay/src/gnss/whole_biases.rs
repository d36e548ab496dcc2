//! The satellite biases that are needed for integer ambiguities.

use std::collections::BTreeMap;
use std::sync::Arc;

use kestirim_gnss_files::{self as files, Biases, Clocks, Signals};
use kestirim_gnss_ppp::GpsTime;
use kestirim_ppp_filter::PhaseBias;

use super::model::carriers;

/// Wide-lane biases of a file of integer clocks, or absolute biases of phases.
#[derive(Debug, Default)]
pub struct WholeBiases {
    /// Wide-lane biases by day and satellite, cycles.
    wide_lanes: BTreeMap<(i32, u8), f64>,
    biases: Arc<Biases>,
    signals: BTreeMap<u8, Signals>,
}

impl WholeBiases {
    pub(super) fn new(
        clocks: Option<&Clocks>,
        biases: Arc<Biases>,
        signals: &BTreeMap<u8, Signals>,
    ) -> Self {
        let wide_lanes = clocks.map(|clocks| clocks.wide_lanes().collect()).unwrap_or_default();
        Self { wide_lanes, biases, signals: signals.clone() }
    }

    /// The biases of a satellite's phases at a time: absolute ones, if those of its codes are known as well; otherwise
    /// the wide lane of the clock file, if the codes are those to which clocks refer or were corrected.
    pub fn of(&self, satellite: u8, time: GpsTime) -> Option<PhaseBias> {
        let signals = self.signals.get(&satellite)?;
        let at = files::GpsTime::new(time.day(), time.second());
        let codes = self.biases.of_codes(satellite, signals.carriers, signals.code, at);
        let phases = self.biases.of_phases(satellite, signals.phase, at);
        if let (Some(_), Some(phases)) = (codes, phases) {
            return Some(PhaseBias::absolute(carriers(signals.carriers), phases));
        }
        let wide_lane = self.wide_lanes.get(&(time.day(), satellite))?;
        let known = codes.is_some() || signals.are_reference();
        known.then_some(PhaseBias { wide_lane: *wide_lane, ionosphere_free: 0.0 })
    }

    /// Whether no bias of any satellite is known.
    pub(super) fn is_empty(&self) -> bool {
        self.wide_lanes.is_empty() && !self.biases.have_phases()
    }
}
