//! Bags of ROS 1.

use std::io::Write as _;

use super::imu::{receipt, ros1, stamp};
use super::{
    MANY_SEEDS, SEEDS, assert_same, plain, read, read_topic, refusal, short, survives,
    survives_much, told,
};
use crate::walk;

fn fields(fields: &[(&str, &[u8])]) -> Vec<u8> {
    let field = |(name, value): &(&str, &[u8])| {
        let field = [name.as_bytes(), b"=", value].concat();
        [&(field.len() as u32).to_le_bytes()[..], &field].concat()
    };
    fields.iter().flat_map(field).collect()
}

pub(super) fn record(header: &[(&str, &[u8])], data: &[u8]) -> Vec<u8> {
    let header = fields(header);
    let counted = |bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat();
    [counted(&header), counted(data)].concat()
}

fn connection(id: u32, topic: &str, kind: &str) -> Vec<u8> {
    let data = fields(&[
        ("topic", topic.as_bytes()),
        ("type", kind.as_bytes()),
        ("md5sum", b"6a62c6daae103f4ff57a132d6f95cec2"),
        ("message_definition", b"Header header\n"),
    ]);
    record(&[("conn", &id.to_le_bytes()), ("topic", topic.as_bytes()), ("op", &[7])], &data)
}

pub(super) fn message(id: u32, t: f64, data: &[u8]) -> Vec<u8> {
    let received = receipt(t + 0.0007);
    let time = [(received / 1_000_000_000) as u32, (received % 1_000_000_000) as u32];
    let time = time.map(u32::to_le_bytes).concat();
    record(&[("op", &[2]), ("conn", &id.to_le_bytes()), ("time", &time)], data)
}

/// A bag of these records in compressed chunks of a few messages, with the index that a player needs.
pub(super) fn bag(records: &[Vec<u8>], name: &str, pack: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut bag = b"#ROSBAG V2.0\n".to_vec();
    let header = [
        ("op", &[3][..]),
        ("index_pos", &[0; 8]),
        ("conn_count", &[1, 0, 0, 0]),
        ("chunk_count", &[9, 0, 0, 0]),
    ];
    bag.extend(record(&header, &[b' '; 4000]));
    for records in records.chunks(if name.is_empty() { records.len() } else { 60 }) {
        let plain = records.concat();
        if name.is_empty() {
            bag.extend(plain);
            continue;
        }
        let size = (plain.len() as u32).to_le_bytes();
        bag.extend(record(
            &[("op", &[5]), ("compression", name.as_bytes()), ("size", &size)],
            &pack(&plain),
        ));
        bag.extend(record(
            &[("op", &[4]), ("ver", &[1, 0, 0, 0]), ("conn", &[0; 4]), ("count", &[0; 4])],
            &[0; 12],
        ));
    }
    bag.extend(record(&[("op", &[6]), ("ver", &[1, 0, 0, 0]), ("chunk_pos", &[0; 8])], &[0; 8]));
    bag
}

/// The walk on one topic, beside another topic.
fn records(rows: &[[f64; 7]]) -> Vec<Vec<u8>> {
    let mut records =
        vec![connection(0, "/imu/data", "sensor_msgs/Imu"), connection(1, "/tf", "tf/tfMessage")];
    for (i, &row) in rows.iter().enumerate() {
        records.push(message(0, row[0], &ros1(i as u32, stamp(row[0]), row)));
        if i % 5 == 0 {
            records.push(message(1, row[0], &[0; 4]));
        }
    }
    records
}

