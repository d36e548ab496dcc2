//! The output of a receiver of carrier phases and of a modem: the images' satellites, as messages UBX-RXM-RAWX, and as
//! lines of SP3 and RINEX clock files.

use kestirim_gnss_ppp::GpsTime;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_ppp_filter::SatelliteObservation;
use kestirim_scalar::Components;
use kestirim_tests::ppp::{CLOCK, Epochs, INTERVAL, SATELLITES, in_orbit, station};

/// The epoch in which a satellite's phase on L2 slips, the satellite, and the size of the slip in cycles.
pub(crate) const SLIP: usize = 2;
pub(crate) const SLIPPED: u8 = 4;
const CYCLES: f64 = 7.0;
/// The epoch in which a message and a line arrive damaged before they arrive whole.
pub(crate) const DAMAGED: usize = 3;
/// A satellite that is observed on L1 only, and one that is missing in the products.
pub(crate) const ONE_CARRIER: u8 = 30;
pub(crate) const UNKNOWN: u8 = 31;

/// The week of 25 June 2020, the modified Julian day on which it begins, and the second of the first epoch.
const WEEK: (u16, i32, f64) = (2111, 59_021, 388_770.0);
/// The number of samples of an orbit and the time between them, s; the middle one is at midday.
const ORBIT: (i32, f64) = (11, 900.0);

const RECEIVER: u16 = 0;
const MODEM: u16 = 1;
/// The number of bytes that arrive at once.
const PIECE: usize = 200;

/// The observations of one epoch.
#[derive(Debug)]
pub(crate) struct Observed {
    /// The second of the week, by the receiver's clock.
    second: f64,
    pub(crate) observations: Vec<SatelliteObservation<'static>>,
}

impl Observed {
    /// The time of the epoch, by the receiver's clock.
    pub(crate) fn time(&self) -> GpsTime {
        GpsTime::new(WEEK.1, self.second)
    }
}

/// The observations of all epochs.
pub(crate) fn observe() -> Vec<Observed> {
    let epoch = |(index, epoch): (usize, kestirim_tests::ppp::Epoch)| {
        let ahead = (CLOCK[0] + CLOCK[1] * index as f64) / SPEED_OF_LIGHT;
        let second = WEEK.2 + INTERVAL * index as f64 + ahead;
        let mut observations = epoch.observations.to_vec();
        for sighting in observations.iter_mut().filter(|sighting| sighting.satellite == SLIPPED) {
            sighting.lock_lost = index == SLIP;
            sighting.phase[1] += if index < SLIP { 0.0 } else { CYCLES };
        }
        Observed { second, observations }
    };
    Epochs::at(station()).enumerate().map(epoch).collect()
}

/// A measurement: satellite system, satellite, signal, code (m), phase (cycles) and time of lock (ms).
fn measurement([system, satellite, signal]: [u8; 3], code: f64, phase: f64, lock: u16) -> Vec<u8> {
    let mut bytes = Vec::new();
    bytes.extend(code.to_le_bytes());
    bytes.extend(phase.to_le_bytes());
    bytes.extend((-1_234.5_f32).to_le_bytes());
    bytes.extend([system, satellite, signal, 0]);
    bytes.extend(lock.to_le_bytes());
    // C/N0, three standard deviations; code, phase and half cycle are valid.
    bytes.extend([44, 4, 2, 3, 0b111, 0]);
    bytes
}

/// A message UBX-RXM-RAWX.
fn message(epoch: &Observed) -> Vec<u8> {
    let mut measurements = vec![
        measurement([2, 11, 0], 24e6, 126e6, 64_500),
        measurement([0, ONE_CARRIER, 0], 23e6, 121e6, 64_500),
    ];
    let unknown =
        SatelliteObservation { satellite: UNKNOWN, lock_lost: false, ..epoch.observations[0] };
    for sighting in epoch.observations.iter().chain([&unknown]) {
        let lock = if sighting.lock_lost { 5_000 } else { 64_500 };
        for (carrier, (signal, lock)) in [(0, 64_500), (3, lock)].into_iter().enumerate() {
            let (code, phase) = (sighting.code[carrier], sighting.phase[carrier]);
            measurements.push(measurement([0, sighting.satellite, signal], code, phase, lock));
        }
    }
    let mut payload = Vec::new();
    payload.extend(epoch.second.to_le_bytes());
    payload.extend(WEEK.0.to_le_bytes());
    payload.extend([18, measurements.len() as u8, 1, 1, 0, 0]);
    payload.extend(measurements.concat());
    let mut bytes = vec![0x02, 0x15];
    bytes.extend((payload.len() as u16).to_le_bytes());
    bytes.extend(payload);
    // Fletcher's checksum.
    let [a, b] = bytes.iter().fold([0_u8; 2], |[a, b], &byte| {
        let a = a.wrapping_add(byte);
        [a, b.wrapping_add(a)]
    });
    [vec![0xB5, 0x62], bytes, vec![a, b]].concat()
}

