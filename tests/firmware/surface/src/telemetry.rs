//! Calls everything of `kestirim-telemetry`.

use core::convert::Infallible;

use embedded_io::{ErrorType, Write};
use kestirim_telemetry::{
    CAPACITY, DeviceTransmitter, Flight, Frames, GlobalPosition, Health, Message, Origin, Position,
    Receiver, Transmitter, encode, encode_from,
};

use super::values::{any, call_each, keep, maybe, number, numbers, one_of, rounds, slice, whole};

/// A port that accepts all bytes. (The default `write_all` of `embedded-io` slices, and would panic for a port that
/// claims to have taken more than it was given.)
struct Port;

impl ErrorType for Port {
    type Error = Infallible;
}

impl Write for Port {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        keep(bytes);
        Ok(bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        keep(bytes);
        Ok(())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

fn message() -> Message {
    let time_us = whole();
    let sigma = maybe(number());
    one_of([
        Message::from(Flight { time_us, inputs: numbers(), outputs: numbers() }),
        Message::from(Position { time_us, position: numbers(), sigma }),
        Message::from(GlobalPosition { time_us, position: [f64::from_bits(whole()); 3], sigma }),
        Message::from(Health { time_us, accepted: whole(), rejected: whole(), failed: whole() }),
    ])
}

fn origin() -> Origin {
    Origin { device: whole(), boot: whole() }
}

fn frames() {
    let mut receivers = any([Receiver::new(), <Receiver as Default>::default()]);
    for receiver in &mut receivers {
        for _ in 0..rounds() {
            let mut buffer = [whole(); CAPACITY];
            keep(encode(&message(), whole(), any(&mut buffer)).is_ok());
            keep(encode_from(origin(), &message(), whole(), any(&mut buffer)).is_ok());
            keep(Message::measured_us(&message()));
            keep(Receiver::push(receiver, whole()));
            let mut frames = any(Receiver::frames(receiver, slice(&buffer)));
            keep(<Frames<'_> as Iterator>::next(&mut frames));
            keep(frames.count());
        }
        keep(Receiver::counts(receiver));
    }
}

fn transmitters() {
    let mut transmitter = any(Transmitter::new(Port));
    for _ in 0..rounds() {
        keep(Transmitter::send(&mut transmitter, message()));
    }
    keep(Transmitter::release(transmitter).flush());
    let mut transmitter = any(DeviceTransmitter::new(Port, origin()));
    for _ in 0..rounds() {
        keep(DeviceTransmitter::send(&mut transmitter, message()));
    }
    keep(DeviceTransmitter::release(transmitter).flush());
}

/// Calls everything in this module.
pub fn run() {
    call_each([frames, transmitters]);
}
