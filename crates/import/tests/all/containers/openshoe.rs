//! Logs of `OpenShoe`: texts, and packets of its modules.

use std::fmt::Write as _;

use kestirim_import::{Options, STANDARD_GRAVITY, inertial};

use super::{
    SEEDS, assert_same, plain, read, read_topic, refusal, short, survives, survives_much, told,
};
use crate::walk;

const HEADER: &str = "\nInertial data.\n\n\
    Header:      a_x [g]:      a_y [g]:      a_z [g]: ar_x [rad/s]: ar_y [rad/s]: ar_z [rad/s]:      Counter: Checksum:     \
    Nr:   Filtered ts[s]: Unfiltered ts[s]:      Pred. ts[s]: Freq. [Hz]:      m_x [G]:      m_y [G]:      m_z [G]:\n";
/// Ticks of the counter in one second.
const COUNTER: f64 = 19_660_800.0;

/// A text of the first prototype, whose magnetometer is missing now and then.
fn named(rows: &[[f64; 7]]) -> String {
    let mut text = HEADER.to_owned();
    for (i, [t, ax, ay, az, gx, gy, gz]) in rows.iter().enumerate() {
        let [ax, ay, az] = [ax, ay, az].map(|force| force / STANDARD_GRAVITY);
        let filtered = t + 1_274_436_938.125_973;
        let field = if i % 16 == 12 { "+nan" } else { "-0.12764764" };
        let _ = writeln!(
            text,
            "   0xcb   {ax:+.12}   {ay:+.12}   {az:+.12}   {gx:+.12}   {gy:+.12}   {gz:+.12} {:12.0}    0x{:x}  {:6} \
             {filtered:.6} {:.6} {:.6}  250.000000   {field}   {field}   {field} ",
            t * COUNTER % 13_290_906.0,
            0x1000 + i % 2500,
            i + 1,
            filtered + 0.002 * (i % 3) as f64,
            filtered + 0.004,
        );
    }
    text
}

/// A text of the module, as its script writes it.
fn counted(rows: &[[f64; 7]]) -> String {
    let mut text = "dummy_header ".repeat(32) + "\r\n";
    for [_, ax, ay, az, gx, gy, gz] in rows {
        let _ = write!(
            text,
            "0  {ax:.9} {ay:.9} {az:.9}  {gx:.9} {gy:.9} {gz:.9}  0 0  0  0.000000 0.000000 0.000000  0.000000  \
             0.000000 0.000000 0.000000\r\n"
        );
    }
    text
}

/// The counts that a sensor of the module gives for a row.
fn counts([_, ax, ay, az, gx, gy, gz]: [f64; 7]) -> [i16; 6] {
    let [ax, ay, az] = [ax, ay, az].map(|force| force / STANDARD_GRAVITY * 2048.0);
    let [gx, gy, gz] = [gx, gy, gz].map(|rate| rate.to_degrees() * 16.4);
    [ax, ay, az, gx, gy, gz].map(|value| value.round() as i16)
}

/// The row that counts represent.
fn of_counts(t: f64, [ax, ay, az, gx, gy, gz]: [i16; 6]) -> [f64; 7] {
    let [ax, ay, az] = [ax, ay, az].map(|count| f64::from(count) / 2048.0 * STANDARD_GRAVITY);
    let [gx, gy, gz] = [gx, gy, gz].map(|count| (f64::from(count) / 16.4).to_radians());
    [t, ax, ay, az, gx, gy, gz]
}

/// A packet of four sensors, the last two of which are rotated.
fn packet(number: usize, row: [f64; 7]) -> Vec<u8> {
    let stamp = (row[0] * 64e6).round() as u64 + 4_000_000_000;
    let [ax, ay, az, gx, gy, gz] = counts(row);
    let mut packet = vec![0xaa];
    packet.extend((number as u16).to_be_bytes());
    packet.push(4 + 4 * 12);
    packet.extend((stamp as u32).to_be_bytes());
    for sensor in 0..4 {
        let turned = [ay, -ax, az, gy, -gx, gz];
        let values = if sensor < 2 { [ax, ay, az, gx, gy, gz] } else { turned };
        packet.extend(values.map(i16::to_be_bytes).concat());
    }
    let sum = packet.iter().map(|&byte| u16::from(byte)).sum::<u16>();
    packet.extend(sum.to_be_bytes());
    packet
}

