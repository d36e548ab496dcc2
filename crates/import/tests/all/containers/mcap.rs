//! MCAP files written by the crate `mcap`.

use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};

use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use ruzstd::encoding::{CompressionLevel, compress_to_vec};

use super::imu::{cdr, receipt, ros1, stamp};
use super::{
    SEEDS, assert_same, plain, read, read_topic, refusal, short, survives, survives_much, told,
};
use crate::walk;

pub(super) type File = Writer<Cursor<Vec<u8>>>;

pub(super) fn file(chunks: bool) -> File {
    let options = WriteOptions::new().compression(None).use_chunks(chunks).chunk_size(Some(20_000));
    options.create(Cursor::new(Vec::new())).unwrap()
}

fn channel(file: &mut File, topic: &str, kind: &str, encoding: &str) -> u16 {
    let schema = file.add_schema(kind, "ros2msg", b"std_msgs/Header header").unwrap();
    file.add_channel(schema, topic, encoding, &BTreeMap::new()).unwrap()
}

pub(super) fn write(file: &mut File, channel_id: u16, time: u64, message: &[u8]) {
    let header = MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
    file.write_to_known_channel(&header, message).unwrap();
}

pub(super) fn bytes(mut file: File) -> Vec<u8> {
    file.finish().unwrap();
    file.into_inner().into_inner()
}

/// A recording of ROS 2 with a second topic.
fn ros2(rows: &[[f64; 7]], chunks: bool) -> Vec<u8> {
    let mut file = file(chunks);
    let imu = channel(&mut file, "/imu/data", "sensor_msgs/msg/Imu", "cdr");
    let other = channel(&mut file, "/odom", "nav_msgs/msg/Odometry", "cdr");
    for (i, &row) in rows.iter().enumerate() {
        write(&mut file, imu, receipt(row[0]) + 700_000, &cdr("imu", false, stamp(row[0]), row));
        if i % 7 == 0 {
            write(&mut file, other, receipt(row[0]), &[0, 1, 0, 0, 9, 9, 9]);
        }
    }
    bytes(file)
}

/// The same file with its chunks compressed.
fn packed(file: &[u8], name: &str, pack: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut packed = file[..8].to_vec();
    let mut at = 8;
    while at + 9 < file.len() {
        let length = u64::from_le_bytes(file[at + 1..at + 9].try_into().unwrap()) as usize;
        let (kind, body) = (file[at], &file[at + 9..at + 9 + length]);
        let mut new = body.to_vec();
        if kind == 6 {
            // Times, size and checksum are followed by an empty compression name and a length.
            let records = pack(&body[28 + 4 + 8..]);
            new.truncate(28);
            new.extend((name.len() as u32).to_le_bytes());
            new.extend(name.as_bytes());
            new.extend((records.len() as u64).to_le_bytes());
            new.extend(records);
        }
        packed.push(kind);
        packed.extend((new.len() as u64).to_le_bytes());
        packed.extend(new);
        at += 9 + length;
    }
    packed.extend(&file[at..]);
    packed
}

fn lz4(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn zstd(bytes: &[u8]) -> Vec<u8> {
    // In two frames, as a writer may produce them.
    let halves = bytes.split_at(bytes.len() / 2);
    [halves.0, halves.1].map(|half| compress_to_vec(half, CompressionLevel::Fastest)).concat()
}

#[test]
fn a_recording_of_ros_2_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let chunked = ros2(&rows, true);
    for file in
        [ros2(&rows, false), packed(&chunked, "lz4", lz4), packed(&chunked, "zstd", zstd), chunked]
    {
        let log = read(&file).unwrap();
        assert_same(&log, &plain(&rows), 0.0);
        assert_eq!(log.samples[1].time_us, 1_700_000_000_010_000);
        assert_eq!(
            told(&log),
            "time in µs, acceleration in m/s², angular rate in rad/s: MCAP; topic /imu/data: MCAP"
        );
        assert_eq!(log.damage.sentences(), [""; 0]);
    }
}

