//! From bytes to the estimator and the state.

use std::sync::{Arc, Mutex, PoisonError};

use kestirim_telemetry::{Order, Receiver};

use super::feed::Feed;
use super::order::Sorter;
use super::state::State;
use crate::Error;
use crate::system::{Answer, Plan};

/// Makes messages of bytes, and tells how many.
#[derive(Debug)]
pub(super) struct Decoder {
    receiver: Receiver,
    sorter: Sorter,
    feed: Feed,
    state: Arc<Mutex<State>>,
    most: u32,
}

impl Decoder {
    /// With a fresh estimator. After the `most` frames no more is wanted.
    pub(super) fn new(
        plan: Option<Arc<dyn Plan>>,
        state: Arc<Mutex<State>>,
        most: Option<u32>,
    ) -> Result<Self, Error> {
        Ok(Self {
            receiver: Receiver::new(),
            sorter: Sorter::default(),
            feed: Feed::new(plan)?,
            state,
            most: most.unwrap_or(u32::MAX),
        })
    }

    /// What there is to see.
    pub(super) fn answer(&self) -> Answer {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).answer()
    }

    /// Takes in what was read; whether more is wanted.
    pub(super) fn take(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        let more = self.decode(bytes)?;
        // Nobody who looks on waits for what takes long.
        self.feed.settle();
        self.show(bytes.len());
        Ok(more)
    }

    /// Nothing more will come.
    pub(super) fn finish(&mut self) -> Result<(), Error> {
        // A frame that only lacks its end is whole; any other piece of one is torn.
        self.decode(&[0])?;
        {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            self.sorter.finish(|message| self.feed.take(message, &mut state))?;
        }
        let finished = self.feed.finish();
        self.show(0);
        finished
    }

    /// Nothing comes for now.
    pub(super) fn pause(&mut self) -> Result<(), Error> {
        {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            self.sorter.release_all(|message| self.feed.take(message, &mut state))?;
        }
        self.feed.settle();
        self.show(0);
        Ok(())
    }

    fn decode(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        // Those beyond are not even asked for.
        let wanted = self.most.saturating_sub(self.receiver.counts().received);
        for frame in self.receiver.frames(bytes).take(wanted as usize) {
            let order = frame.order.unwrap_or(Order::Newest { missing: 0 });
            self.sorter.take(frame, order, |message| self.feed.take(message, &mut state))?;
        }
        Ok(self.receiver.counts().received < self.most)
    }

    fn show(&mut self, bytes: usize) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.count(bytes, self.receiver.counts(), self.sorter.left_out());
        self.feed.show(&mut state);
    }
}
