//! Detection of cycle slips from combinations of one satellite's observations.

use crate::{Carriers, GpsTime};

/// The reason for assuming a cycle slip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Slip {
    /// The satellite was not observed for too long.
    Gap,
    /// The receiver reports a loss of lock.
    LossOfLock,
    /// The geometry-free phase jumped.
    GeometryFree,
    /// The Melbourne–Wübbena combination jumped, and a second sign confirms it: see [`Arc::is_suspicious`] and
    /// [`Arc::stays_away`].
    MelbourneWuebbena,
    /// The phases of all satellites jumped against their codes at once.
    Clock,
}

/// The thresholds of cycle slip detection.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SlipLimits {
    /// The longest gap in observations that an ambiguity survives, s.
    pub gap: f64,
    /// The minimum jump of L1 − L2 between epochs, m. Slips of 9 and 7 cycles jump by only 3 mm.
    pub geometry_free: f64,
    /// The minimum jump of the Melbourne–Wübbena combination from its running mean, cycles of the wide lane.
    pub melbourne_wuebbena: f64,
    /// The number of its own running standard deviations that either jump must exceed, too.
    pub deviations: f64,
    /// Whether the receiver's own loss-of-lock flag counts.
    pub loss_of_lock: bool,
}

impl Default for SlipLimits {
    fn default() -> Self {
        Self {
            gap: 300.0,
            geometry_free: 0.05,
            melbourne_wuebbena: 1.5,
            deviations: 5.0,
            loss_of_lock: true,
        }
    }
}

/// The state of slip detection in one satellite's arc (Blewitt 1990).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Arc {
    carriers: Carriers,
    last: GpsTime,
    geometry_free: f64,
    /// The variance of the geometry-free jumps, m².
    geometry_free_variance: f64,
    wide_lane: f64,
    /// The variance of the wide lane about its running mean, cycles².
    wide_lane_variance: f64,
    count: u16,
    /// The number of consecutive epochs, up to the last one, in which the wide lane was off.
    off: u16,
    /// The deviation of the wide lane from its mean in the last of these epochs, cycles.
    away: f64,
    /// Whether the deviation was the same in the epoch before.
    stays: bool,
}

/// The memory of the running mean, epochs: code multipath wanders.
const MEMORY: u16 = 100;
/// The initial standard deviation of one epoch's wide lane, cycles.
const WIDE_LANE_DEVIATION: f64 = 0.7;
/// The initial standard deviation of a jump of the geometry-free phase, m.
const GEOMETRY_FREE_DEVIATION: f64 = 0.01;
/// The number of epochs for which a jump of the wide lane is suspicious; afterwards its mean moves there.
const ACCUSTOMED: u16 = 10;

impl Arc {
    /// Begins an arc on two carriers: `phase` in cycles, `code` in m.
    pub fn begin(time: GpsTime, carriers: Carriers, phase: [f64; 2], code: [f64; 2]) -> Self {
        Self {
            carriers,
            last: time,
            geometry_free: carriers.geometry_free(phase),
            geometry_free_variance: GEOMETRY_FREE_DEVIATION * GEOMETRY_FREE_DEVIATION,
            wide_lane: carriers.melbourne_wuebbena(phase, code),
            wide_lane_variance: WIDE_LANE_DEVIATION * WIDE_LANE_DEVIATION,
            count: 1,
            off: 0,
            away: 0.0,
            stays: false,
        }
    }

    /// Continues with the next epoch; a slip begins a new arc.
    ///
    /// A jump of the wide lane alone is no slip yet, as a code outlier looks the same: see [`Self::is_suspicious`].
    pub fn observe(
        &mut self,
        time: GpsTime,
        phase: [f64; 2],
        code: [f64; 2],
        lock_lost: bool,
        limits: &SlipLimits,
    ) -> Option<Slip> {
        let jump = self.carriers.geometry_free(phase) - self.geometry_free;
        let spread = limits.deviations * libm::sqrt(self.geometry_free_variance);
        let away = time.since(self.last).abs();
        let slip = if away > limits.gap || away.is_nan() {
            Some(Slip::Gap)
        } else if lock_lost && limits.loss_of_lock {
            Some(Slip::LossOfLock)
        } else if jump.abs() > spread.max(limits.geometry_free) || jump.is_nan() {
            Some(Slip::GeometryFree)
        } else {
            None
        };
        if slip.is_some() {
            self.restart(time, phase, code);
            return slip;
        }
        self.last = time;
        self.geometry_free += jump;
        self.count = (self.count + 1).min(MEMORY);
        let share = 1.0 / f64::from(self.count);
        self.geometry_free_variance += share * (jump * jump - self.geometry_free_variance);
        let wide_lane = self.carriers.melbourne_wuebbena(phase, code);
        self.widen(wide_lane - self.wide_lane, share, limits);
        None
    }

    /// Begins a new arc of the same satellite, which keeps what is known of its ionosphere.
    pub fn restart(&mut self, time: GpsTime, phase: [f64; 2], code: [f64; 2]) {
        let variance = self.geometry_free_variance;
        *self = Self::begin(time, self.carriers, phase, code);
        self.geometry_free_variance = variance;
    }

    /// Processes a wide lane that is `jump` from its mean.
    fn widen(&mut self, jump: f64, share: f64, limits: &SlipLimits) {
        let spread = limits.deviations * libm::sqrt(self.wide_lane_variance);
        if jump.is_nan() {
            return;
        }
        let spread = spread.max(limits.melbourne_wuebbena);
        self.stays = self.off > 0 && (jump - self.away).abs() <= spread;
        self.away = jump;
        if jump.abs() <= spread {
            (self.off, self.stays) = (0, false);
            self.wide_lane += share * jump;
            self.wide_lane_variance += share * (jump * jump - self.wide_lane_variance);
        } else if self.off < ACCUSTOMED {
            self.off += 1;
        } else {
            (self.off, self.wide_lane) = (0, self.wide_lane + jump);
        }
    }

    /// Whether the wide lane has moved, after a slip or because of a code outlier. A second sign, such as a phase that
    /// does not fit, confirms the slip.
    pub const fn is_suspicious(&self) -> bool {
        self.off > 0
    }

    /// Whether the wide lane has moved and stays there: seen in two successive epochs, it is a slip. (A code outlier is
    /// elsewhere in the next epoch; a code bias is taken for a slip, too.)
    pub const fn stays_away(&self) -> bool {
        self.stays
    }

    /// The jump of the phases against the codes, m: the deviation of an epoch's Melbourne–Wübbena combination from the
    /// mean of the arc.
    ///
    /// If it is the same for all satellites, it is due to the receiver's clock.
    ///
    /// `phase` in cycles, `code` in m.
    pub const fn jump(&self, phase: [f64; 2], code: [f64; 2]) -> f64 {
        self.carriers.wide_lane() * (self.carriers.melbourne_wuebbena(phase, code) - self.wide_lane)
    }

    /// The carriers on which the satellite is observed: on others an arc of its own begins.
    pub const fn carriers(&self) -> Carriers {
        self.carriers
    }

    /// The time of the last observation of the satellite.
    pub const fn last(&self) -> GpsTime {
        self.last
    }
}