#[test]
fn every_encoding_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    for frame in ["", "a", "base_link", "a_longer_name_of_a_frame"] {
        for is_big in [false, true] {
            let mut file = file(true);
            let imu = channel(&mut file, "/imu", "sensor_msgs/msg/Imu", "cdr");
            for &row in &rows {
                write(&mut file, imu, 0, &cdr(frame, is_big, stamp(row[0]), row));
            }
            assert_same(&read(&bytes(file)).unwrap(), &plain(&rows), 0.0);
        }
    }
    // Without stamps the times of receipt are used.
    let mut file = file(true);
    let imu = channel(&mut file, "/imu", "sensor_msgs/Imu", "ros1");
    for &row in &rows {
        write(&mut file, imu, receipt(row[0]), &ros1(7, (0, 0), row));
    }
    let log = read(&bytes(file)).unwrap();
    assert_same(&log, &plain(&rows), 0.0);
    assert!(told(&log).ends_with("times of receipt, as all stamps are 0: MCAP"), "{}", told(&log));
}

#[test]
fn several_topics_need_the_option() {
    let rows = walk::rows(super::STRIDES);
    let mut file = file(true);
    let topics = ["/left/imu", "/right/imu"];
    let channels = topics.map(|topic| channel(&mut file, topic, "sensor_msgs/msg/Imu", "cdr"));
    channel(&mut file, "/empty/imu", "sensor_msgs/msg/Imu", "cdr");
    for &row in &rows {
        write(&mut file, channels[0], 0, &cdr("", false, stamp(row[0]), row));
        write(&mut file, channels[1], 0, &cdr("", false, stamp(row[0] + 1.0), row));
    }
    let bytes = bytes(file);
    assert_eq!(
        refusal(&bytes),
        "expected one topic of sensor_msgs/Imu, found /left/imu, /right/imu; --topic /left/imu decides"
    );
    let right = read_topic(&bytes, "right/imu").unwrap();
    assert_eq!(right.samples[0].time_us, 1_700_000_001_000_000);
    for topic in ["/odom", "/empty/imu"] {
        let error = read_topic(&bytes, topic).unwrap_err().to_string();
        let found = "found topics /left/imu, /right/imu, /empty/imu (--topic)";
        assert_eq!(
            error,
            format!("expected messages of sensor_msgs/Imu on topic {topic}, {found}")
        );
    }
}

#[test]
fn results_are_not_sensors() {
    let mut file = file(true);
    for (topic, kind) in [
        ("/pedestrian/ekf", "kestirim.pedestrian_ekf"),
        ("/pedestrian/ekf/pose", "foxglove.PoseInFrame"),
    ] {
        let id = channel(&mut file, topic, kind, "protobuf");
        write(&mut file, id, 0, &[1, 2, 3]);
    }
    assert_eq!(
        refusal(&bytes(file)),
        "expected a recording of sensors, found results of host-sim, which hold no inertial sensor's samples"
    );
    let mut other = self::file(true);
    channel(&mut other, "/imu", "sensor_msgs/msg/Imu", "json");
    channel(&mut other, "/odom", "nav_msgs/msg/Odometry", "cdr");
    assert_eq!(
        refusal(&bytes(other)),
        "expected a topic of sensor_msgs/Imu in ROS 1's encoding or CDR, found /imu (sensor_msgs/msg/Imu), /odom (nav_msgs/msg/Odometry)"
    );
}

/// A protobuf field that is a text or a message, with its number.
fn part(number: u8, value: &[u8]) -> Vec<u8> {
    let length = value.len();
    // A length of more than 127 takes two bytes.
    let length = match length {
        0..128 => vec![length as u8],
        _ => vec![(length & 0x7f | 0x80) as u8, (length >> 7) as u8],
    };
    [&[number << 3 | 2][..], &length, value].concat()
}

