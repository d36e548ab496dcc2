//! The parts that both trackers of ultra-wideband ranges share.

use heapless::Vec;
use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{
    Anchor as Place, Config, Health, OdometrySample, Outcome, Report, State as Stage,
};
use nalgebra::SVector;

use crate::Status;

#[cfg(not(feature = "fixed"))]
pub(crate) type Number = f32;
#[cfg(feature = "fixed")]
pub(crate) type Number = kestirim_scalar::Q12_20;

/// How well the anchors are known.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// As they come: ranges are too long by a decimetre or two.
    Uncalibrated = 0,
    /// Each anchor's bias is known, to 5 cm.
    Calibrated = 1,
}

/// Settings of a tag's tracker.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TagConfig {
    /// How well the anchors are known: a `kestirim_calibration`.
    pub calibration: u32,
    /// Height of the tag in the room, m.
    pub height: f32,
}

impl TagConfig {
    pub(crate) fn to_config(self) -> Result<Config<Number>, Status> {
        let height = Number::from_f32(self.height);
        if !height.is_finite() {
            return Err(Status::NotFinite);
        }
        match self.calibration {
            0 => Ok(Config::uncalibrated(height)),
            1 => Ok(Config::calibrated(height)),
            _ => Err(Status::InvalidArgument),
        }
    }
}

/// An anchor: where it is, and by how much it measures too long.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Position, m, room: x, y, z.
    pub position: [f32; 3],
    /// What its ranges are too long by, m; 0 if that is not known.
    pub bias: f32,
}

impl Anchor {
    /// Converts anchors to the trackers' form.
    pub(crate) fn all<const A: usize>(anchors: &[Self]) -> Result<Vec<Place<Number>, A>, Status> {
        let mut all = Vec::new();
        for anchor in anchors {
            let position = SVector::from(anchor.position.map(Number::from_f32));
            let place = Place { position, bias: Number::from_f32(anchor.bias) };
            all.push(place).map_err(|_| Status::TooMany)?;
        }
        Ok(all)
    }
}

/// One measured distance.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeRecord {
    /// Time of the measurement, µs since any moment.
    pub time_us: u64,
    /// The anchor's place in the array that the tracker was made with.
    pub anchor: u32,
    /// The distance, m; small negative ones are accepted.
    pub range: f32,
}

/// What the wheels do.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryRecord {
    /// Time of the measurement, µs, the ranges' clock.
    pub time_us: u64,
    /// Mean speed of the wheels, m/s.
    pub speed: f32,
    /// Difference of their speeds by the track, or the rate of a gyroscope beside them, rad/s.
    pub turn_rate: f32,
}

impl From<OdometryRecord> for OdometrySample<Number> {
    fn from(sample: OdometryRecord) -> Self {
        Self {
            time_us: sample.time_us,
            speed: Number::from_f32(sample.speed),
            turn_rate: Number::from_f32(sample.turn_rate),
        }
    }
}

/// Outcome of a range.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeOutcome {
    /// Kept for a first position, for which more are needed.
    Collected = 0,
    /// It made a first position possible, or a new one after the tracker was lost.
    Started = 1,
    /// Taken in with its full weight.
    Taken = 2,
    /// Taken in with less weight: it is longer or shorter than expected.
    Weakened = 3,
    /// Left out.
    Rejected = 4,
    /// Taken in although it does not fit: too many had been left out.
    Recovered = 5,
}

/// What became of a range.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeReport {
    /// Its outcome.
    pub outcome: RangeOutcome,
    /// Measured minus expected, m; 0 without an estimate.
    pub innovation: f32,
    /// Its variance, m²; 0 without an estimate.
    pub variance: f32,
    /// Its square by its variance: 1 on average when the model is right.
    pub nis: f32,
}

impl RangeReport {
    pub(crate) fn of(report: &Report<Number>) -> Self {
        let of = |number: Option<Number>| number.map_or(0.0, Scalar::to_f32);
        let seen = report.innovation;
        Self {
            outcome: match report.outcome {
                Outcome::Collected => RangeOutcome::Collected,
                Outcome::Started => RangeOutcome::Started,
                Outcome::Taken => RangeOutcome::Taken,
                Outcome::Weakened => RangeOutcome::Weakened,
                Outcome::Rejected => RangeOutcome::Rejected,
                Outcome::Recovered => RangeOutcome::Recovered,
            },
            innovation: of(seen.map(|seen| seen.innovation)),
            variance: of(seen.map(|seen| seen.variance)),
            nis: of(seen.map(|seen| seen.nis)),
        }
    }
}

/// State of a tag's position.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TagState {
    /// No position has been found yet.
    Initialising = 0,
    /// Ranges come in and fit.
    Tracking = 1,
    /// No range came for a second or two rounds of the anchors: the position is extrapolated.
    Coasting = 2,
    /// The position has become worthless: the next ranges make a new one.
    Lost = 3,
}

/// Health of a tag's tracker in numbers.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TagHealth {
    /// State of the position.
    pub state: TagState,
    /// Ranges taken in so far.
    pub taken: u32,
    /// Ranges left out so far.
    pub rejected: u32,
    /// Positions begun anew after the first.
    pub restarts: u16,
    /// Anchors heard lately of which nothing is in the way.
    pub heard: u8,
    /// 1 if the tag stands still, as far as IMU or wheels tell, else 0.
    pub still: u8,
    /// Mean NIS of the last twenty ranges or so: 1 when the model is right.
    pub nis: f32,
    /// Dilution of precision of the anchors heard; 0 if they do not determine a position.
    pub dilution: f32,
}

impl TagHealth {
    pub(crate) fn of(health: &Health<Number>) -> Self {
        Self {
            state: match health.state {
                Stage::Initialising => TagState::Initialising,
                Stage::Tracking => TagState::Tracking,
                Stage::Coasting => TagState::Coasting,
                Stage::Lost => TagState::Lost,
            },
            taken: health.taken,
            rejected: health.rejected,
            restarts: health.restarts,
            heard: health.heard,
            still: u8::from(health.still),
            nis: health.nis.to_f32(),
            dilution: health.dilution.map_or(0.0, Scalar::to_f32),
        }
    }
}
