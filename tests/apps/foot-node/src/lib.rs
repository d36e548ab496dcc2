//! A foot's tracker at the end of a serial line, as an example application: samples of an IMU arrive as telemetry
//! frames; footprints and positions are sent back.
//!
//! [`Node::take`] is the body of the loop and is independent of interrupts and executors, which the calling program
//! handles. The programs are `foot-embassy` (an async task that awaits bytes) and `foot-rtic` (a task woken by an
//! interrupt).
#![no_std]
#![expect(missing_debug_implementations, reason = "a receiver of telemetry has none")]

use kestirim_pedestrian::{
    Config, EkfTracker, Health as Doubts, ImuSample, PathUncertainty, SensorClass,
};
use kestirim_scalar::Components;
use kestirim_telemetry::{
    CAPACITY, EstimateHealth, Footprint, Health, Imu, Message, Position, Receiver, encode,
};
use nalgebra::SVector;

/// The number of samples per transmitted position.
const SAMPLES_A_POSITION: u32 = 10;

/// The length of the longest frame, bytes.
pub const FRAME: usize = CAPACITY;

/// A frame to be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer<'a> {
    /// The frame, delimiters included.
    pub frame: &'a [u8],
    /// Whether this answers the farewell of the other side.
    pub is_last: bool,
}

/// The tracker, between the received samples and the frames to be sent.
pub struct Node {
    receiver: Receiver,
    tracker: EkfTracker<f32>,
    uncertainty: PathUncertainty<f32>,
    /// The health that was last sent.
    told: Option<Doubts>,
    sent: u16,
    time_us: u64,
    accepted: u32,
    rejected: u32,
}

impl Node {
    /// A node for this class of sensor.
    pub fn new(sensor: SensorClass) -> Self {
        Self {
            receiver: Receiver::new(),
            tracker: EkfTracker::new(Config { sensor, ..Config::default() }),
            uncertainty: PathUncertainty::new(sensor),
            told: None,
            sent: 0,
            time_us: 0,
            accepted: 0,
            rejected: 0,
        }
    }

    /// Takes a received byte. Returns the frame to be sent if the byte completed a sample that ended a stride, for
    /// which a position is due, or before which the path's health changed; or the other side's `Health`, its farewell.
    /// The frame is written into `buffer`.
    pub fn take<'a>(&mut self, byte: u8, buffer: &'a mut [u8; FRAME]) -> Option<Answer<'a>> {
        let answer = match self.receiver.push(byte)?.message {
            Message::Imu(sample) => self.track(&sample)?,
            Message::Health(_) => self.health().into(),
            _ => return None,
        };
        let is_last = matches!(answer, Message::Health(_));
        let sequence = self.sent;
        self.sent = sequence.wrapping_add(1);
        // A buffer of this capacity holds any frame.
        let frame = encode(&answer, sequence, buffer).ok()?;
        Some(Answer { frame, is_last })
    }

    fn track(&mut self, sample: &Imu) -> Option<Message> {
        let sample = ImuSample {
            time_us: sample.time_us,
            specific_force: SVector::from(sample.specific_force),
            angular_rate: SVector::from(sample.angular_rate),
        };
        let Ok(estimate) = self.tracker.update(&sample) else {
            self.rejected = self.rejected.saturating_add(1);
            return None;
        };
        self.accepted = self.accepted.saturating_add(1);
        let time_us = sample.time_us;
        self.time_us = time_us;
        if let Some(stride) = estimate.stride {
            self.uncertainty.add(&stride);
            let (position, length) = (*stride.position.as_array(), stride.length);
            return Some(Footprint { time_us: stride.time_us, position, length }.into());
        }
        if self.accepted.is_multiple_of(SAMPLES_A_POSITION) {
            let [x, y, _] = *self.uncertainty.standard_deviation().as_array();
            let position = *estimate.position.as_array();
            return Some(Position { time_us, position, sigma: Some(x.max(y)) }.into());
        }
        let health = self.tracker.warnings().health();
        let is_news = self.told.replace(health) != Some(health);
        is_news.then(|| EstimateHealth { time_us, reasons: health.bits() }.into())
    }

    fn health(&self) -> Health {
        let Self { time_us, accepted, rejected, .. } = *self;
        let counts = self.receiver.counts();
        let failed = counts.torn.saturating_add(counts.corrupt).saturating_add(counts.lost);
        Health { time_us, accepted, rejected, failed }
    }
}
