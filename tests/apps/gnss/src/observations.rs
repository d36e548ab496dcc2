//! The output of a u-blox receiver: observations (UBX-RXM-RAWX) and the satellites' navigation messages (UBX-RXM-SFRBX).

use core::fmt;

use embedded_io::{Read, ReadReady};
use heapless::Vec;
use kestirim_gnss_message::gps::{Subframe, WORDS};
use kestirim_gnss_ppp::GpsTime;
use ublox::proto27::{PacketRef, Proto27};
use ublox::rxm_rawx::{RxmRawxRef, TrkStatFlags};
use ublox::rxm_sfrbx::RxmSfrbxRef;
use ublox::{FixedBuffer, Parser, ParserBuilder, UbxPacket};

use crate::calendar;

/// The longest message that is read, bytes: 95 signals. A ZED-F9P observes some 60.
const LONGEST: usize = 3_072;
/// The largest number of GPS satellites in an epoch, and of a GPS satellite.
pub(crate) const SATELLITES: usize = 32;

/// `gnssId` of GPS.
const GPS: u8 = 0;
/// `sigId` of L1 C/A, and of both parts of L2C.
const L1: u8 = 0;
const L2: [u8; 2] = [3, 4];

/// The observations of one satellite: those on L1 and L2 that are complete.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Observed {
    pub(crate) satellite: u8,
    /// The codes, m.
    pub(crate) code: [Option<f64>; 2],
    /// The phases, cycles.
    pub(crate) phase: [Option<f64>; 2],
    /// The time for which the phases have been tracked, ms; [`Self::LONGEST_LOCK`] also stands for any longer time.
    pub(crate) lock_ms: [u16; 2],
}

impl Observed {
    pub(crate) const LONGEST_LOCK: u16 = 64_500;
}

/// The observations of one epoch.
#[derive(Clone, Debug)]
pub(crate) struct Observations {
    /// The time of the epoch, by the receiver's clock.
    pub(crate) time: GpsTime,
    pub(crate) satellites: Vec<Observed, SATELLITES>,
}

impl Observations {
    fn of(message: &RxmRawxRef<'_>) -> Self {
        let time = calendar::week(message.week(), message.rcv_tow());
        let mut satellites: Vec<Observed, SATELLITES> = Vec::new();
        for signal in message.measurements() {
            // The driver's name for the signal: the field was reserved before there were receivers of two carriers.
            let carrier = match (signal.gnss_id(), signal.reserved2()) {
                (GPS, L1) => 0,
                (GPS, signal) if L2.contains(&signal) => 1,
                _ => continue,
            };
            let number = signal.sv_id();
            if satellites.iter().all(|observed| observed.satellite != number) {
                // Satellites beyond the capacity are ignored.
                let _ = satellites.push(Observed { satellite: number, ..Observed::default() });
            }
            let observed = satellites.iter_mut().find(|observed| observed.satellite == number);
            let Some(observed) = observed else { continue };
            let status = signal.trk_stat();
            let whole = TrkStatFlags::CP_VALID | TrkStatFlags::HALF_CYCLE;
            set(
                &mut observed.code,
                carrier,
                status.contains(TrkStatFlags::PR_VALID).then(|| signal.pr_mes()),
            );
            set(&mut observed.phase, carrier, status.contains(whole).then(|| signal.cp_mes()));
            set(&mut observed.lock_ms, carrier, signal.lock_time());
        }
        Self { time, satellites }
    }
}

fn set<T>(both: &mut [T; 2], carrier: usize, value: T) {
    if let Some(place) = both.get_mut(carrier) {
        *place = value;
    }
}

/// A message from the receiver.
#[allow(clippy::large_enum_variant)] // There is no heap to put the larger one on.
pub(crate) enum Message {
    /// The observations of an epoch.
    Epoch(Observations),
    /// A subframe from a GPS satellite.
    Subframe { satellite: u8, subframe: Subframe },
}

/// The LNAV subframe in a message, if it holds one.
fn subframe(message: &RxmSfrbxRef<'_>) -> Option<Message> {
    // The driver's name for the signal: the field was reserved before there were dual-frequency receivers.
    if (message.gnss_id(), message.reserved1()) != (GPS, L1) {
        return None;
    }
    let mut words = [0; WORDS];
    let mut sent = message.dwrd();
    for word in &mut words {
        *word = sent.next()?;
    }
    let subframe = Subframe::from_words(&words)?;
    Some(Message::Subframe { satellite: message.sv_id(), subframe })
}

/// A receiver on a port.
pub(crate) struct Receiver<P> {
    port: P,
    parser: Parser<FixedBuffer<LONGEST>, Proto27>,
    damaged: u32,
}

impl<P> fmt::Debug for Receiver<P> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Receiver").field("damaged", &self.damaged).finish_non_exhaustive()
    }
}

impl<P: Read + ReadReady> Receiver<P> {
    pub(crate) fn new(port: P) -> Self {
        let parser = ParserBuilder::new().with_protocol::<Proto27>().with_fixed_buffer();
        Self { port, parser, damaged: 0 }
    }

    /// The number of damaged messages.
    pub(crate) const fn damaged(&self) -> u32 {
        self.damaged
    }

    /// Reads what has arrived, up to the next message that is used; does not block.
    pub(crate) fn message(&mut self) -> Result<Option<Message>, P::Error> {
        let mut byte = [0];
        while self.port.read_ready()? && self.port.read(&mut byte)? > 0 {
            let mut packets = self.parser.consume_ubx(&byte);
            while let Some(packet) = packets.next() {
                let message = match packet {
                    Ok(UbxPacket::Proto27(PacketRef::RxmRawx(message))) => {
                        Some(Message::Epoch(Observations::of(&message)))
                    }
                    Ok(UbxPacket::Proto27(PacketRef::RxmSfrbx(message))) => subframe(&message),
                    Ok(_) => None,
                    Err(_) => {
                        self.damaged = self.damaged.saturating_add(1);
                        None
                    }
                };
                if message.is_some() {
                    return Ok(message);
                }
            }
        }
        Ok(None)
    }
}
