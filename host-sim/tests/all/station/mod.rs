//! A synthetic receiver under a synthetic sky, as files.
//!
//! Circular orbits, no ionosphere, and no noise but the rounding of the formats: observations are as the model
//! predicts, so that positions are accurate to a centimetre from the first epoch with phases.

use std::f64::consts::TAU;
use std::fmt::Write;

use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Carriers, GpsTime, Receiver, SatelliteState, Site, WAVELENGTH};
use nalgebra::{Rotation3, Vector3};

/// The modified Julian date of 25 June 2020.
const DAY: i32 = 59_025;
const LEAP_SECONDS: f64 = 18.0;
const EARTH_RATE: f64 = 7.292_115e-5;
const RADIUS: f64 = 26_560e3;
const PERIOD: f64 = 43_077.0;
/// The interval between epochs (s).
pub(crate) const INTERVAL: f64 = 30.0;
/// The time of the first epoch (s after midnight).
pub(crate) const BEGIN: f64 = 7200.0;
/// The position of the marker (ECEF, m).
pub(crate) const MARKER: [f64; 3] = [3_582_104.76, 532_590.18, 5_232_755.15];

/// The position of the centre of mass of a satellite in one of six planes with five places each, and its velocity.
fn orbit(prn: u8, second: f64) -> (Vector3<f64>, Vector3<f64>) {
    let (plane, place) = (f64::from(prn % 6), f64::from(prn / 6));
    let rate = TAU / PERIOD;
    let angle = rate * second + TAU * (place / 5.0 + plane / 30.0);
    let tilt = Rotation3::from_axis_angle(&Vector3::x_axis(), 55_f64.to_radians());
    let node = TAU * plane / 6.0 - EARTH_RATE * second;
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), node) * tilt;
    let (sin, cos) = angle.sin_cos();
    (
        turn * Vector3::new(RADIUS * cos, RADIUS * sin, 0.0),
        turn * Vector3::new(-RADIUS * rate * sin, RADIUS * rate * cos, 0.0),
    )
}

fn bias(prn: u8) -> f64 {
    1e-5 * f64::from(prn) - 1e-4
}

fn clock_time(second: f64) -> (u32, u32, f64) {
    let whole = second as u32;
    (whole / 3600, whole / 60 % 60, second - f64::from(whole / 60 * 60))
}

/// An SP3 file with orbits and clocks every quarter of an hour from midnight to a given time.
pub(crate) fn sp3(until: f64, satellites: &[u8]) -> String {
    let mut text = String::from("#dP2020  6 25  0  0  0.00000000      96 ORBIT IGS14 FIT TEST\n");
    let mut second = 0.0;
    while second <= until {
        let (hour, minute, rest) = clock_time(second);
        writeln!(text, "*  2020  6 25 {hour:2} {minute:2} {rest:11.8}").unwrap();
        for &prn in satellites {
            let [x, y, z] = <[f64; 3]>::from(orbit(prn, second).0 / 1e3);
            let clock = 1e6 * bias(prn);
            writeln!(text, "PG{prn:02}{x:14.6}{y:14.6}{z:14.6}{clock:14.6}").unwrap();
        }
        second += 900.0;
    }
    text + "EOF\n"
}

/// A line of a header: the text in 60 columns, followed by its label.
fn line(text: &str, label: &str) -> String {
    format!("{text:<60}{label:<20}\n")
}

/// An ANTEX file of antennas whose phase centres coincide with their reference points.
pub(crate) fn antex(satellites: &[u8]) -> String {
    let mut text =
        line("     1.4            M", "ANTEX VERSION / SYST") + &line("", "END OF HEADER");
    let satellites = satellites.iter().map(|prn| format!("{:<20}G{prn:02}", "BLOCK IIF"));
    for name in satellites.chain(["TESTANTENNA     NONE".to_owned()]) {
        text += &line("", "START OF ANTENNA");
        text += &line(&name, "TYPE / SERIAL NO");
        text += &line("     0.0", "DAZI");
        text += &line("     0.0  90.0  90.0", "ZEN1 / ZEN2 / DZEN");
        for frequency in ["   G01", "   G02"] {
            text += &line(frequency, "START OF FREQUENCY");
            text += &line("      0.00      0.00      0.00", "NORTH / EAST / UP");
            text += "   NOAZI    0.00    0.00\n";
            text += &line(frequency, "END OF FREQUENCY");
        }
        text += &line("", "END OF ANTENNA");
    }
    text
}

