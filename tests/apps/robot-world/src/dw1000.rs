//! Simulates the DW1000's registers that ranging needs, after its user manual.

use robot_app::TAG;

use crate::anchors::{Anchors, Frame};
use crate::world::ticks;

// Register files (user manual, 7.1).
const PANADR: u8 = 0x03;
const SYS_CFG: u8 = 0x04;
const SYS_TIME: u8 = 0x06;
const TX_FCTRL: u8 = 0x08;
const TX_BUFFER: u8 = 0x09;
const SYS_CTRL: u8 = 0x0d;
const SYS_STATUS: u8 = 0x0f;
const RX_FINFO: u8 = 0x10;
const RX_BUFFER: u8 = 0x11;
const RX_TIME: u8 = 0x15;
const TX_TIME: u8 = 0x17;
const TX_ANTD: u8 = 0x18;
const CHAN_CTRL: u8 = 0x1f;
const OTP_IF: u8 = 0x2d;
const LDE_CTRL: u8 = 0x2e;
const DIG_DIAG: u8 = 0x2f;
const PMSC: u8 = 0x36;
/// Sub-addresses.
const OTP_CTRL: u16 = 0x06;
const LDE_RXANTD: u16 = 0x1804;

// Bits of SYS_CTRL.
const TXSTRT: u32 = 1 << 1;
const TRXOFF: u32 = 1 << 6;
const RXENAB: u32 = 1 << 8;
// Bits of SYS_STATUS.
const SENT: u32 = 0xf << 4; // TXFRB, TXPRS, TXPHS, TXFRS
const RECEIVED: u32 = 0b110_1111 << 8; // RXPRD, RXSFDD, LDEDONE, RXPHD; RXDFR, RXFCG
const LDEDONE: u32 = 1 << 10;
/// The bit of `SYS_CFG` that drops frames for others.
const FFEN: u32 = 1;
/// The value of `CHAN_CTRL` for channel 5 both ways, PRF 16 MHz, preamble code 4 both ways.
const ANCHORS_CHANNEL: u32 = 5 | 5 << 4 | 1 << 18 | 4 << 22 | 4 << 27;
/// The value of `TX_FCTRL` for 6.8 Mbit/s, PRF 16 MHz, 128 symbols, and the mask of these fields.
const ANCHORS_RATE: u32 = 2 << 13 | 1 << 16 | 1 << 18 | 1 << 20;
const RATE: u32 = 0b11 << 13 | 0b1111 << 16 | 0b11 << 20;

/// The clock setting with which the LDE's microcode can be loaded, after the manual's table 4.
const LDE_CLOCK: u32 = 0x0301;
const LDELOAD: u16 = 1 << 15;

/// The time from the start of a transmission to the mark that is timestamped, µs: a preamble of 128 symbols and the
/// start of frame. A receiver has to be on for as long before the mark.
const PREAMBLE_US: u64 = 140;
/// The time from the mark to the end of a frame, µs.
const FRAME_US: u64 = 60;

/// A frame on its way to the chip.
#[derive(Debug)]
struct Coming {
    frame: Frame,
    /// The time at which its mark is at the antenna.
    arrival: u64,
}

/// The chip.
#[derive(Debug)]
pub(crate) struct Dw1000 {
    /// One row for each register file; rows above 0x2f, which the chip does not have, are the pages of the LDE.
    registers: [[u8; 128]; 64],
    lde_loaded: bool,
    /// The time since when it has been listening.
    listens: Option<u64>,
    /// The time at which the current transmission ends.
    sent: Option<u64>,
    coming: Option<Coming>,
}

impl Dw1000 {
    pub(crate) const fn new() -> Self {
        Self {
            registers: [[0; 128]; 64],
            lde_loaded: false,
            listens: None,
            sent: None,
            coming: None,
        }
    }

    /// Reads registers.
    pub(crate) fn read(&mut self, file: u8, sub: u16, bytes: &mut [u8], now: u64) {
        match file {
            SYS_TIME => self.set(SYS_TIME, 0, &stamp(now)),
            SYS_STATUS => self.look(now),
            _ => {}
        }
        let (row, column) = place(file, sub);
        let register =
            self.registers.get(row).and_then(|row| row.get(column..)).unwrap_or_default();
        for (byte, value) in bytes.iter_mut().zip(register) {
            *byte = *value;
        }
    }

