use kestirim_health::{Health, Reason};

use crate::gate::Gate;
use crate::kalman_filter::Gated;
use crate::lateness::Lateness;
use crate::monitor::Monitor;

/// Supervision of a filter's outputs, from which the reliability of its estimate is judged.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Watch<const P: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(crate) gates: [Gate; P],
    /// Number of rejections of each output.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    pub(crate) rejected: [u32; P],
    monitor: Monitor,
    lateness: Lateness<P>,
}

impl<const P: usize> Watch<P> {
    /// A state without samples.
    pub(crate) const NEW: Self = Self {
        gates: [Gate::NEW; P],
        rejected: [0; P],
        monitor: Monitor::NEW,
        lateness: Lateness::NONE,
    };

    /// Forgets what was judged by an estimate that begins anew, but not how many measurements were rejected.
    pub(crate) fn begin_anew(&mut self) {
        self.gates = [Gate::NEW; P];
        self.lateness = Lateness::NONE;
    }

    /// Adds a sample: the result for its outputs, and those outputs that are checked for lateness.
    pub(crate) fn count(&mut self, timed: &[Option<f64>; P], judged: &Gated<P>) {
        for (rejected, is_left_out) in self.rejected.iter_mut().zip(judged.is_left_out) {
            *rejected = rejected.saturating_add(u32::from(is_left_out));
        }
        let of = || judged.innovations.iter().flatten().map(|innovation| innovation.nis);
        let left_out = judged.is_left_out.iter().filter(|is_left_out| **is_left_out).count();
        self.monitor.count(of().count(), left_out, of());
        self.lateness.count(timed, &judged.innovations);
    }

    /// The present assessment.
    pub(crate) fn health(&self) -> Health {
        self.monitor.health().with(Reason::Time, self.lateness.is_told())
    }
}
