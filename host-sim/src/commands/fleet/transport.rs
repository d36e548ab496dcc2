//! The interface that delivers messages and takes estimates away.

use std::fmt::Debug;

use serde::{Deserialize, Serialize};

use crate::Error;

/// The identity of a log: a position is meaningless in another one.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Log {
    /// The origin of the messages: transport, stream and subject.
    pub(super) name: String,
    /// The creation time, for a log that can be deleted and created again under the same name.
    pub(super) created: Option<String>,
}

/// A message with its position in the log.
#[derive(Debug, Clone)]
pub(super) struct Delivery {
    /// The position, which increases from message to message.
    pub(super) position: u64,
    /// The message: complete frames.
    pub(super) bytes: Vec<u8>,
}

/// An estimate to be published.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Estimate {
    pub(super) device: u32,
    /// A unique id that is the same if the estimate is produced again: system, device, boot and number of the frame
    /// after which it was made.
    pub(super) id: String,
    /// The estimate as a frame with the same device and number.
    pub(super) frame: Vec<u8>,
}

/// A broker, or any other transport with a log: messages have an order and a position, and are delivered again on
/// request.
///
/// Supporting another broker takes another implementation of this trait and nothing else.
pub(super) trait Transport: Debug {
    /// The log that positions refer to.
    fn log(&self) -> Log;

    /// Starts, or starts again, after this position, and acknowledges everything up to it; 0 is before the first
    /// message.
    ///
    /// # Errors
    /// If there is no such log.
    fn resume(&mut self, position: u64) -> Result<(), Error>;

    /// Waits briefly for the next messages and returns them in the order of their positions. The result is empty if
    /// none have arrived, or the connection is down.
    ///
    /// # Errors
    /// An error from which waiting does not recover.
    fn receive(&mut self) -> Result<Vec<Delivery>, Error>;

    /// Stores the estimates and returns when all are stored; one whose id is already stored is not stored again.
    ///
    /// # Errors
    /// An error from which waiting does not recover.
    fn publish(&mut self, estimates: &[Estimate]) -> Result<(), Error>;

    /// Declares that nothing up to this position will be requested again.
    ///
    /// # Errors
    /// An error from which waiting does not recover.
    fn acknowledge(&mut self, position: u64) -> Result<(), Error>;

    /// The number of messages waiting to be received, if known.
    fn lag(&self) -> Option<u64>;
}
