//! The path from messages to estimates: killing the program at any moment loses nothing and duplicates nothing.
//!
//! Estimates are stored by the broker first, then the states with the position in the log by this program, and only
//! then is the log acknowledged. After a kill, everything since the last stored states is computed again, bit for bit,
//! and the broker recognises the estimates by their ids.

use std::time::{Duration, Instant};

use super::keyed::Fleet;
use super::store::Store;
use super::transport::Transport;
use crate::Error;

/// The engine that follows a fleet.
#[derive(Debug)]
pub(super) struct Engine {
    pub(super) fleet: Fleet,
    pub(super) store: Store,
    pub(super) transport: Box<dyn Transport>,
    /// The interval between two writes of the states.
    every: Duration,
    written: Instant,
    /// The position up to which the log is acknowledged.
    pub(super) acknowledged: u64,
    /// The duration of the last write of the states, in seconds.
    pub(super) writing_s: f64,
}

impl Engine {
    /// Resumes where the stored states end.
    ///
    /// # Errors
    /// Those of [`Transport::resume`].
    pub(super) fn begin(
        fleet: Fleet,
        store: Store,
        mut transport: Box<dyn Transport>,
        every: Duration,
    ) -> Result<Self, Error> {
        let acknowledged = fleet.keyed.position;
        transport.resume(acknowledged)?;
        let written = Instant::now();
        Ok(Self { fleet, store, transport, every, written, acknowledged, writing_s: 0.0 })
    }

    /// Processes the messages that have arrived and returns their number.
    ///
    /// # Errors
    /// An error from which waiting does not recover.
    pub(super) fn step(&mut self) -> Result<usize, Error> {
        let deliveries = self.transport.receive()?;
        let estimates = self.fleet.take(&deliveries)?;
        self.transport.publish(&estimates)?;
        if self.written.elapsed() >= self.every {
            self.settle()?;
        }
        Ok(deliveries.len())
    }

    /// Writes the states and acknowledges the log.
    ///
    /// # Errors
    /// Those of [`Store::write`] and [`Transport::acknowledge`].
    pub(super) fn settle(&mut self) -> Result<(), Error> {
        self.written = Instant::now();
        let position = self.fleet.keyed.position;
        if position > self.acknowledged {
            self.store.write(&self.fleet.keyed)?;
            self.writing_s = self.written.elapsed().as_secs_f64();
            self.transport.acknowledge(position)?;
            self.acknowledged = position;
        }
        Ok(())
    }
}