    /// Writes registers.
    pub(crate) fn write(
        &mut self,
        file: u8,
        sub: u16,
        bytes: &[u8],
        now: u64,
        anchors: &mut Anchors,
    ) {
        match file {
            SYS_STATUS => {
                let mut status = self.get(SYS_STATUS, 0);
                for (index, byte) in bytes.iter().enumerate().take(4) {
                    status &= !(u32::from(*byte) << (8 * index));
                }
                return self.set(SYS_STATUS, 0, &status.to_le_bytes());
            }
            SYS_CTRL => return self.control(word(bytes), now, anchors),
            // The event counters; the commands need not be stored. Nothing has gone wrong so far.
            DIG_DIAG => return,
            OTP_IF if sub == OTP_CTRL && word(bytes) as u16 & LDELOAD != 0 => {
                self.lde_loaded |= self.get(PMSC, 0) & 0x0fff == LDE_CLOCK;
            }
            _ => {}
        }
        self.set(file, sub, bytes);
    }

    fn control(&mut self, command: u32, now: u64, anchors: &mut Anchors) {
        if command & TRXOFF != 0 {
            self.listens = None;
            self.sent = None;
        }
        if command & TXSTRT != 0 {
            self.send(now, anchors);
        }
        if command & RXENAB != 0 {
            self.listens = Some(now);
        }
    }

    fn send(&mut self, now: u64, anchors: &mut Anchors) {
        // The mark leaves at a multiple of 512 ticks.
        let raw = (now + ticks(PREAMBLE_US)) & !0x1ff;
        let delay = u64::from(self.get(TX_ANTD, 0) as u16);
        self.set(TX_TIME, 0, &stamp(raw + delay));
        self.set(TX_TIME, 5, &stamp(raw));
        self.sent = Some(raw + ticks(FRAME_US));
        let settings = self.get(TX_FCTRL, 0);
        let mut frame = Frame { bytes: [0; 127], length: (settings & 0x7f) as usize };
        self.read(TX_BUFFER, 0, &mut frame.bytes, now);
        let understood =
            settings & RATE == ANCHORS_RATE && self.get(CHAN_CTRL, 0) == ANCHORS_CHANNEL;
        let departure = raw + u64::from(TAG.transmit_delay);
        self.coming = None;
        if understood && let Some((frame, arrival)) = anchors.hear(&frame, departure) {
            self.coming = Some(Coming { frame, arrival });
        }
    }

    /// Updates the status register.
    fn look(&mut self, now: u64) {
        let mut status = self.get(SYS_STATUS, 0);
        if self.sent.is_some_and(|sent| sent <= now) {
            self.sent = None;
            status |= SENT;
        }
        if let Some(Coming { frame, arrival }) = &self.coming
            && arrival + ticks(FRAME_US) <= now
        {
            let (frame, arrival) = (*frame, *arrival);
            self.coming = None;
            let heard = self.listens.is_some_and(|since| since + ticks(PREAMBLE_US) <= arrival);
            if heard && self.is_ours(&frame) {
                status |= RECEIVED;
                if !self.lde_loaded {
                    status &= !LDEDONE;
                }
                self.listens = None;
                self.take(&frame, arrival);
            }
        }
        self.set(SYS_STATUS, 0, &status.to_le_bytes());
    }

    fn take(&mut self, frame: &Frame, arrival: u64) {
        let raw = arrival + u64::from(TAG.receive_delay);
        let delay = u64::from(self.get(LDE_CTRL, LDE_RXANTD) as u16);
        self.set(RX_TIME, 0, &stamp(raw.wrapping_sub(delay)));
        self.set(RX_FINFO, 0, &(frame.length as u32).to_le_bytes());
        self.set(RX_BUFFER, 0, &frame.bytes);
    }

    /// Whether the frame filter accepts a frame: its receiver is this chip.
    fn is_ours(&self, frame: &Frame) -> bool {
        let [address_low, address, network_low, network] = self.get(PANADR, 0).to_le_bytes();
        let receiver = frame.bytes.get(3..7);
        self.get(SYS_CFG, 0) & FFEN == 0
            || receiver == Some(&[network_low, network, address_low, address])
    }

    fn get(&self, file: u8, sub: u16) -> u32 {
        let (row, column) = place(file, sub);
        word(self.registers.get(row).and_then(|row| row.get(column..)).unwrap_or_default())
    }

    fn set(&mut self, file: u8, sub: u16, bytes: &[u8]) {
        let (row, column) = place(file, sub);
        let register = self.registers.get_mut(row).and_then(|row| row.get_mut(column..));
        for (value, byte) in register.unwrap_or_default().iter_mut().zip(bytes) {
            *value = *byte;
        }
    }
}

/// The row and column of a register.
fn place(file: u8, sub: u16) -> (usize, usize) {
    let row = if file == LDE_CTRL { 0x30 + (sub >> 11) } else { u16::from(file) };
    (usize::from(row), usize::from(sub & 0x7f))
}

fn word(bytes: &[u8]) -> u32 {
    bytes.iter().take(4).rev().fold(0, |word, byte| word << 8 | u32::from(*byte))
}

fn stamp(now: u64) -> [u8; 5] {
    let [a, b, c, d, e, ..] = now.to_le_bytes();
    [a, b, c, d, e]
}
