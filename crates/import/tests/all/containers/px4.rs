//! Logs of PX4.

use super::{
    SEEDS, SINGLE, assert_same, plain, read, read_topic, refusal, short, survives, survives_much,
    told,
};
use crate::walk;

const COMBINED: &str = "sensor_combined:uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;\
    int32_t accelerometer_timestamp_relative;float[3] accelerometer_m_s2;uint32_t accelerometer_integral_dt;\
    uint8_t accelerometer_clipping;uint8_t[3] _padding0;";
const IMU: &str = "vehicle_imu:uint64_t timestamp;uint64_t timestamp_sample;uint32_t accel_device_id;uint32_t gyro_device_id;\
    float[3] delta_angle;float[3] delta_velocity;uint16_t delta_angle_dt;uint16_t delta_velocity_dt;";
const GYRO: &str = "sensor_gyro:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;";
const ACCEL: &str = "sensor_accel:uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;";
/// A type that contains another type, as in `esc_status`.
const OTHER: &str = "esc_status:uint64_t timestamp;esc_report[2] esc;";
const NESTED: &str =
    "esc_report:uint64_t timestamp;int32_t rpm;uint8_t state;uint8_t[3] _padding0;";

pub(super) fn record(kind: u8, body: &[u8]) -> Vec<u8> {
    let size = u16::try_from(body.len()).unwrap().to_le_bytes();
    [&size, &[kind][..], body].concat()
}

pub(super) fn header(types: &[&str]) -> Vec<u8> {
    let mut log = b"ULog\x01\x12\x35\x01".to_vec();
    log.extend(1_000_000_u64.to_le_bytes());
    log.extend(record(b'B', &[0; 40]));
    log.extend(types.iter().flat_map(|text| record(b'F', text.as_bytes())));
    log.extend(record(b'I', b"\x0dchar[3] sys_namePX4"));
    log
}

pub(super) fn topic(id: u16, instance: u8, name: &str) -> Vec<u8> {
    record(b'A', &[&[instance][..], &id.to_le_bytes(), name.as_bytes()].concat())
}

pub(super) fn data(id: u16, parts: &[&[u8]]) -> Vec<u8> {
    record(b'D', &[&id.to_le_bytes()[..], &parts.concat()].concat())
}

pub(super) fn singles(values: [f64; 3]) -> Vec<u8> {
    values.map(|value| (value as f32).to_le_bytes()).concat()
}

pub(super) fn micros(t: f64) -> [u8; 8] {
    ((t * 1e6).round() as u64 + 7_000_000).to_le_bytes()
}

fn combined(id: u16, [t, ax, ay, az, gx, gy, gz]: [f64; 7]) -> Vec<u8> {
    let (rate, force) = (singles([gx, gy, gz]), singles([ax, ay, az]));
    data(id, &[&micros(t), &rate, &[0; 4], &[9, 0, 0, 0], &force, &[0; 4], &[0]])
}

/// A log with `sensor_combined`, another topic, a text, a dropout, a mark and a record of an unknown kind.
fn log(rows: &[[f64; 7]]) -> Vec<u8> {
    let mut log = header(&[OTHER, NESTED, COMBINED]);
    log.extend(topic(0, 0, "esc_status"));
    log.extend(topic(1, 0, "sensor_combined"));
    log.extend(record(b'L', b"6\0\0\0\0\0\0\0\0armed"));
    for (i, &row) in rows.iter().enumerate() {
        log.extend(combined(1, row));
        if i % 10 == 0 {
            log.extend(data(0, &[&micros(row[0]), &[1; 16], &[2; 16]]));
        }
        if i % 100 == 50 {
            log.extend(record(b'S', &[0x2f, 0x73, 0x13, 0x20, 0x25, 0x0c, 0xbb, 0x12]));
            log.extend(record(b'O', &[20, 0]));
            log.extend(record(b'z', b"a later version's"));
        }
    }
    log
}

#[test]
fn a_log_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let log = read(&log(&rows)).unwrap();
    assert_same(&log, &plain(&rows), SINGLE);
    assert_eq!(
        told(&log),
        "time in µs, acceleration in m/s², angular rate in rad/s: PX4 ULog; sensor_combined: PX4 ULog; \
         dropouts of the logger: 12, 240 ms in all: PX4 ULog"
    );
    assert_eq!(log.damage.sentences(), [""; 0]);
    assert_eq!(log.samples[0].time_us, 7_000_000);
}