/// A fault of an observation; none omits the satellite.
#[derive(Clone, Copy)]
pub(crate) struct Fault {
    /// The offset of both codes (m).
    pub(crate) code: f64,
    /// The offset of both phases (m).
    pub(crate) phase: f64,
    /// Whether the receiver reports a loss of lock.
    pub(crate) lock_lost: bool,
    /// Whether the L2 observations are missing.
    pub(crate) incomplete: bool,
}

impl Fault {
    pub(crate) const NONE: Self =
        Self { code: 0.0, phase: 0.0, lock_lost: false, incomplete: false };
}

/// A RINEX file with this number of epochs; `fault` is called for each epoch's number and satellite.
pub(crate) fn rinex(epochs: u32, fault: impl Fn(u32, u8) -> Option<Fault>) -> String {
    let [x, y, z] = MARKER;
    let mut text = [
        line("     3.04           OBSERVATION DATA    G", "RINEX VERSION / TYPE"),
        line("TEST", "MARKER NAME"),
        line(&format!("{:20}TESTANTENNA     NONE", ""), "ANT # / TYPE"),
        line(&format!("{x:14.4}{y:14.4}{z:14.4}"), "APPROX POSITION XYZ"),
        line("        0.0000        0.0000        0.0000", "ANTENNA: DELTA H/E/N"),
        line("G    4 C1W L1W C2W L2W", "SYS / # / OBS TYPES"),
        line("  2020     6    25     2     0    0.0000000     GPS", "TIME OF FIRST OBS"),
        line("", "END OF HEADER"),
    ]
    .concat();
    let receiver = Receiver { ut1_minus_gps: -LEAP_SECONDS, ..Receiver::default() };
    let marker = Vector3::from(MARKER);
    let mut wind_up = [None; 33];
    for epoch in 0..epochs {
        let second = BEGIN + INTERVAL * f64::from(epoch);
        let site = Site::new(&receiver, &marker, GpsTime::new(DAY, second));
        let mut records = Vec::new();
        for prn in satellites() {
            let mut travel = 0.07;
            let expected = loop {
                let (position, velocity) = orbit(prn, second - travel);
                let clock = bias(prn);
                let state = SatelliteState {
                    position,
                    velocity,
                    clock,
                    clock_interval: 0.0,
                    clock_distance: 0.0,
                    accuracy: 0.0,
                };
                let expected = site
                    .expect(&state, Carriers::L1L2, None, wind_up[usize::from(prn)])
                    .expect("finite numbers");
                let again = expected.range / SPEED_OF_LIGHT + clock;
                if (again - travel).abs() < 1e-12 {
                    break expected;
                }
                travel = again;
            };
            wind_up[usize::from(prn)] = Some(expected.wind_up_cycles);
            let (true, Some(fault)) = (expected.direction.elevation > 0.05, fault(epoch, prn))
            else {
                continue;
            };
            let code = expected.range + fault.code;
            let phase = WAVELENGTH.map(|wavelength| {
                (expected.range + fault.phase) / wavelength + expected.wind_up_cycles + 1000.0
            });
            let lock = if fault.lock_lost { '1' } else { ' ' };
            let [first, second] = phase;
            let mut record = format!("G{prn:02}{code:14.3}  {first:14.3}{lock} ");
            if !fault.incomplete {
                write!(record, "{code:14.3}  {second:14.3}{lock} ").unwrap();
            }
            records.push(record + "\n");
        }
        let (hour, minute, rest) = clock_time(second);
        let count = records.len();
        writeln!(text, "> 2020 06 25 {hour:02} {minute:02}{rest:11.7}  0{count:3}").unwrap();
        text += &records.concat();
    }
    text
}

/// The numbers of all thirty satellites.
pub(crate) fn satellites() -> Vec<u8> {
    (1..=30).collect()
}