pub(super) fn lz4(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn bz2(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn bags(rows: &[[f64; 7]]) -> [Vec<u8>; 4] {
    let records = records(rows);
    [
        bag(&records, "", <[u8]>::to_vec),
        bag(&records, "none", <[u8]>::to_vec),
        bag(&records, "lz4", lz4),
        bag(&records, "bz2", bz2),
    ]
}

#[test]
fn a_bag_is_the_walk() {
    let rows = walk::rows(super::STRIDES);
    for bag in bags(&rows) {
        let log = read(&bag).unwrap();
        assert_same(&log, &plain(&rows), 0.0);
        assert_eq!(log.samples[1].time_us, 1_700_000_000_010_000);
        assert_eq!(
            told(&log),
            "time in µs, acceleration in m/s², angular rate in rad/s: ROS 1 bag; topic /imu/data: ROS 1 bag"
        );
        assert_eq!(log.damage.sentences(), [""; 0]);
    }
}

#[test]
fn several_topics_need_the_option() {
    let rows = walk::rows(super::STRIDES);
    let mut records = records(&rows);
    records.push(connection(2, "/head/imu", "sensor_msgs/Imu"));
    records.extend(rows.iter().map(|&row| message(2, row[0], &ros1(0, stamp(row[0] + 2.0), row))));
    let bag = bag(&records, "lz4", lz4);
    assert_eq!(
        refusal(&bag),
        "expected one topic of sensor_msgs/Imu, found /imu/data, /head/imu; --topic /imu/data decides"
    );
    let head = read_topic(&bag, "/head/imu").unwrap();
    assert_eq!(head.samples[0].time_us, 1_700_000_002_000_000);
}

#[test]
fn what_is_not_there_is_named() {
    let records = [connection(1, "/tf", "tf/tfMessage"), message(1, 0.0, &[0; 4])];
    assert_eq!(
        refusal(&bag(&records, "none", <[u8]>::to_vec)),
        "expected a topic of sensor_msgs/Imu in ROS 1's encoding or CDR, found /tf (tf/tfMessage)"
    );
    assert_eq!(
        refusal(&bag(&[connection(0, "/imu", "sensor_msgs/Imu")], "none", <[u8]>::to_vec)),
        "expected messages of sensor_msgs/Imu, found none on /imu"
    );
    assert_eq!(refusal(b"#ROSBAG V1.2\nrest"), "expected #ROSBAG V2.0, found \"#ROSBAG V1.2\"");
    // An accelerometer that declares to have no values.
    let mut bare = vec![connection(0, "/imu", "sensor_msgs/Imu")];
    for &row in &short() {
        let mut imu = ros1(0, stamp(row[0]), row);
        let covariance = imu.len() - 9 * 8;
        imu[covariance..covariance + 8].copy_from_slice(&(-1.0_f64).to_le_bytes());
        bare.push(message(0, row[0], &imu));
    }
    let sentence = refusal(&bag(&bare, "none", <[u8]>::to_vec));
    assert!(
        sentence.contains("expected a finite number in column linear_acceleration.x, found NaN"),
        "{sentence}"
    );
}

#[test]
fn a_bag_that_was_cut_off_is_read_as_far_as_it_goes() {
    let rows = walk::rows(super::STRIDES);
    for bag in bags(&rows) {
        let log = read(&bag[..bag.len() / 2]).unwrap();
        assert!(log.samples.len() > rows.len() / 3, "{}", log.samples.len());
        let sentences = log.damage.sentences();
        assert_eq!(sentences.len(), 1, "{sentences:?}");
        assert!(sentences[0].starts_with("1 record cut off was skipped"), "{sentences:?}");
        assert_eq!(log.samples, read(&bag).unwrap().samples[..log.samples.len()]);
    }
}

#[test]
fn damage_is_skipped_and_counted() {
    let rows = walk::rows(super::STRIDES);
    let mut bag = bags(&rows)[0].clone();
    let at = bag.len() / 3;
    bag.splice(at..at + 30, [0x11; 50]);
    let log = read(&bag).unwrap();
    assert!(log.samples.len() >= rows.len() - 3);
    assert!(log.damage.sentences()[0].contains("torn (unreadable)"), "{:?}", log.damage);
}

#[test]
fn what_unpacks_to_too_much_is_refused() {
    let row = [0.0, 0.0, 0.0, 9.8, 0.0, 0.0, 0.0];
    let records =
        [connection(0, "/imu", "sensor_msgs/Imu"), message(0, 0.0, &ros1(0, stamp(0.0), row))];
    let mut bag = bag(&records, "lz4", lz4);
    let at = (0..bag.len()).find(|&at| bag[at..].starts_with(b"size=")).unwrap();
    bag[at + 5..at + 9].copy_from_slice(&0x7fff_ffff_u32.to_le_bytes());
    assert_eq!(refusal(&bag), "expected a file that unpacks to at most 1 GiB, found a larger one");
}

#[test]
fn damaged_bags_do_no_harm() {
    for bag in bags(&short()) {
        survives(&bag, 0..SEEDS / 4);
    }
}

#[test]
#[ignore = "minutes"]
fn much_harm() {
    let [plain, chunks, lz4, _] = bags(&short());
    for bag in [plain, chunks, lz4] {
        survives_much(&bag);
    }
}

/// Uses a tenth of the seeds, as bz2 is slow.
#[test]
#[ignore = "minutes"]
fn much_harm_to_bz2() {
    let [.., bz2] = bags(&short());
    survives(&bz2, 0..MANY_SEEDS / 10);
}
