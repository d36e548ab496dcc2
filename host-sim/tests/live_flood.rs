//! Tests of telemetry among garbage: no good frame is lost, and everything is on the disk before it is counted.

mod sender;

use std::ffi::OsString;
use std::fs;
use std::net::SocketAddr;
use std::path::PathBuf;

use host_sim::commands;
use host_sim::commands::live::Live;
use host_sim::random::{stream, uniform};
use kestirim_telemetry::{Health, Imu, Message, Position, Range, VERSION};
use rand_core::Rng;
use sender::{decoded, frame, length, send};
use tempfile::TempDir;

const FRAMES: usize = 100_000;

/// Follows a walker, and records to a file in this folder.
fn start(folder: &TempDir) -> (Live, PathBuf) {
    let path = folder.path().join("new.frames");
    let record = path.to_str().expect("a plain name");
    let arguments = ["host-sim", "live", "--udp", "127.0.0.1:0", "--system", "pedestrian"];
    let arguments = [&arguments[..], &["--record", record]].concat();
    let typed: Vec<_> = arguments.iter().map(OsString::from).collect();
    let matches = commands::command(&typed).get_matches_from(&typed);
    let live = matches.subcommand_matches("live").expect("the command");
    (Live::of(live).expect("it listens"), path)
}

/// A message like those of a walker who also ranges; one in a thousand is implausible.
fn message(number: usize, rng: &mut impl Rng) -> Message {
    let time_us = number as u64 * 5_000;
    match number % 10 {
        0 => Range { time_us, anchor: (number % 7) as u16, range: uniform(rng) as f32 }.into(),
        1 => Position { time_us, position: [number as f32; 3], sigma: None }.into(),
        2 => Health { time_us, accepted: number as u32, rejected: 0, failed: 0 }.into(),
        _ => {
            let wild = number % 1000 == 3;
            let x = if wild { f32::NAN } else { uniform(rng) as f32 };
            Imu { time_us, specific_force: [x, 0.0, 9.81], angular_rate: [0.0; 3] }.into()
        }
    }
}

/// Garbage of several kinds, none of which is a good frame.
fn garbage(kind: usize, rng: &mut impl Rng) -> Vec<u8> {
    let whole = || frame(Health { time_us: 1, accepted: 2, rejected: 3, failed: 4 }, 5);
    match kind % 5 {
        0 => {
            let mut bytes = vec![0; (rng.next_u32() % 100) as usize];
            rng.fill_bytes(&mut bytes);
            bytes
        }
        1 => whole()[..9].to_vec(),
        2 => {
            let mut wrong = whole();
            wrong[5] ^= 0x40;
            wrong
        }
        3 => {
            let content = [VERSION + 1, 0, 0, 1, 2, 3];
            let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&content);
            let content = [&content[..], &checksum.to_le_bytes()].concat();
            [&[0], &cobs::encode_vec(&content)[..], &[0]].concat()
        }
        _ => vec![0xA5; 500],
    }
}

/// Cuts bytes into pieces of random lengths.
fn pieces<'a>(mut bytes: &'a [u8], rng: &mut impl Rng) -> Vec<&'a [u8]> {
    let mut pieces = Vec::new();
    while !bytes.is_empty() {
        let (piece, rest) = bytes.split_at(bytes.len().min(200 + (rng.next_u32() % 1200) as usize));
        pieces.push(piece);
        bytes = rest;
    }
    pieces
}

#[test]
fn a_flood_of_garbage_costs_no_good_frame() {
    let mut rng = stream(8, 0);
    let messages: Vec<_> = (0..FRAMES).map(|number| message(number, &mut rng)).collect();
    let mut bytes = Vec::new();
    for (number, &message) in messages.iter().enumerate() {
        if number % 4 == 0 {
            bytes.extend(garbage(number / 4, &mut rng));
        }
        bytes.extend(frame(message, number));
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (live, path) = start(&folder);
    let address: SocketAddr = live.address().expect("a port");
    send(address, pieces(&bytes, &mut rng).into_iter(), || {
        let counted = live.counts().bytes;
        assert!(length(&path) >= counted, "what is counted is in the file");
        counted
    });
    let answer = live.answer();
    let report = live.finish().expect("nothing broke");
    let counts = report.counts;
    assert_eq!((counts.received, counts.lost), (FRAMES as u32, 0), "{counts:?}");
    assert_eq!(counts.unknown as usize, FRAMES / 20, "{counts:?}");
    assert!(counts.torn as usize >= FRAMES / 20, "{counts:?}");
    assert!(counts.corrupt as usize >= FRAMES / 20, "{counts:?}");
    assert_eq!(counts.refused as usize, FRAMES / 1000, "{counts:?}");
    assert_eq!(counts.taken as usize, FRAMES * 7 / 10 - FRAMES / 1000, "{counts:?}");
    // The page is bounded, however long the stream.
    let points =
        answer.figures.iter().flat_map(|figure| &figure.series).map(|s| s.x.len()).sum::<usize>();
    assert!((1000..200_000).contains(&points), "{points}");
    let recorded = fs::read(&path).expect("the recording");
    assert!(recorded == bytes, "every byte is recorded, in its order");
    let (found, _) = decoded(&recorded);
    // A NaN is not equal to itself, but its bits are.
    let same = |(a, b): (&Message, &Message)| format!("{a:?}") == format!("{b:?}");
    assert!(found.len() == FRAMES && found.iter().zip(&messages).all(same));
}

#[test]
fn datagrams_that_overtake_each_other_are_put_in_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let (live, _) = start(&folder);
    let still = |number: usize| Imu {
        time_us: number as u64 * 10_000,
        specific_force: [0.0, 0.0, 9.81],
        angular_rate: [0.0; 3],
    };
    let mut datagrams: Vec<_> = (0..1000).map(|number| frame(still(number), number)).collect();
    for pair in datagrams.chunks_exact_mut(10) {
        pair.swap(4, 5);
    }
    let address = live.address().expect("a port");
    send(address, datagrams.iter().map(Vec::as_slice), || live.counts().bytes);
    let counts = live.finish().expect("nothing broke").counts;
    assert_eq!((counts.received, counts.taken, counts.refused), (1000, 1000, 0), "{counts:?}");
    assert_eq!((counts.lost, counts.left_out), (0, 0), "{counts:?}");
    assert_eq!((counts.torn, counts.corrupt, counts.unknown), (0, 0, 0), "{counts:?}");
}
