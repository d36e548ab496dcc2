//! What brings messages and takes estimates away.

use std::fmt::Debug;

use serde::{Deserialize, Serialize};

use crate::Error;

/// Which log it is: a position means nothing in another.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Log {
    /// What messages come from: transport, stream and subject.
    pub(super) name: String,
    /// When it was made, of a log that can be deleted and made anew under its name.
    pub(super) created: Option<String>,
}

/// What came, with its place in the log from which it came.
#[derive(Debug, Clone)]
pub(super) struct Delivery {
    /// Grows from one to the next.
    pub(super) position: u64,
    /// Whole frames.
    pub(super) bytes: Vec<u8>,
}

/// What goes out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Estimate {
    pub(super) device: u32,
    /// Of no other estimate, and the same if it is made again: system, device, boot and number of the frame after which it was made.
    pub(super) id: String,
    /// A frame of the same device and number.
    pub(super) frame: Vec<u8>,
}

/// A broker, or anything else with a log: messages have an order and a position, and come again if they are asked for.
///
/// Another broker is another implementation, and nothing else.
pub(super) trait Transport: Debug {
    /// Which log positions belong to.
    fn log(&self) -> Log;

    /// Begins, or begins anew, behind this position, and acknowledges all up to there; 0 is before the first message.
    ///
    /// # Errors
    /// If there is nothing of the kind.
    fn resume(&mut self, position: u64) -> Result<(), Error>;

    /// Waits a little for the next messages, in the order of their positions; none came, or nothing is connected just now, if
    /// there are none.
    ///
    /// # Errors
    /// What waiting does not mend.
    fn receive(&mut self) -> Result<Vec<Delivery>, Error>;

    /// Returns when all these are stored; one whose id is stored already is not stored again.
    ///
    /// # Errors
    /// What waiting does not mend.
    fn publish(&mut self, estimates: &[Estimate]) -> Result<(), Error>;

    /// Nothing up to here will be asked for again.
    ///
    /// # Errors
    /// What waiting does not mend.
    fn acknowledge(&mut self, position: u64) -> Result<(), Error>;

    /// Messages that wait to be received, if that is known.
    fn lag(&self) -> Option<u64>;
}
