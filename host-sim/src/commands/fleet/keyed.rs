//! The state of each device as bytes, from which one estimator is restored and to which it is saved.
//!
//! An estimator with room for any number of anchors takes ten times the bytes of its snapshot. And the stored states
//! are exactly what a restart begins with: there is no other state.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use kestirim_telemetry::{CAPACITY, Frame, Origin, Position, Receiver, encode_from};
use serde::{Deserialize, Serialize};

use super::counts::Counts;
use super::transport::{Delivery, Estimate};
use crate::Error;
use crate::numbers::{Numbers, Place};
use crate::system::{Online, Outcome, Plan};

/// The maximum number of devices, as a sender may invent device numbers.
const MOST: usize = 1_000_000;

/// The state of a device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Device {
    numbers: Numbers,
    pub(super) counts: Counts,
    /// The estimator's snapshot; empty before it has started.
    state: Vec<u8>,
}

/// All devices, and the position up to which the log was read for them.
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Keyed {
    /// The position of the last message that was processed.
    pub(super) position: u64,
    pub(super) devices: BTreeMap<u32, Device>,
    /// The number of messages without a frame of a device, with torn frames, or of devices beyond the maximum.
    pub(super) unreadable: u64,
}

/// Processes all devices with a single estimator, which takes the state of one after the other.
#[derive(Debug)]
pub(super) struct Fleet {
    pub(super) keyed: Keyed,
    /// The name of the system, as estimates of two systems may go to one stream.
    name: String,
    online: Box<dyn Online>,
    /// The snapshot of an estimator that has not started.
    pub(super) fresh: Vec<u8>,
}

impl Fleet {
    /// A fleet without devices.
    ///
    /// # Errors
    /// Errors in settings and files; [`Error::Usage`] if the estimator cannot be stored.
    pub(super) fn new(name: &str, plan: &Arc<dyn Plan>) -> Result<Self, Error> {
        let mut online = plan.build()?;
        let refused = |why| Error::Usage(format!("fleet {name}: {why}"));
        let fresh = online.snapshot().map_err(refused)?;
        let asleep = || refused("its estimator does not wake from its own snapshot".to_owned());
        online.restore(&fresh).ok_or_else(asleep)?;
        Ok(Self { keyed: Keyed::default(), name: name.to_owned(), online, fresh })
    }

    /// Processes the deliveries and returns the estimates that follow from them, in order for each device.
    ///
    /// # Errors
    /// If a device's snapshot is invalid, which cannot happen.
    pub(super) fn take(&mut self, deliveries: &[Delivery]) -> Result<Vec<Estimate>, Error> {
        // The estimator is restored once for all frames of a device.
        let mut heard = BTreeMap::<u32, Vec<Heard>>::new();
        for delivery in deliveries {
            self.keyed.position = delivery.position;
            self.hear(&delivery.bytes, &mut heard);
        }
        let mut estimates = Vec::new();
        for (number, frames) in heard {
            self.follow(number, &frames, &mut estimates)?;
        }
        Ok(estimates)
    }

    fn hear(&mut self, bytes: &[u8], heard: &mut BTreeMap<u32, Vec<Heard>>) {
        let mut receiver = Receiver::new();
        let mut frames: Vec<_> = receiver.frames(bytes).collect();
        // A frame that only lacks its end is complete; any other fragment is torn.
        frames.extend(receiver.push(0));
        let kestirim_telemetry::Counts { torn, corrupt, unknown, .. } = receiver.counts();
        let is_readable = torn + corrupt + unknown == 0
            && !frames.is_empty()
            && frames.iter().all(|frame| frame.origin.is_some());
        self.keyed.unreadable += u64::from(!is_readable);
        // Backwards: the first frame met of a device is its last one in this message.
        let mut ended = BTreeSet::new();
        let mut of_message = Vec::with_capacity(frames.len());
        for frame in frames.into_iter().rev() {
            let Some(origin) = frame.origin else { continue };
            let is_last = ended.insert(origin.device);
            of_message.push(Heard { origin, frame, is_last });
        }
        for one in of_message.into_iter().rev() {
            heard.entry(one.origin.device).or_default().push(one);
        }
    }

