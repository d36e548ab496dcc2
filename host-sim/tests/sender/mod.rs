//! Sends telemetry to the program, no faster than it is recorded.

// Each test uses a part of it.
#![allow(dead_code)]

use std::fs;
use std::net::{SocketAddr, UdpSocket};
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

use kestirim_telemetry::{CAPACITY, Counts, Message, Origin, Receiver, encode, encode_from};

/// The maximum number of bytes in flight: far less than any kernel buffers for a socket.
const ON_THE_WAY: u64 = 32_000;
/// The timeout of all waits: nothing here takes as long.
const FOREVER: Duration = Duration::from_secs(300);

/// A frame of a message without a device number.
pub(crate) fn frame(message: impl Into<Message>, sequence: usize) -> Vec<u8> {
    let mut buffer = [0; CAPACITY];
    encode(&message.into(), sequence as u16, &mut buffer).expect("the capacity is enough").to_vec()
}

/// A frame of a device.
pub(crate) fn frame_of(
    device: u32,
    boot: u32,
    message: impl Into<Message>,
    sequence: usize,
) -> Vec<u8> {
    let (origin, mut buffer) = (Origin { device, boot }, [0; CAPACITY]);
    let frame = encode_from(origin, &message.into(), sequence as u32, &mut buffer);
    frame.expect("the capacity is enough").to_vec()
}

/// Frames of all messages, numbered from 0.
pub(crate) fn frames<M: Into<Message>>(messages: impl IntoIterator<Item = M>) -> Vec<u8> {
    messages.into_iter().enumerate().flat_map(|(number, message)| frame(message, number)).collect()
}

/// The messages in a recording.
pub(crate) fn decoded(bytes: &[u8]) -> (Vec<Message>, Counts) {
    let mut receiver = Receiver::new();
    let messages = receiver.frames(bytes).map(|frame| frame.message).collect();
    (messages, receiver.counts())
}

/// Waits until a condition holds.
pub(crate) fn wait_for(what: &str, mut happened: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !happened() {
        assert!(begun.elapsed() < FOREVER, "waited too long for {what}");
        sleep(Duration::from_millis(1));
    }
}

/// The length of a recording in bytes.
pub(crate) fn length(recording: &Path) -> u64 {
    fs::metadata(recording).map_or(0, |file| file.len())
}

/// Sends datagrams, waiting whenever too many bytes have not been confirmed as arrived.
pub(crate) fn send<'a>(
    address: SocketAddr,
    datagrams: impl Iterator<Item = &'a [u8]>,
    arrived: impl Fn() -> u64,
) {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
    let before = arrived();
    let mut sent = 0;
    for datagram in datagrams {
        wait_for("what was sent", || sent <= arrived() - before + ON_THE_WAY);
        socket.send_to(datagram, address).expect("it is sent");
        sent += datagram.len() as u64;
    }
    wait_for("all that was sent", || arrived() - before == sent);
}
