//! From messages to estimates, such that a kill at any moment loses nothing and makes nothing twice.
//!
//! Estimates are stored by the broker first, then the states with the position in the log by this program, and only then is
//! the log told. Whatever is killed, whatever was made since the last states is made again, to the bit, and the
//! broker knows it by its id.

use std::time::{Duration, Instant};

use super::keyed::Fleet;
use super::store::Store;
use super::transport::Transport;
use crate::Error;

/// Follows a fleet.
#[derive(Debug)]
pub(super) struct Engine {
    pub(super) fleet: Fleet,
    pub(super) store: Store,
    pub(super) transport: Box<dyn Transport>,
    /// Between two times that states are written.
    every: Duration,
    written: Instant,
    /// Up to where the log was told.
    pub(super) acknowledged: u64,
    /// How long it took to write the states the last time, s.
    pub(super) writing_s: f64,
}

impl Engine {
    /// Goes on where the states end.
    ///
    /// # Errors
    /// As [`Transport::resume`].
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

    /// Follows what came meanwhile; how many messages.
    ///
    /// # Errors
    /// What waiting does not mend.
    pub(super) fn step(&mut self) -> Result<usize, Error> {
        let deliveries = self.transport.receive()?;
        let estimates = self.fleet.take(&deliveries)?;
        self.transport.publish(&estimates)?;
        if self.written.elapsed() >= self.every {
            self.settle()?;
        }
        Ok(deliveries.len())
    }

    /// Writes the states, and tells the log.
    ///
    /// # Errors
    /// As [`Store::write`] and [`Transport::acknowledge`].
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
