//! Cycle slips, as the combinations of one satellite's observations show them.

use crate::GpsTime;
use crate::signal::{geometry_free, melbourne_wuebbena};

/// Why a satellite's ambiguity is not what it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slip {
    /// It was not observed for too long.
    Gap,
    /// The receiver says that it lost lock.
    LossOfLock,
    /// The geometry-free phase jumped.
    GeometryFree,
    /// The Melbourne–Wübbena combination jumped.
    MelbourneWuebbena,
}

/// From when on a jump is a slip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SlipLimits {
    /// The longest time without observations that an ambiguity survives, s.
    pub gap: f64,
    /// Jump of L1 − L2 between epochs, m. Slips of 9 and 7 cycles jump by 5 cm only where the
    /// ionosphere does so by itself.
    pub geometry_free: f64,
    /// Jump of the Melbourne–Wübbena combination beside its running mean, cycles of the wide lane,
    /// at least.
    pub melbourne_wuebbena: f64,
    /// The same in its own running standard deviations: both must be exceeded.
    pub deviations: f64,
    /// Whether the receiver's own flag of lost lock counts.
    pub loss_of_lock: bool,
}

impl Default for SlipLimits {
    fn default() -> Self {
        Self {
            gap: 300.0,
            geometry_free: 0.05,
            melbourne_wuebbena: 2.0,
            deviations: 5.0,
            loss_of_lock: true,
        }
    }
}

/// What is remembered of one satellite's arc (Blewitt 1990).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Arc {
    last: GpsTime,
    geometry_free: f64,
    wide_lane: f64,
    wide_lane_variance: f64,
    count: u16,
}

/// The running mean forgets over this many epochs: multipath of the code wanders.
const MEMORY: u16 = 100;
/// Standard deviation of one epoch's combination before any is known, cycles.
const WIDE_LANE_DEVIATION: f64 = 0.7;

impl Arc {
    /// An arc that begins: `phase` in cycles, `code` in m.
    pub fn begin(time: GpsTime, phase: [f64; 2], code: [f64; 2]) -> Self {
        Self {
            last: time,
            geometry_free: geometry_free(phase),
            wide_lane: melbourne_wuebbena(phase, code),
            wide_lane_variance: WIDE_LANE_DEVIATION * WIDE_LANE_DEVIATION,
            count: 1,
        }
    }

    /// Goes on with the next epoch; a slip begins a new arc.
    pub fn observe(
        &mut self,
        time: GpsTime,
        phase: [f64; 2],
        code: [f64; 2],
        lock_lost: bool,
        limits: &SlipLimits,
    ) -> Option<Slip> {
        let elapsed = time.since(self.last);
        let jump = geometry_free(phase) - self.geometry_free;
        let wide_lane = melbourne_wuebbena(phase, code) - self.wide_lane;
        let allowed = limits.deviations * libm::sqrt(self.wide_lane_variance);
        let slip = if !(elapsed <= limits.gap) {
            Some(Slip::Gap)
        } else if lock_lost && limits.loss_of_lock {
            Some(Slip::LossOfLock)
        } else if !(jump.abs() <= limits.geometry_free) {
            Some(Slip::GeometryFree)
        } else if !(wide_lane.abs() <= allowed.max(limits.melbourne_wuebbena)) {
            Some(Slip::MelbourneWuebbena)
        } else {
            None
        };
        if slip.is_some() {
            *self = Self::begin(time, phase, code);
            return slip;
        }
        self.count = (self.count + 1).min(MEMORY);
        let share = 1.0 / f64::from(self.count);
        self.last = time;
        self.geometry_free += jump;
        self.wide_lane += share * wide_lane;
        self.wide_lane_variance += share * (wide_lane * wide_lane - self.wide_lane_variance);
        None
    }

    /// When the satellite was observed last.
    pub const fn last(&self) -> GpsTime {
        self.last
    }
}
