//! Decodes bytes of telemetry and passes the messages to the estimators and the state.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use kestirim_telemetry::{Frame, Origin, Receiver};

use super::device::Device;
use super::hearing::{Hearing, Stream};
use super::options::Following;
use super::state::State;
use crate::Error;
use crate::system::{Answer, Plan};

/// The maximum number of devices followed, as a sender may invent device numbers.
const MOST: usize = 4096;

/// Turns received bytes into the state that is shown.
#[derive(Debug)]
pub(super) struct Decoder {
    hearing: Box<dyn Hearing>,
    state: Arc<Mutex<State>>,
}

impl Decoder {
    /// A decoder with fresh estimators, which stops after `most` frames or epochs.
    pub(super) fn new(
        following: &Following,
        state: Arc<Mutex<State>>,
        most: Option<u32>,
    ) -> Result<Self, Error> {
        // Building an estimator now reports unsuitable settings before anything arrives, and shows the instructions for
        // the sender.
        let estimator = following.plan.as_deref().map(Plan::build).transpose()?;
        if let Some(estimator) = &estimator {
            let mut state = state.lock().unwrap_or_else(PoisonError::into_inner);
            state.show(estimator.as_ref());
        }
        let most = most.unwrap_or(u32::MAX);
        let hearing: Box<dyn Hearing> = match estimator.filter(|_| following.hears_bytes()) {
            Some(estimator) => Box::new(Stream::new(estimator, Arc::clone(&state), most)),
            None => Box::new(Telemetry::new(following, Arc::clone(&state), most)),
        };
        Ok(Self { hearing, state })
    }

    /// The answer that the page shows.
    pub(super) fn answer(&self) -> Answer {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).answer()
    }

    /// Processes received bytes; returns whether more are wanted.
    pub(super) fn take(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        self.hearing.take(bytes)
    }

    /// Ends the stream.
    pub(super) fn finish(&mut self) -> Result<(), Error> {
        self.hearing.finish()
    }

    /// Notes that nothing arrives at the moment.
    pub(super) fn pause(&mut self) -> Result<(), Error> {
        self.hearing.pause()
    }
}

/// Decodes messages and counts them. Each device that identifies itself has its own estimator; all anonymous senders
/// share one.
#[derive(Debug)]
struct Telemetry {
    receiver: Receiver,
    devices: BTreeMap<Sender, Device>,
    plans: Plans,
    /// The sender that is shown in detail; unless specified, the first that is heard.
    shown: Option<Sender>,
    state: Arc<Mutex<State>>,
    most: u32,
}

impl Hearing for Telemetry {
    fn take(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        let more = self.decode(bytes)?;
        self.settle();
        self.show(bytes.len());
        Ok(more)
    }

    fn finish(&mut self) -> Result<(), Error> {
        // A frame that only lacks its end is complete; any other fragment is torn.
        self.decode(&[0])?;
        self.each(Device::finish)?;
        let mut finished = Ok(());
        // All devices are ended, even if one fails.
        for device in self.devices.values_mut() {
            finished = finished.and(device.end());
        }
        self.show(0);
        finished
    }

    fn pause(&mut self) -> Result<(), Error> {
        self.each(Device::pause)?;
        self.settle();
        self.show(0);
        Ok(())
    }
}

impl Telemetry {
    fn new(following: &Following, state: Arc<Mutex<State>>, most: u32) -> Self {
        let (shown, others) = (following.plan.clone(), following.plan_of_others().cloned());
        Self {
            receiver: Receiver::new(),
            devices: BTreeMap::new(),
            plans: Plans { shown, others },
            shown: following.device.map(Sender::Device),
            state,
            most,
        }
    }

    fn each(
        &mut self,
        mut act: impl FnMut(&mut Device, &mut State) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        self.devices.values_mut().try_for_each(|device| act(device, &mut state))
    }

    /// Performs the lengthy work while no viewer has to wait for it.
    fn settle(&mut self) {
        self.devices.values_mut().filter(|device| device.is_news).for_each(Device::settle);
    }

    fn decode(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        let shared = Arc::clone(&self.state);
        let mut state = shared.lock().unwrap_or_else(PoisonError::into_inner);
        // Frames beyond the maximum are not even decoded.
        let wanted = self.most.saturating_sub(self.receiver.counts().received) as usize;
        for frame in self.receiver.frames(bytes).take(wanted) {
            let known = (&mut self.devices, &mut self.shown, &self.plans);
            hear(known, frame, &mut state)?;
        }
        Ok(self.receiver.counts().received < self.most)
    }

    fn show(&mut self, bytes: usize) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let mut counts = self.receiver.counts();
        let lost = self.devices.values().map(Device::lost);
        counts.lost = lost.fold(counts.lost, u32::saturating_add);
        let left_out = self.devices.values().map(Device::left_out).sum();
        state.count(bytes, counts, left_out);
        state.shown = self.shown.and_then(Sender::number);
        for (sender, device) in self.devices.iter_mut().filter(|(_, device)| device.is_news) {
            let row = device.show(&mut state);
            match sender {
                Sender::Device(number) => drop(state.devices.insert(*number, row)),
                Sender::Unnamed => state.unnamed = (self.shown != Some(*sender)).then_some(row),
            }
        }
    }
}

/// The sender of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Sender {
    /// A sender that does not identify itself.
    Unnamed,
    /// The device with this number.
    Device(u32),
}

impl Sender {
    fn of(frame: &Frame) -> Self {
        frame.origin.map_or(Self::Unnamed, |Origin { device, .. }| Self::Device(device))
    }

    const fn number(self) -> Option<u32> {
        match self {
            Self::Unnamed => None,
            Self::Device(number) => Some(number),
        }
    }
}

/// The plans for the estimators of the device that is shown and of the others.
#[derive(Debug)]
struct Plans {
    shown: Option<Arc<dyn Plan>>,
    others: Option<Arc<dyn Plan>>,
}

/// The parts of a decoder that a frame changes.
type Known<'a> = (&'a mut BTreeMap<Sender, Device>, &'a mut Option<Sender>, &'a Plans);

/// Passes a frame to its device.
fn hear((devices, shown, plans): Known<'_>, frame: Frame, state: &mut State) -> Result<(), Error> {
    let sender = Sender::of(&frame);
    let is_shown = *shown.get_or_insert(sender) == sender;
    if !devices.contains_key(&sender) {
        if devices.len() >= MOST {
            state.beyond += 1;
            return Ok(());
        }
        let plan = if is_shown { &plans.shown } else { &plans.others };
        devices.insert(sender, Device::new(plan.clone(), is_shown)?);
    }
    devices.get_mut(&sender).map_or(Ok(()), |device| device.take(frame, state))
}
