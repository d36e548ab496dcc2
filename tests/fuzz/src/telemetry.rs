//! Feeds arbitrary bytes to a telemetry receiver: it yields as many frames as it counts, and a frame of either version
//! among them arrives.

use kestirim_telemetry::{CAPACITY, Health, Origin, Receiver, encode, encode_from};

/// Feeds these bytes.
pub fn feed(bytes: &[u8]) {
    let mut receiver = Receiver::new();
    assert_eq!(receiver.frames(bytes).count(), receiver.counts().received as usize);
    let sent = Health { time_us: 1, accepted: 2, rejected: 3, failed: 4 }.into();
    let mut buffer = [0; CAPACITY];
    let frame = encode(&sent, 7, &mut buffer).expect("it is long enough");
    assert_eq!(receiver.frames(frame).last().map(|frame| frame.message), Some(sent));
    let origin = Origin { device: 1, boot: 2 };
    let frame = encode_from(origin, &sent, 7, &mut buffer).expect("it is long enough");
    let said = receiver.frames(frame).last().map(|frame| (frame.origin, frame.message));
    assert_eq!(said, Some((Some(origin), sent)));
}