#[test]
fn increments_are_divided_by_their_intervals() {
    let rows = walk::rows(super::STRIDES);
    let mut log = header(&[IMU]);
    for instance in 0..3 {
        log.extend(topic(u16::from(instance), instance, "vehicle_imu"));
    }
    for &[t, ax, ay, az, gx, gy, gz] in &rows {
        let angle = singles([gx, gy, gz].map(|rate| rate * 0.005));
        let velocity = singles([ax, ay, az].map(|force| force * 0.004));
        for id in 0..3 {
            let time = micros(t + f64::from(id) * 1e-3);
            let intervals = [&5000_u16.to_le_bytes()[..], &4000_u16.to_le_bytes()].concat();
            log.extend(data(id, &[&micros(t), &time, &[0; 8], &angle, &velocity, &intervals]));
        }
    }
    assert_same(&read(&log).unwrap(), &plain(&rows), SINGLE);
    assert!(told(&read(&log).unwrap()).contains("; vehicle_imu 0 of 3: PX4 ULog"));
    let second = read_topic(&log, "2").unwrap();
    assert_eq!(second.samples[0].time_us, 7_002_000);
    let error = read_topic(&log, "5").unwrap_err().to_string();
    assert_eq!(error, "expected vehicle_imu 5, found vehicle_imu 0, 1, 2 (--topic)");
}

#[test]
fn two_topics_become_one() {
    let rows = walk::rows(super::STRIDES);
    let mut log = header(&[GYRO, ACCEL]);
    log.extend(topic(0, 0, "sensor_gyro"));
    log.extend(topic(1, 0, "sensor_accel"));
    let sample =
        |id, t: f64, values| data(id, &[&micros(t + 0.002), &micros(t), &[0; 4], &singles(values)]);
    for (i, &[t, ax, ay, az, gx, gy, gz]) in rows.iter().enumerate() {
        log.extend(sample(0, t, [gx, gy, gz]));
        // The accelerometer begins later, and only lacks samples that interpolation restores.
        if i > 4 && (t > 1.0 || i % 2 == 0) {
            log.extend(sample(1, t, [ax, ay, az]));
        }
    }
    let read = read(&log).unwrap();
    assert!(
        told(&read).contains("the times of the angular rate, 6 of which have none around them"),
        "{}",
        told(&read)
    );
    assert_same(&read, &plain(&rows[6..]), 0.05);
}

#[test]
fn samples_without_an_accelerometer_are_left_out() {
    let rows = walk::rows(super::STRIDES);
    let mut log = header(&[COMBINED]);
    log.extend(topic(1, 0, "sensor_combined"));
    let mut first = combined(1, rows[0]);
    first[5 + 24..5 + 28].copy_from_slice(&i32::MAX.to_le_bytes());
    log.extend(first);
    log.extend(rows[1..].iter().flat_map(|&row| combined(1, row)));
    let log = read(&log).unwrap();
    assert_eq!(log.samples.len(), rows.len() - 1);
    let sentence = &log.damage.sentences()[0];
    assert!(sentence.starts_with("1 record without a number"), "{sentence}");
}

#[test]
fn damage_is_skipped_and_counted() {
    let rows = walk::rows(super::STRIDES);
    let mut bytes = log(&rows);
    let at = bytes.len() / 2;
    bytes.splice(at..at + 7, [0xee; 40]);
    bytes.truncate(bytes.len() - 9);
    let log = read(&bytes).unwrap();
    let sentences = log.damage.sentences();
    assert!(sentences[0].contains("torn (unreadable)"), "{sentences:?}");
    assert!(sentences[1].starts_with("1 record cut off was skipped"), "{sentences:?}");
    assert!(log.samples.len() >= rows.len() - 4, "{}", log.samples.len());
    bytes.splice(at..at, vec![0xee; bytes.len() / 20]);
    assert!(refusal(&bytes).contains("damaged records"), "{}", refusal(&bytes));
}

#[test]
fn what_was_appended_is_read_and_newer_logs_are_refused() {
    let rows = walk::rows(super::STRIDES);
    let mut bytes = log(&rows);
    // The logger stopped in the middle of a record and continued behind it.
    bytes.truncate(bytes.len() - 20);
    let offset = bytes.len() as u64;
    bytes.extend(combined(1, rows[rows.len() - 1].map(|value| value * 1.001)));
    let flags = 16 + 3;
    bytes[flags + 8] = 1;
    bytes[flags + 16..flags + 24].copy_from_slice(&offset.to_le_bytes());
    let log = read(&bytes).unwrap();
    assert_eq!((log.samples.len(), log.damage.count()), (rows.len(), 1));
    bytes[flags + 9] = 1;
    assert_eq!(refusal(&bytes), "expected a ULog of version 1, found flags of a newer one");
}

#[test]
fn a_log_without_the_sensor_is_refused() {
    let mut log = header(&[OTHER, NESTED]);
    log.extend(topic(0, 0, "esc_status"));
    log.extend(data(0, &[&micros(0.0), &[1; 16], &[2; 16]]));
    let expected =
        "expected a topic sensor_combined, vehicle_imu, or sensor_gyro with sensor_accel, found ";
    assert_eq!(refusal(&log), format!("{expected}esc_status"));
    assert_eq!(refusal(b"ULog\x01\x12\x35"), format!("{expected}none"));
}

#[test]
fn damaged_logs_do_no_harm() {
    survives(&log(&short()), 0..SEEDS);
}

#[test]
#[ignore = "minutes"]
fn much_harm() {
    survives_much(&log(&short()));
}