fn calendar(second_of_day: f64) -> [u32; 3] {
    let second = second_of_day.round() as u32;
    [second / 3600, second / 60 % 60, second % 60]
}

/// An SP3 file.
pub(crate) fn orbits() -> String {
    let header = "#cP2020  6 25 10 45  0.00000000      11 ORBIT IGS14 FIT  ME\n\
                  %c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n";
    let epoch = |sample| {
        let from_midday = ORBIT.1 * f64::from(sample - ORBIT.0 / 2);
        let [hour, minute, second] = calendar(43_200.0 + from_midday);
        let position = |satellite| {
            let state = in_orbit(satellite, INTERVAL + from_midday);
            let [x, y, z] = *(state.position / 1e3).as_array();
            format!("PG{:02}{x:14.6}{y:14.6}{z:14.6} 999999.999999\n", satellite + 1)
        };
        format!("*  2020  6 25 {hour:2} {minute:2} {second:2}.00000000\n")
            + &(0..SATELLITES).map(position).collect::<String>()
    };
    header.to_owned() + &(0..ORBIT.0).map(epoch).collect::<String>() + "EOF\n"
}

/// A RINEX clock file's header.
fn clock_header() -> String {
    let line = |content: &str, label: &str| format!("{content:60}{label}\n");
    line("     3.00           C                   G", "RINEX VERSION / TYPE")
        + &line("   GPS", "TIME SYSTEM ID")
        + &line("", "END OF HEADER")
}

/// A number in the format E19.12, whose exponent has two digits.
fn e19_12(value: f64) -> String {
    let text = format!("{value:.12e}");
    let (mantissa, exponent) = text.split_once('e').expect("an exponent");
    let exponent: i32 = exponent.parse().expect("a number");
    format!("{mantissa}E{exponent:+03}")
}

/// The clock records at an epoch; −1 is the one before the first.
fn clocks_at(epoch: i32) -> String {
    let elapsed = INTERVAL * f64::from(epoch);
    let [hour, minute, second] = calendar(43_200.0 - INTERVAL + elapsed);
    let record = |satellite| {
        let bias = e19_12(in_orbit(satellite, elapsed).clock);
        let number = satellite + 1;
        format!(
            "AS G{number:02}  2020 06 25 {hour:02} {minute:02} {second:02}.000000  1   {bias:>19}\n"
        )
    };
    (0..SATELLITES).map(record).collect()
}

/// A RINEX clock file for `epochs` epochs.
pub(crate) fn clocks(epochs: usize) -> String {
    clock_header() + &(-1..=epochs as i32).map(clocks_at).collect::<String>()
}

/// The output of both modules, as records of the board's tape.
pub(crate) fn encode(epochs: &[Observed]) -> Vec<u8> {
    let mut tape = Vec::new();
    let mut send = |elapsed_us: u32, port: u16, bytes: &[u8]| {
        for (number, piece) in bytes.chunks(PIECE).enumerate() {
            tape.extend((if number == 0 { elapsed_us } else { 0 }).to_le_bytes());
            tape.extend(port.to_le_bytes());
            tape.extend((piece.len() as u16).to_le_bytes());
            tape.extend(piece);
        }
    };
    send(0, MODEM, orbits().as_bytes());
    send(0, MODEM, clock_header().as_bytes());
    send(0, MODEM, clocks_at(-1).as_bytes());
    for (index, epoch) in epochs.iter().enumerate() {
        if index == DAMAGED {
            send(0, MODEM, b"AS G07  2020 06 2\xff 12\n");
            let mut damaged = message(epoch);
            damaged[100] ^= 1;
            send(0, RECEIVER, &damaged);
        }
        send(29_000_000, MODEM, clocks_at(index as i32).as_bytes());
        send(1_000_000, RECEIVER, b"$GNGGA,,,,,,0,,,,,,,,*78\r\n");
        send(0, RECEIVER, &message(epoch));
    }
    tape
}
