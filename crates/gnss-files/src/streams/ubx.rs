//! UBX: observations (RXM-RAWX), and the navigation messages of GPS on L1, of Galileo on E1 and E5b, and of BeiDou's satellites that
//! are not geostationary (RXM-SFRBX).
//!
//! Source: u-blox, ZED-F9P Interface Description, 3.17.5 and 3.17.9; numbers of signals and satellites: 1.5.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use kestirim_gnss_message::galileo::Word;
use kestirim_gnss_message::{Collector, beidou, gps};
use ublox::proto27::{PacketRef, Proto27};
use ublox::rxm_rawx::{RxmRawxRef, TrkStatFlags};
use ublox::rxm_sfrbx::RxmSfrbxRef;
use ublox::{ParserBuilder, UbxPacket};

use super::dated::dated;
use super::{Locks, Signals, Stream};
use crate::navigation::Message;
use crate::observations::{CHANNELS, Raw, Signal};
use crate::system::System;
use crate::text::Text;
use crate::time::GpsTime;
use crate::unserved::Unserved;

/// The longest message that is read, bytes: 255 signals.
const LONGEST: usize = 8_192;
/// The maximum of the reported phase tracking time, ms.
const LONGEST_LOCK: u16 = 64_500;
/// `gnssId` of the systems that are read.
const OF_GPS: u8 = 0;
const OF_GALILEO: u8 = 2;
const OF_BEIDOU: u8 = 3;
const OF_GLONASS: u8 = 6;
/// `freqId` of GLONASS is the channel plus this.
const FREQUENCY_OF_CHANNEL_0: i8 = 7;
/// `sigId` of L1 C/A, the signal of GPS whose navigation message is read.
const L1: u8 = 0;
/// `sigId` of B1I, B2I and B3I with the message D1.
const D1: [u8; 3] = [0, 2, 4];
/// The systems with navigation messages that are not read: `gnssId`, letter, and what is subtracted from a satellite's
/// number for that of RINEX.
const OTHERS: [(u8, u8, u8); 5] =
    [(1, b'S', 100), (3, b'C', 0), (5, b'J', 0), (6, b'R', 0), (7, b'I', 0)];
/// The length of a week, days.
const WEEK: i32 = 7;
/// The satellite numbers of GPS whose navigation messages are read.
const GPS: RangeInclusive<u8> = 1..=32;
/// The satellite numbers of Galileo whose navigation messages are read.
const GALILEO_NUMBERS: RangeInclusive<u8> = 1..=36;
/// The satellite numbers of BeiDou; those of geostationary satellites among them send another message on other signals.
const BEIDOU_NUMBERS: RangeInclusive<u8> = 1..=63;

/// Reads a file.
pub(super) fn read(text: &Text) -> Stream {
    let mut reader = Reader::default();
    let mut parser = ParserBuilder::new().with_protocol::<Proto27>().with_fixed_buffer::<LONGEST>();
    let mut damaged = 0;
    // The parser accepts no more at once than its buffer holds.
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

/// A part of a satellite's navigation message.
#[derive(Debug, Clone, Copy)]
enum Part {
    Gps(gps::Subframe),
    Galileo(Word),
    BeiDou(beidou::Subframe),
}

#[derive(Debug, Default)]
struct Reader {
    stream: Stream,
    locks: Locks,
    /// Parts of navigation messages in the order of the stream, each with the index of the epoch before it and the
    /// satellite's number; they do not tell the week by themselves.
    parts: Vec<(usize, u8, Part)>,
}

impl Reader {
    fn observations(&mut self, message: &RxmRawxRef<'_>) {
        let day = GpsTime::EPOCH.day() + WEEK * i32::from(message.week());
        let time = GpsTime::new(day, message.rcv_tow());
        let milliseconds = (1e3 * message.rcv_tow()).round() as i64;
        let mut satellites: Vec<Signals> = Vec::new();
        for it in message.measurements() {
            // `reserved2` is the signal under the driver's name: the field was reserved before there were
            // dual-frequency receivers.
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
            // The phase may be off by half a cycle until the receiver reports that it is resolved.
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
        // `reserved1` is likewise the signal under the driver's name.
        let signal = message.reserved1();
        let part = match system {
            OF_GPS if signal == L1 && GPS.contains(&number) => {
                words(message).and_then(|words| gps::Subframe::from_words(&words)).map(Part::Gps)
            }
            // Both signals carry the same message; another message would not pass the checksum.
            OF_GALILEO if GALILEO_NUMBERS.contains(&number) => {
                words(message).and_then(|page| Word::from_page(&page)).map(Part::Galileo)
            }
            OF_BEIDOU if D1.contains(&signal) && BEIDOU_NUMBERS.contains(&number) => words(message)
                .and_then(|words| beidou::Subframe::from_words(&words))
                .map(Part::BeiDou),
            _ => None,
        };
        let Some(part) = part else {
            self.stream.skipped += 1;
            note(&mut self.stream.unread, system, number);
            return;
        };
        self.parts.push((self.stream.epochs.len().saturating_sub(1), number, part));
    }

    /// Assembles ephemerides from the parts.
    fn finish(self) -> Stream {
        let Self { mut stream, parts, .. } = self;
        let mut of_gps = BTreeMap::new();
        let mut of_galileo = BTreeMap::new();
        let mut of_beidou = BTreeMap::new();
        for (place, number, part) in parts {
            // Without any epoch the week is not known.
            let Some((near, _)) = stream.epochs.get(place) else { break };
            let (system, message, ephemeris) = match part {
                Part::Gps(part) => {
                    stream.ionosphere = part.ionosphere().or(stream.ionosphere);
                    (System::Gps, Message::Lnav, collect(&mut of_gps, number, part, *near))
                }
                Part::Galileo(part) => {
                    (System::Galileo, Message::Inav, collect(&mut of_galileo, number, part, *near))
                }
                Part::BeiDou(part) => {
                    (System::BeiDou, Message::D1, collect(&mut of_beidou, number, part, *near))
                }
            };
            if let (Some(satellite), Some(ephemeris)) = (system.number(number), ephemeris) {
                stream.ephemerides.push((satellite, dated(message, &ephemeris, *near)));
            }
        }
        stream
    }
}

/// Adds a part, which came at an instant, to those of its satellite.
fn collect<P: kestirim_gnss_message::Part<N>, const N: usize>(
    satellites: &mut BTreeMap<u8, Collector<P, N>>,
    number: u8,
    part: P,
    now: GpsTime,
) -> Option<kestirim_gnss_message::Ephemeris> {
    satellites.entry(number).or_default().take(part, now.since(GpsTime::EPOCH))
}

/// The first words of a message; `None` if there are fewer.
fn words<const N: usize>(message: &RxmSfrbxRef<'_>) -> Option<[u32; N]> {
    message.dwrd().take(N).collect::<Vec<_>>().try_into().ok()
}

/// Notes a satellite by the receiver's numbers, if its system is one of [`OTHERS`].
fn note(unserved: &mut Unserved, system: u8, number: u8) {
    let Some((_, letter, off)) = OTHERS.iter().find(|(of, ..)| *of == system) else { return };
    if let Some(number) = number.checked_sub(*off) {
        unserved.note(*letter, number);
    }
}

/// The satellite, and the code and phase of a signal, from the receiver's numbers; `None` for a signal that is not
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
        // B1I with the D1 message of most satellites, and with the D2 message of geostationary ones.
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
