//! The parts that both trackers of ultra-wideband ranges share.

use heapless::Vec;
use kestirim_scalar::Scalar;
use kestirim_uwb_tracker::{
    Anchor as Place, Config, Health, OdometrySample, Outcome, Report, Room, State as Stage,
};
use nalgebra::SVector;

use crate::Status;

#[cfg(not(feature = "fixed"))]
pub(crate) type Number = f32;
#[cfg(feature = "fixed")]
pub(crate) type Number = kestirim_scalar::Q12_20;

/// Calibration of the anchors' ranges.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Calibration {
    /// Uncalibrated anchors: ranges are too long by a decimetre or two.
    Uncalibrated = 0,
    /// Calibrated anchors: the bias of each is known to 5 cm.
    Calibrated = 1,
}

/// Settings of a tag tracker or wheel tracker.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TagConfig {
    /// Calibration of the anchors: a `kestirim_calibration`.
    pub calibration: u32,
    /// Height of the tag in the room frame, m.
    pub height: f32,
    /// Bounds of the tag's position in the room frame, m: x, y of two opposite corners; all zero if there are none. Between the two
    /// sides of a line of anchors they decide alone.
    pub room: [f32; 4],
}

impl TagConfig {
    pub(crate) fn to_config(self) -> Result<Config<Number>, Status> {
        let height = Number::from_f32(self.height);
        if !height.is_finite() {
            return Err(Status::NotFinite);
        }
        let config = match self.calibration {
            0 => Config::uncalibrated(height),
            1 => Config::calibrated(height),
            _ => return Err(Status::InvalidArgument),
        };
        Ok(Config { room: self.to_room()?, ..config })
    }

    fn to_room(self) -> Result<Option<Room<Number>>, Status> {
        let [x0, y0, x1, y1] = self.room;
        if self.room == [0.0; 4] {
            return Ok(None);
        }
        if !self.room.iter().all(|it| it.is_finite()) {
            return Err(Status::NotFinite);
        }
        if x0 == x1 || y0 == y1 {
            return Err(Status::InvalidArgument);
        }
        let [x0, y0, x1, y1] = self.room.map(Number::from_f32);
        Ok(Some(Room::plane(x0, y0, x1, y1)))
    }
}

/// An anchor, with its position and range bias.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Position of the anchor, m, room frame: x, y, z.
    pub position: [f32; 3],
    /// Bias of its ranges, m, positive if they are too long; 0 if unknown.
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

/// One range: the measured distance from the tag to an anchor.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeRecord {
    /// Time of the measurement, µs since any epoch.
    pub time_us: u64,
    /// Index of the anchor in the array with which the tracker was created.
    pub anchor: u32,
    /// The distance, m; small negative values are accepted.
    pub range: f32,
}

/// One sample of wheel odometry.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OdometryRecord {
    /// Time of the measurement, µs on the ranges' clock.
    pub time_us: u64,
    /// Mean speed of the wheels, m/s.
    pub speed: f32,
    /// Turn rate, rad/s: the difference of the wheels' speeds over the track, or the rate of a gyroscope.
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

/// What a tracker did with a range.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RangeOutcome {
    /// The range is stored for a first position, which needs more ranges or is still being searched for.
    Collected = 0,
    /// With this range a first position was found, or a new one after the tracker was lost.
    Started = 1,
    /// The range was used with its full weight.
    Taken = 2,
    /// The range was used with a reduced weight: it is longer or shorter than expected.
    Weakened = 3,
    /// The range was rejected.
    Rejected = 4,
    /// The range was used although it does not fit: too many had been rejected.
    Recovered = 5,
}

/// Outcome and innovation of a range.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeReport {
    /// What the tracker did with the range.
    pub outcome: RangeOutcome,
    /// Innovation of the range, measured minus expected, m; 0 without an estimate.
    pub innovation: f32,
    /// Variance of the innovation, m²; 0 without an estimate.
    pub variance: f32,
    /// Normalised innovation squared (NIS): the square of the innovation over its variance, 1 on average if the model
    /// is right; 0 without an estimate.
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
    /// Ranges arrive and are consistent.
    Tracking = 1,
    /// No range arrived for a second, or for two rounds of the anchors if those take longer: the position is that
    /// after the last sample, and its standard deviation grows with the time since.
    Coasting = 2,
    /// The position has become useless: the next ranges determine a new one.
    Lost = 3,
}

/// Health of a tag tracker or wheel tracker in numbers.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TagHealth {
    /// State of the position.
    pub state: TagState,
    /// Number of ranges used so far.
    pub taken: u32,
    /// Number of ranges rejected so far.
    pub rejected: u32,
    /// Number of positions begun after the first.
    pub restarts: u16,
    /// Number of anchors heard within the last second, or two rounds of the anchors if those take longer, except
    /// blocked ones, whose ranges have been too long for a while.
    pub heard: u8,
    /// 1 if the tag stands still according to the IMU or the wheels, else 0.
    pub still: u8,
    /// Mean normalised innovation squared of about the last twenty ranges that were used: 1 if the model is right.
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