    fn follow(
        &mut self,
        number: u32,
        frames: &[Heard],
        estimates: &mut Vec<Estimate>,
    ) -> Result<(), Error> {
        let mut is_new = false;
        let begun = if self.keyed.devices.contains_key(&number) { 0 } else { self.begun(frames)? };
        let frames = frames.get(begun..).unwrap_or_default();
        let Some(first) = frames.first() else { return Ok(()) };
        let device = self.keyed.devices.entry(number).or_insert_with(|| {
            is_new = true;
            let numbers = Numbers::from(first.origin, &first.frame);
            Device { numbers, counts: Counts::default(), state: Vec::new() }
        });
        let state = if device.state.is_empty() { &self.fresh } else { &device.state };
        wake(self.online.as_mut(), state)?;
        let mut last = None;
        for (place, Heard { origin, frame, is_last }) in frames.iter().enumerate() {
            let is_first = is_new && place == 0;
            let place = if is_first {
                Place::Newest { missing: 0 }
            } else {
                device.numbers.take(*origin, frame)
            };
            if place.is_followed(&mut device.counts) {
                if matches!(place, Place::Restarted { .. }) {
                    wake(self.online.as_mut(), &self.fresh)?;
                }
                let outcome = self.online.take(&frame.message);
                device.counts.taken += u64::from(outcome == Outcome::Taken);
                device.counts.refused += u64::from(outcome == Outcome::Refused);
                if outcome == Outcome::Taken {
                    last = Some((*origin, frame));
                }
            }
            if let Some((origin, frame)) = last.filter(|_| *is_last) {
                let estimate = estimate(&self.name, self.online.as_ref(), origin, frame);
                device.counts.estimates += u64::from(estimate.is_some());
                estimates.extend(estimate);
                last = None;
            }
        }
        device.state = self.online.snapshot().map_err(Error::Usage)?;
        device.state.shrink_to_fit();
        Ok(())
    }

    /// The index of the first frame of a new device that the estimator uses, or the number of frames if there is none:
    /// other frames do not register a device.
    fn begun(&mut self, frames: &[Heard]) -> Result<usize, Error> {
        if self.keyed.devices.len() >= MOST {
            self.keyed.unreadable += 1;
            return Ok(frames.len());
        }
        for (place, Heard { frame, .. }) in frames.iter().enumerate() {
            // The estimator is fresh for each frame, as if it came alone: a refused frame leaves no trace.
            wake(self.online.as_mut(), &self.fresh)?;
            if self.online.take(&frame.message) == Outcome::Taken {
                return Ok(place);
            }
        }
        Ok(frames.len())
    }

    /// The sum of all devices' counters.
    pub(super) fn counts(&self) -> Counts {
        let mut all = Counts::default();
        self.keyed.devices.values().for_each(|device| all.add(&device.counts));
        all
    }

    /// The memory of all devices' states in bytes.
    pub(super) fn bytes(&self) -> usize {
        let of = |device: &Device| device.state.capacity() + size_of::<(u32, Device)>();
        self.keyed.devices.values().map(of).sum()
    }
}

/// A frame received in a message.
#[derive(Debug)]
struct Heard {
    origin: Origin,
    frame: Frame,
    /// Whether it is the message's last frame of this device, after which an estimate is produced.
    is_last: bool,
}

impl Place {
    /// Whether a frame is processed, which it is if it is newer than all before. The counters are updated.
    fn is_followed(self, counts: &mut Counts) -> bool {
        match self {
            Self::Newest { missing } => counts.lost += u64::from(missing),
            Self::Restarted { missing } => {
                counts.lost += u64::from(missing);
                counts.restarts += 1;
            }
            // The log is ordered: an older frame was read before, or was put into the log late.
            Self::Late { .. } | Self::Twice => {
                counts.dropped += 1;
                return false;
            }
            Self::Another => {
                counts.another += 1;
                return false;
            }
        }
        counts.frames += 1;
        true
    }
}

fn wake(online: &mut dyn Online, state: &[u8]) -> Result<(), Error> {
    let refused = || Error::Usage("a stored state is none of this estimator".to_owned());
    online.restore(state).ok_or_else(refused)
}

/// The estimate after a frame, as a frame; `None` if the estimator does not know the position yet.
fn estimate(name: &str, online: &dyn Online, origin: Origin, frame: &Frame) -> Option<Estimate> {
    let time_us = frame.message.measured_us()?;
    let position = online.position()?.map(|metres| metres as f32);
    let sigma = online.sigma_m().map(|metres| metres as f32);
    let message = Position { time_us, position, sigma }.into();
    let mut buffer = [0; CAPACITY];
    let bytes = encode_from(origin, &message, frame.sequence, &mut buffer).ok()?.to_vec();
    let Origin { device, boot } = origin;
    let id = format!("{name}-{device}-{boot}-{}", frame.sequence);
    Some(Estimate { device, id, frame: bytes })
}
