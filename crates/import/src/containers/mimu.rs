//! Packets of raw inertial data from an `OpenShoe` module (MIMU22BT, MIMU4444 and related ones, also sold by Inertial
//! Elements), as its scripts write them to a file.
//!
//! A packet consists of `0xAA`, its number, the length of what follows, a time in ticks of 64 MHz, six numbers for each
//! sensor, and the sum of all bytes before, all most significant byte first (`log_mimu_data.m` and `mimu_parse_bin.cpp`
//! of the `OpenShoe` Matlab scripts; MIMU22BL Integration Guide 1.12, "Raw IMU data").
//!
//! Accelerations are in 1/2048 g and rates in 1/16.4 °/s, as in both scripts. The sensors of a module differ in
//! orientation, so one is selected and reported, and none are averaged. The time wraps after 67 s; a longer gap goes
//! unnoticed.

use super::Decoded;
use super::bytes::Bytes;
use super::gather::Losses;
use super::numbered::Numbered;
use super::walk::{Framing, Step, Walk};
use crate::error::Error;
use crate::formats::{Description, Format};
use crate::options::Options;
use crate::part::Part;

pub(crate) const MIMU: Description = Description {
    format: Format::OpenShoeMimu,
    name: "openshoe-mimu",
    title: "OpenShoe packets",
    is_it: None,
    time: &[(TIME, "s")],
    sensors: ["AccX", "AccY", "AccZ", "GyrX", "GyrY", "GyrZ"],
    acceleration: "g",
    rate: "deg/s",
    is_a_guess: false,
};

const TIME: &str = "Time";
const TICKS_PER_SECOND: f64 = 64e6;
const COUNTS_PER_G: f64 = 2048.0;
const COUNTS_PER_DEGREE_PER_SECOND: f64 = 16.4;

const HEAD: u8 = 0xaa;
/// The size of the first byte, the packet's number and the length, bytes.
const HEADER: usize = 4;
/// The size of the time before the sensors' numbers, bytes.
const STAMP: usize = 4;
/// The size of one sensor's six numbers of two bytes, and that of the checksum, bytes.
const SENSOR: usize = 12;
const SUM: usize = 2;
/// The length of the longest packet, bytes: a file may begin in the middle of one.
const LONGEST: usize = HEADER + u8::MAX as usize + SUM;

/// Whether two consecutive packets are found at the beginning of a file.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    (0..LONGEST.min(bytes.len())).any(|from| {
        let rest = bytes.get(from..).unwrap_or_default();
        let next = packet(rest).and_then(|length| rest.get(length..));
        next.is_some_and(|next| packet(next).is_some())
    })
}

/// The length of the complete packet that these bytes begin with, if its checksum is right.
fn packet(bytes: &[u8]) -> Option<usize> {
    let length = announced(bytes)?;
    let (body, sum) = bytes.get(..length)?.split_last_chunk::<SUM>()?;
    let found = body.iter().fold(0_u16, |sum, &byte| sum.wrapping_add(u16::from(byte)));
    (found == u16::from_be_bytes(*sum)).then_some(length)
}

/// The length that a packet of raw data announces.
fn announced(bytes: &[u8]) -> Option<usize> {
    let [HEAD, _, _, payload, ..] = bytes else { return None };
    let payload = usize::from(*payload);
    let numbers = payload.checked_sub(STAMP)?;
    (numbers > 0 && numbers % SENSOR == 0).then_some(HEADER + payload + SUM)
}

/// Reads all packets.
///
/// # Errors
/// If there is no sensor of the number that `--topic` says.
pub(super) fn read(bytes: &[u8], options: &Options) -> Result<Decoded, Error> {
    let mut sensors = Numbered::new(options)?;
    let mut losses = Losses::default();
    let mut clock = Clock::default();
    let mut walk = Walk::new(bytes, 0);
    while let Some(step) = walk.next(&Packets) {
        match step {
            Step::Record(packet) => {
                losses.read += packet.len();
                let _ = take(packet, walk.number, &mut clock, &mut sensors);
            }
            Step::Lost(fault, lost) => losses.add(fault, walk.number, lost.len()),
        }
    }
    let mut notes: Vec<_> = sensors.note("IMU")?.into_iter().collect();
    if clock.missing > 0 {
        notes.push(format!("packets that are missing by their numbers: {}", clock.missing));
    }
    let table = sensors.stream.table(&MIMU, TIME, &losses, Part::Record);
    Ok(Decoded { table, notes })
}

/// Takes the samples of all sensors in a packet.
fn take(packet: &[u8], record: usize, clock: &mut Clock, sensors: &mut Numbered) -> Option<()> {
    let mut bytes = Bytes(packet);
    let _ = bytes.u8()?;
    let number = u16::from_be_bytes(bytes.take()?);
    let count = usize::from(bytes.u8()?).checked_sub(STAMP)? / SENSOR;
    let time = clock.seconds(number, u32::from_be_bytes(bytes.take()?));
    for sensor in 0..u32::try_from(count).ok()? {
        let mut row = [time; 7];
        for (place, value) in row.iter_mut().skip(1).enumerate() {
            let scale = if place < 3 { COUNTS_PER_G } else { COUNTS_PER_DEGREE_PER_SECOND };
            *value = f64::from(i16::from_be_bytes(bytes.take()?)) / scale;
        }
        sensors.push(sensor, record, row);
    }
    Some(())
}

/// The module's clock and packet counter, both of which wrap.
#[derive(Debug, Default)]
struct Clock {
    last: Option<(u16, u32)>,
    ticks: u64,
    missing: u64,
}

impl Clock {
    /// The time of a packet, s since the first one.
    fn seconds(&mut self, number: u16, stamp: u32) -> f64 {
        if let Some((last_number, last_stamp)) = self.last {
            self.missing += u64::from(number.wrapping_sub(last_number).saturating_sub(1));
            self.ticks += u64::from(stamp.wrapping_sub(last_stamp));
        }
        self.last = Some((number, stamp));
        self.ticks as f64 / TICKS_PER_SECOND
    }
}

/// The framing of packets.
struct Packets;

impl Framing for Packets {
    fn length(&self, bytes: &[u8], _: bool) -> Option<usize> {
        if bytes.len() < HEADER {
            return bytes.starts_with(&[HEAD]).then_some(HEADER);
        }
        let length = announced(bytes)?;
        if length > bytes.len() { Some(length) } else { packet(bytes) }
    }

    fn follows(&self, bytes: &[u8]) -> bool {
        bytes.starts_with(&[HEAD])
    }

    fn candidate(&self, bytes: &[u8]) -> Option<usize> {
        memchr::memchr(HEAD, bytes.get(1..)?).map(|at| at + 1)
    }
}
