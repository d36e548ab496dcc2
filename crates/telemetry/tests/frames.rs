//! Frames on a line that loses, flips and invents bytes.

use kestirim_telemetry::{
    CAPACITY, Counts, Error, EstimateHealth, Flight, Footprint, Frame, GlobalPosition, Health, Imu,
    Message, Order, Origin, PathLoss, Position, Range, Receiver, State, VERSION, VERSION_OF_FLEETS,
    encode, encode_from,
};
use proptest::array::{uniform2, uniform3, uniform4};
use proptest::collection::vec;
use proptest::prelude::*;

const ANY: proptest::num::f32::Any = proptest::num::f32::NORMAL;

fn message() -> impl Strategy<Value = Message> {
    let time = any::<u64>;
    let sigma = || proptest::option::of(any::<f32>());
    prop_oneof![
        (time(), uniform3(ANY), uniform3(ANY)).prop_map(
            |(time_us, specific_force, angular_rate)| {
                Imu { time_us, specific_force, angular_rate }.into()
            }
        ),
        (time(), any::<u16>(), ANY).prop_map(|(time_us, anchor, range)| Range {
            time_us,
            anchor,
            range
        }
        .into()),
        (time(), uniform3(ANY), ANY).prop_map(|(time_us, place, loss)| PathLoss {
            time_us,
            place,
            loss
        }
        .into()),
        (time(), uniform2(ANY), uniform3(ANY)).prop_map(|(time_us, inputs, outputs)| Flight {
            time_us,
            inputs,
            outputs
        }
        .into()),
        (time(), uniform3(ANY), sigma()).prop_map(|(time_us, position, sigma)| Position {
            time_us,
            position,
            sigma
        }
        .into()),
        (time(), uniform3(any::<f64>()), sigma()).prop_map(|(time_us, position, sigma)| {
            GlobalPosition { time_us, position, sigma }.into()
        }),
        (time(), uniform4(ANY)).prop_map(|(time_us, state)| State { time_us, state }.into()),
        (time(), uniform3(ANY), ANY).prop_map(|(time_us, position, length)| {
            Footprint { time_us, position, length }.into()
        }),
        (time(), any::<[u32; 3]>()).prop_map(|(time_us, [accepted, rejected, failed])| {
            Health { time_us, accepted, rejected, failed }.into()
        }),
        (time(), any::<u16>())
            .prop_map(|(time_us, reasons)| EstimateHealth { time_us, reasons }.into()),
    ]
}

fn frame(message: &Message, sequence: u16) -> Vec<u8> {
    encode(message, sequence, &mut [0; CAPACITY]).expect("the capacity is enough").to_vec()
}

fn of_device(device: u32, boot: u32, sequence: u32, message: &Message) -> Vec<u8> {
    let origin = Origin { device, boot };
    let frame = encode_from(origin, message, sequence, &mut [0; CAPACITY]).map(<[u8]>::to_vec);
    frame.expect("the capacity is enough")
}

/// The messages that a receiver finds in pieces of a stream, and its counts.
fn receive(stream: &[u8], piece: usize) -> (Vec<Frame>, Counts) {
    let mut receiver = Receiver::new();
    let pieces = stream.chunks(piece.max(1));
    let frames = pieces.flat_map(|piece| receiver.frames(piece).collect::<Vec<_>>()).collect();
    (frames, receiver.counts())
}

fn health(accepted: u32) -> Message {
    Health { time_us: 0, accepted, rejected: 0, failed: 0 }.into()
}

/// A frame with a checksum that vouches for any content.
fn vouched(content: &[u8]) -> Vec<u8> {
    let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(content);
    let content = [content, &checksum.to_le_bytes()].concat();
    [&[0], &cobs::encode_vec(&content)[..], &[0]].concat()
}

#[test]
fn the_longest_frame_fills_the_capacity() {
    let longest = GlobalPosition { time_us: u64::MAX, position: [1.0; 3], sigma: Some(1.0) };
    let longest = longest.into();
    assert_eq!(of_device(u32::MAX, u32::MAX, u32::MAX, &longest).len(), CAPACITY);
    assert_eq!(CAPACITY, 60, "the README counts the same");
    assert_eq!(frame(&longest, u16::MAX).len(), CAPACITY - 10, "of version 1");
    let shortest = EstimateHealth { time_us: 0, reasons: 0 }.into();
    assert_eq!(frame(&shortest, 0).len(), CAPACITY - 47, "the shortest message has 3 bytes");
}

