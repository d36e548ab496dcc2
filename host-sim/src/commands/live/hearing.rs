//! Consumers of received bytes: telemetry, or a stream that an estimator decodes itself.

use std::fmt::Debug;
use std::sync::{Arc, Mutex, PoisonError};

use kestirim_telemetry::Counts;

use super::state::State;
use crate::Error;
use crate::system::Online;

/// A consumer of received bytes that updates the shown state.
pub(super) trait Hearing: Debug {
    /// Processes received bytes; returns whether more are wanted.
    ///
    /// # Errors
    /// An error after which the estimator cannot continue.
    fn take(&mut self, bytes: &[u8]) -> Result<bool, Error>;

    /// Notes that nothing arrives at the moment.
    ///
    /// # Errors
    /// Those of [`Self::take`].
    fn pause(&mut self) -> Result<(), Error>;

    /// Ends the stream.
    ///
    /// # Errors
    /// Those of [`Self::take`].
    fn finish(&mut self) -> Result<(), Error>;
}

/// A stream other than telemetry, whose bytes the estimator decodes itself.
#[derive(Debug)]
pub(super) struct Stream {
    estimator: Box<dyn Online>,
    state: Arc<Mutex<State>>,
    /// The number of epochs after which no more bytes are wanted.
    most: u32,
}

impl Stream {
    pub(super) fn new(estimator: Box<dyn Online>, state: Arc<Mutex<State>>, most: u32) -> Self {
        Self { estimator, state, most }
    }

    /// Updates the shown state after a number of bytes; returns whether more are wanted.
    fn show(&self, bytes: usize) -> bool {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let [received, taken] = self.estimator.heard();
        state.count(bytes, Counts { received, ..Counts::default() }, 0);
        state.counts.taken = taken.into();
        state.show(self.estimator.as_ref());
        received < self.most
    }
}

impl Hearing for Stream {
    fn take(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        self.estimator.hear(bytes);
        Ok(self.show(bytes.len()))
    }

    fn pause(&mut self) -> Result<(), Error> {
        self.estimator.settle();
        self.show(0);
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        let finished = self.estimator.finish();
        self.show(0);
        finished
    }
}
