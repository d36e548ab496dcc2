//! Logs of `ArduPilot`.

use std::fmt::Write as _;

use super::{
    SEEDS, SINGLE, assert_same, plain, read, read_topic, refusal, short, survives, survives_much,
    told,
};
use crate::walk;

pub(super) const LABELS: &str = "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz";
pub(super) const FORMAT: &str = "QBffffffIIfBBHH";

/// A message `FMT`.
pub(super) fn fmt(kind: u8, name: &str, format: &str, labels: &str, length: u8) -> Vec<u8> {
    let mut message = vec![0xa3, 0x95, 128, kind, length];
    for (text, size) in [(name, 4), (format, 16), (labels, 64)] {
        let mut field = text.as_bytes().to_vec();
        field.resize(size, 0);
        message.extend(field);
    }
    message
}

/// A message of an inertial sensor, as recent versions write it.
pub(super) fn imu(number: u8, [t, ax, ay, az, gx, gy, gz]: [f64; 7]) -> Vec<u8> {
    let mut message = vec![0xa3, 0x95, 130];
    message.extend(((t * 1e6).round() as u64 + 5_000_000).to_le_bytes());
    message.push(number);
    for value in [gx, gy, gz, ax, ay, az] {
        message.extend((value as f32).to_le_bytes());
    }
    message.extend([0; 8]);
    message.extend(31.5_f32.to_le_bytes());
    message.extend([1, 1]);
    message.extend([0xe8, 3, 0xe8, 3]);
    message
}

/// A log with three sensors, the last two of which are rotated, and other messages.
pub(super) fn log(rows: &[[f64; 7]]) -> Vec<u8> {
    let mut log = fmt(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", 89);
    log.extend(fmt(130, "IMU", FORMAT, LABELS, 54));
    log.extend(fmt(131, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", 14));
    for (i, &row) in rows.iter().enumerate() {
        for number in 0..3 {
            let [t, ax, ay, az, gx, gy, gz] = row;
            let other = [t, ay, -ax, az, gy, -gx, gz];
            log.extend(imu(number, if number == 0 { row } else { other }));
        }
        if i % 50 == 0 {
            log.extend([0xa3, 0x95, 131, 0, 0, 0, 0, 0, 0, 0, 0, 4, 4, 1]);
        }
    }
    log
}

#[test]
fn a_binary_log_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let log = read(&log(&rows)).unwrap();
    assert_same(&log, &plain(&rows), SINGLE);
    assert_eq!(
        told(&log),
        "time in µs, acceleration in m/s², angular rate in rad/s: ArduPilot; IMU 0 of 3: ArduPilot"
    );
    assert_eq!(log.damage.sentences(), [""; 0]);
    assert_eq!(log.samples[0].time_us, 5_000_000);
}

#[test]
fn another_sensor_is_a_topic() {
    let rows = walk::rows(super::STRIDES);
    let turned: Vec<_> =
        rows.iter().map(|&[t, ax, ay, az, gx, gy, gz]| [t, ay, -ax, az, gy, -gx, gz]).collect();
    let bytes = log(&rows);
    assert_same(&read_topic(&bytes, "2").unwrap(), &plain(&turned), SINGLE);
    let refused = |topic| read_topic(&bytes, topic).unwrap_err().to_string();
    assert_eq!(refused("7"), "expected IMU 7, found IMU 0, 1, 2 (--topic)");
    assert_eq!(refused("x"), "expected a sensor's number for --topic, found \"x\"");
}

#[test]
fn logs_of_old_programs_are_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let mut old = fmt(130, "IMU", "Iffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ", 31);
    let mut oldest = fmt(130, "IMU", "ffffff", "GyrX,GyrY,GyrZ,AccX,AccY,AccZ", 27);
    for &[t, ax, ay, az, gx, gy, gz] in &rows {
        let values = [gx, gy, gz, ax, ay, az].map(|value| (value as f32).to_le_bytes()).concat();
        old.extend([0xa3, 0x95, 130]);
        old.extend(((t * 1e3).round() as u32).to_le_bytes());
        old.extend(&values);
        oldest.extend([0xa3, 0x95, 130]);
        oldest.extend(&values);
    }
    assert_same(&read(&old).unwrap(), &plain(&rows), SINGLE);
    assert!(refusal(&oldest).contains("--units t=100Hz"), "{}", refusal(&oldest));
    let units = "t=100Hz".parse().unwrap();
    let options = kestirim_import::Options { units, ..Default::default() };
    let log = kestirim_import::inertial::read(&oldest, &options).unwrap();
    assert_same(&log, &plain(&rows), SINGLE);
}

/// A log as a ground station writes it.
fn text(rows: &[[f64; 7]]) -> String {
    let mut text = format!(
        "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 130, 54, IMU, {FORMAT}, {LABELS}\n\
         FMT, 131, 14, MODE, QMBB, TimeUS,Mode,ModeNum,Rsn\nMODE, 4000000, Stabilize, 0, 1\n"
    );
    for [t, ax, ay, az, gx, gy, gz] in rows {
        let t = (t * 1e6).round() as u64;
        let _ = writeln!(
            text,
            "IMU, {t}, 0, {gx}, {gy}, {gz}, {ax}, {ay}, {az}, 0, 0, 31.5, 1, 1, 1000, 1000"
        );
    }
    text
}

#[test]
fn a_log_of_text_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let text = text(&rows);
    let log = read(text.as_bytes()).unwrap();
    assert_same(&log, &plain(&rows), 0.0);
    assert_eq!(told(&log), "time in µs, acceleration in m/s², angular rate in rad/s: ArduPilot");
    let mut lines: Vec<_> = text.lines().collect();
    lines[300] = "IMU, 17, 0, 1.5";
    lines.insert(600, "§%&/ rubbish");
    let cut = lines.join("\r\n");
    let log = read(&cut.as_bytes()[..cut.len() - 60]).unwrap();
    assert_eq!(
        log.damage.sentences(),
        [
            "2 lines torn (another number of fields) were skipped: lines 301, 601".to_owned(),
            format!("1 line cut off was skipped: line {}", lines.len()),
        ]
    );
}

