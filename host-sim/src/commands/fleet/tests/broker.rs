//! A broker in memory, and connections to it that break.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use crate::Error;
use crate::commands::fleet::transport::{Delivery, Estimate, Log, Transport};

/// A broker in memory, which outlives the killed programs.
#[derive(Debug, Default)]
pub(super) struct Broker {
    pub(super) log: Vec<Vec<u8>>,
    pub(super) acknowledged: u64,
    /// The stored estimates by device, in the order of arrival.
    pub(super) stored: BTreeMap<u32, Vec<Estimate>>,
    /// The number of estimates that were offered again.
    pub(super) again: usize,
}

/// A connection that breaks after a given number of calls, halfway through the last.
#[derive(Debug)]
pub(super) struct Memory {
    pub(super) broker: Arc<Mutex<Broker>>,
    pub(super) next: usize,
    pub(super) batch: usize,
    pub(super) calls_left: usize,
}

impl Memory {
    /// Whether this call is the one at which the connection breaks.
    fn is_killed(&mut self) -> bool {
        self.calls_left = self.calls_left.saturating_sub(1);
        self.calls_left == 0
    }
}

fn killed<T>() -> Result<T, Error> {
    Err(Error::Usage("killed".to_owned()))
}

impl Transport for Memory {
    fn log(&self) -> Log {
        Log { name: "memory".to_owned(), created: None }
    }

    fn resume(&mut self, position: u64) -> Result<(), Error> {
        assert!(
            position >= self.broker.lock().unwrap().acknowledged,
            "what was acknowledged is known"
        );
        self.broker.lock().unwrap().acknowledged = position;
        self.next = position as usize;
        Ok(())
    }

    fn receive(&mut self) -> Result<Vec<Delivery>, Error> {
        if self.is_killed() {
            return killed();
        }
        let from = self.next;
        let broker = self.broker.lock().unwrap();
        let messages = broker.log.iter().enumerate().skip(from).take(self.batch);
        let deliveries: Vec<_> = messages
            .map(|(at, bytes)| Delivery { position: at as u64 + 1, bytes: bytes.clone() })
            .collect();
        self.next += deliveries.len();
        Ok(deliveries)
    }

    fn publish(&mut self, estimates: &[Estimate]) -> Result<(), Error> {
        let is_killed = self.is_killed();
        let mut broker = self.broker.lock().unwrap();
        let count = if is_killed { estimates.len() / 2 } else { estimates.len() };
        for estimate in &estimates[..count] {
            let known = broker.stored.entry(estimate.device).or_default();
            let before = known.iter().find(|it| it.id == estimate.id);
            assert!(before.is_none_or(|before| before == estimate), "made again, it is another");
            if before.is_some() {
                broker.again += 1;
            } else {
                known.push(estimate.clone());
            }
        }
        if is_killed { killed() } else { Ok(()) }
    }

    fn acknowledge(&mut self, position: u64) -> Result<(), Error> {
        if self.is_killed() {
            return killed();
        }
        self.broker.lock().unwrap().acknowledged = position;
        Ok(())
    }

    fn lag(&self) -> Option<u64> {
        None
    }
}
