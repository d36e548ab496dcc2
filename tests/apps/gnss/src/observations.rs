//! What a u-blox receiver observes: its messages UBX-RXM-RAWX.

use core::fmt;

use embedded_io::{Read, ReadReady};
use heapless::Vec;
use kestirim_gnss_ppp::GpsTime;
use ublox::proto27::{PacketRef, Proto27};
use ublox::rxm_rawx::{RxmRawxRef, TrkStatFlags};
use ublox::{FixedBuffer, Parser, ParserBuilder, UbxPacket};

use crate::calendar;

/// The longest message that is read, bytes: 95 signals. A ZED-F9P observes some 60.
const LONGEST: usize = 3_072;
/// GPS satellites that are told of at a time.
const SATELLITES: usize = 32;

/// `gnssId` of GPS.
const GPS: u8 = 0;
/// `sigId` of L1 C/A, and of both parts of L2C.
const L1: u8 = 0;
const L2: [u8; 2] = [3, 4];

/// One satellite; on L1 and L2 what was observed wholly.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Observed {
    pub(crate) satellite: u8,
    /// m
    pub(crate) code: [Option<f64>; 2],
    /// Cycles.
    pub(crate) phase: [Option<f64>; 2],
    /// For how long the phases have been tracked, ms; [`Self::LONGEST_LOCK`] stands for longer, too.
    pub(crate) lock_ms: [u16; 2],
}

impl Observed {
    pub(crate) const LONGEST_LOCK: u16 = 64_500;
}

/// One epoch.
#[derive(Clone, Debug)]
pub(crate) struct Observations {
    /// By the receiver's clock.
    pub(crate) time: GpsTime,
    pub(crate) satellites: Vec<Observed, SATELLITES>,
}

impl Observations {
    fn of(message: &RxmRawxRef<'_>) -> Self {
        let time = calendar::week(message.week(), message.rcv_tow());
        let mut satellites: Vec<Observed, SATELLITES> = Vec::new();
        for signal in message.measurements() {
            // The driver's name of the signal: it was reserved before there were receivers of two carriers.
            let carrier = match (signal.gnss_id(), signal.reserved2()) {
                (GPS, L1) => 0,
                (GPS, signal) if L2.contains(&signal) => 1,
                _ => continue,
            };
            let number = signal.sv_id();
            let known = satellites.iter().position(|observed| observed.satellite == number);
            let index = known.unwrap_or_else(|| {
                // Satellites beyond all that there are have no place.
                let _ = satellites.push(Observed { satellite: number, ..Observed::default() });
                satellites.len().saturating_sub(1)
            });
            let Some(observed) = satellites.get_mut(index) else { continue };
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

    /// How many messages came damaged.
    pub(crate) const fn damaged(&self) -> u32 {
        self.damaged
    }

    /// Reads what has arrived up to the next epoch; waits for nothing.
    pub(crate) fn epoch(&mut self) -> Result<Option<Observations>, P::Error> {
        let mut byte = [0];
        while self.port.read_ready()? && self.port.read(&mut byte)? > 0 {
            let mut packets = self.parser.consume_ubx(&byte);
            while let Some(packet) = packets.next() {
                match packet {
                    Ok(UbxPacket::Proto27(PacketRef::RxmRawx(message))) => {
                        return Ok(Some(Observations::of(&message)));
                    }
                    Ok(_) => {}
                    Err(_) => self.damaged = self.damaged.saturating_add(1),
                }
            }
        }
        Ok(None)
    }
}