/// One packet for each row, numbered from `first`.
fn packets(rows: &[[f64; 7]], first: usize) -> Vec<Vec<u8>> {
    rows.iter().enumerate().map(|(i, &row)| packet(first + i, row)).collect()
}

fn quantised(rows: &[[f64; 7]]) -> Vec<[f64; 7]> {
    rows.iter().map(|&row| of_counts(row[0], counts(row))).collect()
}

#[test]
fn a_text_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let log = read(named(&rows).as_bytes()).unwrap();
    assert_same(&log, &plain(&rows), 1e-10);
    assert_eq!(
        told(&log),
        "time in s, acceleration in g, angular rate in rad/s, columns 11, 2, 3, 4, 5, 6, 7: OpenShoe text; \
         blanks: from the data"
    );
    assert_eq!(log.damage.sentences(), [""; 0]);
}

#[test]
fn a_text_without_times_asks_for_the_rate() {
    let rows = walk::rows(super::STRIDES);
    let text = counted(&rows);
    let sentence = refusal(text.as_bytes());
    assert!(sentence.contains("only counted") && sentence.contains("--units t="), "{sentence}");
    let options = Options { units: "t=100Hz".parse().unwrap(), ..Options::default() };
    let log = inertial::read(text.as_bytes(), &options).unwrap();
    assert_same(&log, &plain(&rows), 1e-8);
}

#[test]
fn packets_are_the_walk() {
    // Both the clock and the packet counter wrap.
    let rows = walk::rows(super::STRIDES);
    let bytes = packets(&rows, 65_000).concat();
    let log = read(&bytes).unwrap();
    assert_same(&log, &plain(&quantised(&rows)), 1e-12);
    assert_eq!(
        told(&log),
        "time in s, acceleration in g, angular rate in °/s: OpenShoe packets; \
         IMU 0 of 4: OpenShoe packets"
    );
    let turned: Vec<_> = quantised(&rows)
        .iter()
        .map(|&[t, ax, ay, az, gx, gy, gz]| [t, ay, -ax, az, gy, -gx, gz])
        .collect();
    assert_same(&read_topic(&bytes, "3").unwrap(), &plain(&turned), 1e-12);
    let error = read_topic(&bytes, "4").unwrap_err().to_string();
    assert_eq!(error, "expected IMU 4, found IMU 0, 1, 2, 3 (--topic)");
}

#[test]
fn damaged_packets_are_skipped_and_counted() {
    let rows = walk::rows(super::STRIDES);
    let mut packets = packets(&rows, 0);
    packets[300][20] ^= 1;
    drop(packets.remove(500));
    let bytes = packets.concat();
    // The end of a packet before the first whole one, and half of the last one.
    let log = read(&bytes[30..bytes.len() - 20]).unwrap();
    assert_eq!(log.samples.len(), rows.len() - 4);
    assert_eq!(
        log.damage.sentences(),
        [
            "2 records torn (unreadable) were skipped: records 1, 301".to_owned(),
            format!("1 record cut off was skipped: record {}", rows.len() - 1),
        ]
    );
    assert!(told(&log).contains("packets that are missing by their numbers: 2"), "{}", told(&log));
}

#[test]
fn damaged_logs_do_no_harm() {
    survives(named(&short()).as_bytes(), 0..SEEDS);
    survives(&packets(&short(), 0).concat(), 0..SEEDS);
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_texts() {
    survives_much(named(&short()).as_bytes());
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_packets() {
    survives_much(&packets(&short(), 0).concat());
}