#[test]
fn damage_is_skipped_and_counted() {
    let rows = walk::rows(super::STRIDES);
    let mut bytes = log(&rows);
    // The record after three formats and two messages of another kind.
    let record = 3 * 89 + 2 * 14 + 54 * 300;
    bytes[record + 1] = 0;
    bytes.truncate(bytes.len() - 10);
    let log = read(&bytes).unwrap();
    let sentences = log.damage.sentences();
    assert!(
        sentences[0].starts_with("1 record torn (unreadable) was skipped: record 30"),
        "{sentences:?}"
    );
    assert!(sentences[1].starts_with("1 record cut off was skipped: record "), "{sentences:?}");
    assert!(log.samples.len() >= rows.len() - 2);
    // A stretch of foreign bytes.
    let mut much = bytes.clone();
    much.splice(record..record, vec![7; bytes.len() / 10]);
    let sentence = refusal(&much);
    assert!(
        sentence.contains("damaged records") && sentence.contains("bytes that are none"),
        "{sentence}"
    );
    let strict = kestirim_import::Options { strict: true, ..Default::default() };
    let error = kestirim_import::inertial::read(&bytes, &strict).unwrap_err().to_string();
    assert!(error.starts_with("record 30"), "{error}");
}

#[test]
fn memory_that_was_not_written_is_no_damage() {
    let rows = walk::rows(super::STRIDES);
    for filling in [0, 0xff] {
        let mut bytes = log(&rows);
        bytes.extend(vec![filling; 4000]);
        let log = read(&bytes).unwrap();
        assert_eq!((log.samples.len(), log.damage.count()), (rows.len(), 0));
    }
}

#[test]
fn a_log_without_the_sensor_is_refused() {
    let mut bytes = fmt(131, "MODE", "QMBB", "TimeUS,Mode,ModeNum,Rsn", 14);
    bytes.extend([0xa3, 0x95, 131, 0, 0, 0, 0, 0, 0, 0, 0, 4, 4, 1]);
    assert_eq!(
        refusal(&bytes),
        "expected messages IMU with GyrX and AccX of ArduPilot, found MODE"
    );
}

#[test]
fn damaged_logs_do_no_harm() {
    survives(&log(&short()), 0..SEEDS);
    survives(text(&short()).as_bytes(), 0..SEEDS);
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_binary_logs() {
    survives_much(&log(&short()));
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_logs_of_text() {
    survives_much(text(&short()).as_bytes());
}
