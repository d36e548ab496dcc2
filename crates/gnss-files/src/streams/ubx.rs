//! UBX: observations (RXM-RAWX), and the messages of GPS on L1 and of Galileo on E1 and E5b (RXM-SFRBX).
//!
//! (u-blox, ZED-F9P Interface Description, 3.17.5 and 3.17.9; numbers of signals and satellites: 1.5.)

use std::ops::RangeInclusive;

use ublox::proto27::{PacketRef, Proto27};
use ublox::rxm_rawx::{RxmRawxRef, TrkStatFlags};
use ublox::rxm_sfrbx::RxmSfrbxRef;
use ublox::{ParserBuilder, UbxPacket};

use super::collection::Collection;
use super::inav::{self, Word};
use super::lnav::{self, Subframe};
use super::{Locks, Signals, Stream};
use crate::observations::{CHANNELS, Raw, Signal};
use crate::system::System;
use crate::text::Text;
use crate::time::GpsTime;
use crate::unserved::Unserved;

/// The longest message that is read, bytes: 255 signals.
const LONGEST: usize = 8_192;
/// What is told at most of how long a phase has been tracked, ms.
const LONGEST_LOCK: u16 = 64_500;
/// `gnssId` of the systems that are served.
const OF_GPS: u8 = 0;
const OF_GALILEO: u8 = 2;
const OF_BEIDOU: u8 = 3;
const OF_GLONASS: u8 = 6;
/// `freqId` of GLONASS is the channel and this.
const FREQUENCY_OF_CHANNEL_0: i8 = 7;
/// `sigId` of L1 C/A, the signal that carries the message which is read.
const L1: u8 = 0;
/// The letters of systems of which the message is not read by their `gnssId`, and what is taken off a satellite's number for the one that
/// RINEX has.
const OTHERS: [(u8, u8, u8); 5] =
    [(1, b'S', 100), (3, b'C', 0), (5, b'J', 0), (6, b'R', 0), (7, b'I', 0)];
/// Days of a week.
const WEEK: i32 = 7;
/// Numbers of satellites of both.
const GPS: RangeInclusive<u8> = 1..=32;
const GALILEO_NUMBERS: RangeInclusive<u8> = 1..=36;

/// Reads a file.
pub(super) fn read(text: &Text) -> Stream {
    let mut reader = Reader::default();
    let mut parser = ParserBuilder::new().with_protocol::<Proto27>().with_fixed_buffer::<LONGEST>();
    let mut damaged = 0;
    // The parser takes no more at once than it has room for.
    for piece in text.bytes().chunks(LONGEST / 2) {
        let mut packets = parser.consume_ubx(piece);
        while let Some(packet) = packets.next() {
            match packet {
                Ok(UbxPacket::Proto27(PacketRef::RxmRawx(message))) => {
                    reader.observations(&message);
                }
                Ok(UbxPacket::Proto27(PacketRef::RxmSfrbx(message))) => reader.part(&message),
                Ok(_) => reader.stream.skipped += 1,
                Err(_) => damaged += 1,
            }
        }
    }
    let mut stream = reader.finish();
    if damaged > 0 {
        let problem = format!("{damaged} damaged messages are left out");
        stream.warnings.push(text.warning(problem));
    }
    stream
}

/// A part of the message of a satellite.
#[derive(Debug, Clone, Copy)]
enum Part {
    Gps(Subframe),
    Galileo(Word),
}

#[derive(Debug, Default)]
struct Reader {
    stream: Stream,
    locks: Locks,
    /// Parts of messages in the order of the stream, of which the week is not known by themselves, each with the place of the
    /// epoch before it and its satellite's number.
    parts: Vec<(usize, u8, Part)>,
}

impl Reader {
    fn observations(&mut self, message: &RxmRawxRef<'_>) {
        let day = GpsTime::EPOCH.day() + WEEK * i32::from(message.week());
        let time = GpsTime::new(day, message.rcv_tow());
        let milliseconds = (1e3 * message.rcv_tow()).round() as i64;
        let mut satellites: Vec<Signals> = Vec::new();
        for it in message.measurements() {
            // The driver's name of the signal: it was reserved before there were receivers of two carriers.
            let (system, number) = (it.gnss_id(), it.sv_id());
            let Some((satellite, [code, phase])) = told(system, number, it.reserved2()) else {
                if !matches!(system, OF_BEIDOU | OF_GLONASS) {
                    note(&mut self.stream.observed, system, number);
                }
                continue;
            };
            if system == OF_GLONASS {
                let channel = it.freq_id().cast_signed().wrapping_sub(FREQUENCY_OF_CHANNEL_0);
                if CHANNELS.contains(&channel) {
                    self.stream.channels.insert(satellite, channel);
                }
            }
            let known = satellites.iter().position(|(other, _)| *other == satellite);
            let place = known.unwrap_or_else(|| {
                satellites.push((satellite, Vec::new()));
                satellites.len() - 1
            });
            let raw = &mut satellites[place].1;
            let status = it.trk_stat();
            if status.contains(TrkStatFlags::PR_VALID) {
                raw.push(Raw { signal: code, value: it.pr_mes(), lock_lost: false });
            }
            // Half a cycle may be missing until it is told that none is.
            if status.contains(TrkStatFlags::CP_VALID | TrkStatFlags::HALF_CYCLE) {
                let tracked = match it.lock_time() {
                    LONGEST_LOCK.. => Locks::LONGEST,
                    tracked => u32::from(tracked),
                };
                let lock_lost = self.locks.lost(satellite, phase, milliseconds, tracked);
                raw.push(Raw { signal: phase, value: it.cp_mes(), lock_lost });
            }
        }
        self.stream.epochs.push((time, satellites));
    }