/// A walk as `host-sim --mcap` writes it: `FileDescriptorSet` and messages of doubles, beside other results.
fn own(rows: &[[f64; 7]], columns: &[&str]) -> Vec<u8> {
    let field = |(number, name): (u8, &&str)| {
        let numbers = vec![3 << 3, number, 4 << 3, 1, 5 << 3, 1];
        part(2, &[part(1, name.as_bytes()), numbers].concat())
    };
    let fields: Vec<u8> = (1..).zip(columns).flat_map(field).collect();
    let message = [part(1, b"pedestrian_imu"), fields].concat();
    let schema = part(1, &[part(1, b"a.proto"), part(2, b"kestirim"), part(4, &message)].concat());
    let mut file = file(true);
    let id = file.add_schema("kestirim.pedestrian_imu", "protobuf", &schema).unwrap();
    let imu = file.add_channel(id, "/pedestrian/imu", "protobuf", &BTreeMap::new()).unwrap();
    let other =
        channel(&mut file, "/pedestrian/estimate", "kestirim.pedestrian_estimate", "protobuf");
    for &[t, ax, ay, az, gx, gy, gz] in rows {
        let number =
            |(number, value): (u8, f64)| [&[number << 3 | 1][..], &value.to_le_bytes()].concat();
        let message: Vec<u8> = (1..).zip([ax, ay, az, gx, gy, gz]).flat_map(number).collect();
        write(&mut file, imu, (t * 1e9).round() as u64, &message);
        write(&mut file, other, (t * 1e9).round() as u64, &[9]);
    }
    bytes(file)
}

const OWN: [&str; 6] = ["ax_m_s2", "ay_m_s2", "az_m_s2", "gx_rad_s", "gy_rad_s", "gz_rad_s"];

#[test]
fn what_host_sim_writes_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    let log = read(&own(&rows, &OWN)).unwrap();
    assert_same(&log, &plain(&rows), 0.0);
    assert!(told(&log).ends_with("topic /pedestrian/imu: MCAP"), "{}", told(&log));
    let [first, .., last] = OWN;
    assert!(refusal(&own(&rows, &[first, last])).contains("results of host-sim"));
    survives(&own(&short(), &OWN), 0..SEEDS / 3);
}

#[test]
fn a_file_that_was_cut_off_is_read_as_far_as_it_goes() {
    let rows = walk::rows(super::STRIDES);
    let chunked = ros2(&rows, true);
    for file in
        [ros2(&rows, false), packed(&chunked, "lz4", lz4), packed(&chunked, "zstd", zstd), chunked]
    {
        let log = read(&file[..file.len() / 2]).unwrap();
        assert!(log.samples.len() > rows.len() / 3, "{}", log.samples.len());
        let sentences = log.damage.sentences();
        assert_eq!(sentences.len(), 1, "{sentences:?}");
        assert!(sentences[0].starts_with("1 record cut off was skipped"), "{sentences:?}");
        assert_eq!(log.samples, read(&file).unwrap().samples[..log.samples.len()]);
    }
}

#[test]
fn damage_is_skipped_and_counted() {
    let rows = walk::rows(super::STRIDES);
    let mut bytes = ros2(&rows, false);
    let at = bytes.len() / 4;
    bytes.splice(at..at + 30, [0x11; 50]);
    let log = read(&bytes).unwrap();
    assert!(log.samples.len() >= rows.len() - 3);
    assert!(log.damage.sentences()[0].contains("torn (unreadable)"), "{:?}", log.damage);
    // A chunk with a wrong checksum is more than a hundredth of so short a file.
    let mut bytes = ros2(&rows, true);
    let at = bytes.len() / 4;
    bytes[at] ^= 1;
    assert!(refusal(&bytes).contains("damaged records"), "{}", refusal(&bytes));
}

#[test]
fn what_unpacks_to_too_much_is_refused() {
    let mut bytes = packed(&ros2(&short(), true), "zstd", zstd);
    let chunk = (8..bytes.len()).find(|&at| bytes[at] == 6 && bytes[at + 8] == 0).unwrap();
    let size = chunk + 9 + 16;
    bytes[size..size + 8].copy_from_slice(&(1_u64 << 31).to_le_bytes());
    assert_eq!(
        refusal(&bytes),
        "expected a file that unpacks to at most 1 GiB, found a larger one"
    );
}

fn all() -> [Vec<u8>; 3] {
    let chunked = ros2(&short(), true);
    [packed(&chunked, "lz4", lz4), packed(&chunked, "zstd", zstd), ros2(&short(), false)]
}

#[test]
fn damaged_files_do_no_harm() {
    for file in all() {
        survives(&file, 0..SEEDS / 3);
    }
}

#[test]
#[ignore = "minutes"]
fn much_harm() {
    for file in all() {
        survives_much(&file);
    }
}