#[test]
fn a_frame_is_laid_out_as_documented() {
    let range = Range { time_us: 300, anchor: 2, range: 1.0 };
    let mut content = vec![VERSION, 0x34, 0x12];
    content.extend([1, 0xAC, 0x02, 2, 0x00, 0x00, 0x80, 0x3F]);
    assert_eq!(frame(&range.into(), 0x1234), vouched(&content));
    let mut content = vec![VERSION_OF_FLEETS, 4, 3, 2, 1, 5, 0, 0, 0, 0x34, 0x12, 0, 0];
    content.extend([1, 0xAC, 0x02, 2, 0x00, 0x00, 0x80, 0x3F]);
    assert_eq!(of_device(0x0102_0304, 5, 0x1234, &range.into()), vouched(&content));
}

#[test]
fn devices_share_a_line_with_a_sender_that_does_not_say_who_it_is() {
    let stream: Vec<u8> = (0..100_u32)
        .flat_map(|n| {
            let device = |device: u32| of_device(device, 7, n * device, &health(n));
            [device(1), frame(&health(n), n as u16), device(1000)].concat()
        })
        .collect();
    let (frames, counts) = receive(&stream, 11);
    assert_eq!(counts, Counts { received: 300, ..Counts::default() });
    for (place, frame) in frames.iter().enumerate() {
        let n = place as u32 / 3;
        let expected = match place % 3 {
            0 => (Some(Origin { device: 1, boot: 7 }), n, None),
            1 => (None, n, Some(Order::Newest { missing: 0 })),
            _ => (Some(Origin { device: 1000, boot: 7 }), 1000 * n, None),
        };
        assert_eq!((frame.origin, frame.sequence, frame.order), expected);
        assert_eq!(frame.message, health(n));
    }
    let [a, b] = [1, 2].map(|n| receive(&of_device(1, 1, 5, &health(n)), 1).0[0].checksum);
    assert_ne!(a, b, "of another sender with the same number");
}

#[test]
fn a_short_buffer_is_refused() {
    for length in 0..frame(&health(1), 1).len() {
        let refused = encode(&health(1), 1, &mut vec![0; length]).map(<[u8]>::len);
        assert_eq!(refused, Err(Error::BufferTooShort), "{length} bytes");
    }
}

#[test]
fn missing_numbers_are_counted() {
    let numbers = [65_533_u16, 65_535, 0, 3, 3, 1];
    let stream: Vec<u8> = numbers.iter().flat_map(|&number| frame(&health(0), number)).collect();
    let (frames, counts) = receive(&stream, 7);
    assert_eq!(
        frames.iter().map(|frame| frame.sequence).collect::<Vec<_>>(),
        numbers.map(u32::from)
    );
    // One before 65535, two before 3; the 3 comes twice, and the 1 late.
    assert_eq!(counts, Counts { received: 6, lost: 2, foreign: 1, ..Counts::default() });
}

#[test]
fn what_is_not_known_is_counted_as_such() {
    let mut other_version = vec![VERSION_OF_FLEETS + 1, 0, 0];
    other_version.extend([8, 0, 0, 0, 0]);
    let other_message = [VERSION, 0, 0, 200, 0];
    let too_long_for_its_kind = [VERSION, 0, 0, 8, 0, 0, 0, 0, 0];
    let without_number = [VERSION_OF_FLEETS, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0, 0];
    let stream = [&other_version[..], &other_message, &too_long_for_its_kind, &without_number];
    let (frames, counts) = receive(&stream.map(vouched).concat(), 1);
    assert_eq!((frames.len(), counts), (0, Counts { unknown: 4, ..Counts::default() }));
}

