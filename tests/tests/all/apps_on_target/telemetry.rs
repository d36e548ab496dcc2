//! Decodes telemetry from a serial port.

use kestirim_telemetry::{Message, Receiver};

/// All messages in order; panics if any was lost or damaged.
pub(crate) fn messages(bytes: &[u8]) -> Vec<Message> {
    let mut receiver = Receiver::new();
    let frames: Vec<_> = receiver.frames(bytes).collect();
    let counts = receiver.counts();
    assert_eq!((counts.torn, counts.corrupt, counts.unknown, counts.lost), (0, 0, 0, 0));
    assert_eq!(frames.first().map(|frame| frame.sequence), Some(0), "nothing is lost at the start");
    frames.into_iter().map(|frame| frame.message).collect()
}

/// The reasons against the estimate, as bits, each time that they are told.
pub(crate) fn doubts(messages: &[Message]) -> Vec<u16> {
    let reasons = |message: &Message| match message {
        Message::EstimateHealth(estimate) => Some(estimate.reasons),
        _ => None,
    };
    messages.iter().filter_map(reasons).collect()
}
