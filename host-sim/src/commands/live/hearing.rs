//! What makes something of bytes that come: telemetry, or a stream that an estimator reads itself.

use std::fmt::Debug;
use std::sync::{Arc, Mutex, PoisonError};

use kestirim_telemetry::Counts;

use super::state::State;
use crate::Error;
use crate::system::Online;

/// Makes something of bytes that come, and shows it.
pub(super) trait Hearing: Debug {
    /// Takes in what was read; whether more is wanted.
    ///
    /// # Errors
    /// What an estimator cannot go on with.
    fn take(&mut self, bytes: &[u8]) -> Result<bool, Error>;

    /// Nothing comes for now.
    ///
    /// # Errors
    /// As [`Self::take`].
    fn pause(&mut self) -> Result<(), Error>;

    /// Nothing more will come.
    ///
    /// # Errors
    /// As [`Self::take`].
    fn finish(&mut self) -> Result<(), Error>;
}

/// A stream that is no telemetry: an estimator reads the bytes themselves.
#[derive(Debug)]
pub(super) struct Stream {
    estimator: Box<dyn Online>,
    state: Arc<Mutex<State>>,
    /// After so many epochs no more is wanted.
    most: u32,
}

impl Stream {
    pub(super) fn new(estimator: Box<dyn Online>, state: Arc<Mutex<State>>, most: u32) -> Self {
        Self { estimator, state, most }
    }

    /// Shows what so many bytes came to; whether more is wanted.
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