proptest! {
    #[test]
    fn what_was_sent_arrives(sent in vec(message(), 0..20), first: u16, piece in 1_usize..100) {
        let number = |index: usize| first.wrapping_add(index as u16);
        let stream: Vec<u8> =
            sent.iter().enumerate().flat_map(|(i, message)| frame(message, number(i))).collect();
        let (frames, counts) = receive(&stream, piece);
        let order = Some(Order::Newest { missing: 0 });
        let expected: Vec<_> = sent
            .iter()
            .enumerate()
            .map(|(i, &message)| (None, u32::from(number(i)), order, message))
            .collect();
        let frames = frames.iter().map(|frame| (frame.origin, frame.sequence, frame.order, frame.message));
        prop_assert_eq!(frames.collect::<Vec<_>>(), expected);
        prop_assert_eq!(counts, Counts { received: sent.len() as u32, ..Counts::default() });
    }

    #[test]
    fn garbage_between_frames_costs_nothing_but_itself(
        sent in vec((vec(any::<u8>(), 0..80), message()), 1..10),
        end in vec(any::<u8>(), 0..80),
        piece in 1_usize..100,
    ) {
        let mut stream = Vec::new();
        for (index, (garbage, message)) in sent.iter().enumerate() {
            stream.extend(garbage);
            stream.extend(frame(message, index as u16));
        }
        stream.extend(end);
        let (frames, counts) = receive(&stream, piece);
        let messages: Vec<Message> = frames.iter().map(|frame| frame.message).collect();
        prop_assert_eq!(messages, sent.iter().map(|(_, message)| *message).collect::<Vec<_>>());
        prop_assert_eq!((counts.received, counts.lost), (sent.len() as u32, 0));
    }

    #[test]
    fn a_flipped_bit_is_detected(before in message(), hit in message(), after in message()) {
        let [first, second, third] = [(before, 0), (hit, 1), (after, 2)]
            .map(|(message, number)| frame(&message, number));
        let whole = [first.clone(), second.clone(), third].concat();
        for bit in first.len() * 8..(first.len() + second.len()) * 8 {
            let mut stream = whole.clone();
            stream[bit / 8] ^= 1 << (bit % 8);
            let (frames, counts) = receive(&stream, stream.len());
            prop_assert_eq!(
                frames.iter().map(|frame| frame.message).collect::<Vec<_>>(),
                // A flipped delimiter is noise before a frame that has another, or behind one.
                if frames.len() == 3 { vec![before, hit, after] } else { vec![before, after] },
                "bit {}", bit
            );
            prop_assert!(counts.torn + counts.corrupt >= 1, "bit {}: {:?}", bit, counts);
            prop_assert_eq!(counts.received + counts.lost, 3, "bit {}: {:?}", bit, counts);
        }
    }

    #[test]
    fn a_cut_frame_is_counted(message in message(), from in 0_usize..CAPACITY, count in 1_usize..20) {
        let mut hit = frame(&message, 1);
        let from = from.min(hit.len() - 1);
        hit.drain(from..(from + count).min(hit.len()));
        let stream = [frame(&health(0), 0), hit, frame(&health(2), 2)].concat();
        let (frames, counts) = receive(&stream, 1);
        // Without one of its delimiters alone the frame is still whole: its neighbours have theirs.
        prop_assert!(frames.len() == 2 || frames.len() == 3 && frames[1].message == message);
        prop_assert_eq!(counts.received + counts.lost, 3);
    }

    #[test]
    fn nothing_panics_or_invents_messages(bytes in vec(any::<u8>(), 0..2_000)) {
        let (frames, counts) = receive(&bytes, 13);
        prop_assert_eq!((frames.len(), counts.received), (0, 0));
    }
}

#[cfg(feature = "embedded-io")]
#[test]
fn a_transmitter_numbers_its_frames() {
    let mut bytes = [0; 3 * CAPACITY];
    let mut transmitter = kestirim_telemetry::Transmitter::new(&mut bytes[..]);
    for number in 0..3 {
        transmitter.send(health(number)).expect("the slice is long enough");
    }
    let unused = transmitter.release().len();
    let (frames, counts) = receive(&bytes[..bytes.len() - unused], 10);
    assert_eq!(frames.iter().map(|frame| frame.sequence).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!((counts.received, counts.lost), (3, 0));
}

#[cfg(feature = "embedded-io")]
#[test]
fn a_devices_transmitter_numbers_its_frames_and_says_whose_they_are() {
    let mut bytes = [0; 3 * CAPACITY];
    let origin = Origin { device: 9, boot: 3 };
    let mut transmitter = kestirim_telemetry::DeviceTransmitter::new(&mut bytes[..], origin);
    for number in 0..3 {
        transmitter.send(health(number)).expect("the slice is long enough");
    }
    let unused = transmitter.release().len();
    let (frames, _) = receive(&bytes[..bytes.len() - unused], 10);
    let said = frames.iter().map(|frame| (frame.origin, frame.sequence)).collect::<Vec<_>>();
    assert_eq!(said, [0, 1, 2].map(|number| (Some(origin), number)));
}