    fn part(&mut self, message: &RxmSfrbxRef<'_>) {
        let (system, number) = (message.gnss_id(), message.sv_id());
        // The driver's name of the signal, too.
        let signal = message.reserved1();
        let part = match system {
            OF_GPS if signal == L1 && GPS.contains(&number) => {
                Subframe::of(message.dwrd().take(lnav::WORDS)).map(Part::Gps)
            }
            // Both signals carry the same message; of another it would not have the checksum.
            OF_GALILEO if GALILEO_NUMBERS.contains(&number) => {
                Word::of(message.dwrd().take(inav::WORDS)).map(Part::Galileo)
            }
            _ => None,
        };
        let Some(part) = part else {
            self.stream.skipped += 1;
            note(&mut self.stream.unread, system, number);
            return;
        };
        self.parts.push((self.stream.epochs.len().saturating_sub(1), number, part));
    }

    /// Makes ephemerides of the parts.
    fn finish(self) -> Stream {
        let Self { mut stream, parts, .. } = self;
        let mut of_gps = Collection::new();
        let mut of_galileo = Collection::new();
        for (place, number, part) in parts {
            // Without any epoch there is no week.
            let Some(near) = stream.epochs.get(place).map(|(time, _)| *time) else { break };
            let (satellite, ephemeris) = match part {
                Part::Gps(subframe) => {
                    stream.ionosphere = lnav::ionosphere(&subframe).or(stream.ionosphere);
                    let ephemeris = |parts| lnav::ephemeris(parts, near);
                    (number, of_gps.take(number, (subframe.number(), subframe), ephemeris))
                }
                Part::Galileo(word) => {
                    let ephemeris = |parts| inav::ephemeris(parts, near);
                    let ephemeris = of_galileo.take(number, (word.number(), word), ephemeris);
                    let Some(satellite) = System::Galileo.number(number) else { continue };
                    (satellite, ephemeris)
                }
            };
            stream.ephemerides.extend(ephemeris.map(|ephemeris| (satellite, ephemeris)));
        }
        stream
    }
}

/// Takes note of a satellite by the receiver's numbers, if its system is one of the others.
fn note(unserved: &mut Unserved, system: u8, number: u8) {
    let Some((_, letter, off)) = OTHERS.iter().find(|(of, ..)| *of == system) else { return };
    if let Some(number) = number.checked_sub(*off) {
        unserved.note(*letter, number);
    }
}

/// The satellite and its code and phase of a signal, by the numbers that the receiver has for it; none of a signal that is not
/// used.
fn told(system: u8, number: u8, signal: u8) -> Option<(u8, [Signal; 2])> {
    let of = match system {
        OF_GPS => System::Gps,
        OF_GALILEO => System::Galileo,
        OF_BEIDOU => System::BeiDou,
        OF_GLONASS => System::Glonass,
        _ => return None,
    };
    let [band, tracking] = match (system, signal) {
        // B1I with the message of most satellites, and with that of geostationary ones.
        (OF_BEIDOU, 0 | 1) => *b"2I",
        (OF_BEIDOU, 2 | 3) | (OF_GALILEO, 5) => *b"7I",
        (OF_BEIDOU, 4 | 10) => *b"6I",
        (OF_BEIDOU, 5) => *b"1P",
        (OF_BEIDOU, 6) => *b"1D",
        (OF_BEIDOU, 7) => *b"5P",
        (OF_BEIDOU, 8) => *b"5D",
        (OF_GLONASS, 2) => *b"2C",
        (_, 0) => *b"1C",
        (OF_GPS, 3) => *b"2L",
        (OF_GPS, 4) => *b"2S",
        (OF_GALILEO, 1) => *b"1B",
        (OF_GALILEO, 3) => *b"5I",
        (OF_GALILEO, 4) => *b"5Q",
        (OF_GALILEO, 6) => *b"7Q",
        _ => return None,
    };
    let signal = |kind| Signal::new(of.letter(), &[kind, band, tracking]);
    Some((of.number(number)?, [signal(b'C')?, signal(b'L')?]))
}
