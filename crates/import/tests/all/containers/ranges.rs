//! Ranges in bags of ROS 1 and MCAP files, by the definitions of the messages: those read are those written.

use kestirim_import::Options;
use kestirim_import::ranging::{self, Ranging};

use super::imu::stamp;
use super::mcap::{bytes, file, write};
use super::rosbag::{bag, lz4, message, record};
use super::{MANY_SEEDS, SEEDS, survives_reading};

/// `docs.ros.org/en/noetic/api/sensor_msgs/html/msg/Range.html`
const RANGE: &str = "Header header\nuint8 ULTRASOUND=0\nuint8 INFRARED=1\nuint8 radiation_type\nfloat32 field_of_view\n\
    float32 min_range\nfloat32 max_range\nfloat32 range\n================================\nMSG: std_msgs/Header\n\
    uint32 seq\ntime stamp\nstring frame_id\n";
/// The definition from `github.com/ntu-aris/uwb_driver`, shortened behind the range.
const UWB_RANGE: &str = "Header  header      # ROS header\nuint16  msgId\nuint8   requester_id\nuint8   responder_id\n\
    int8    requester_idx\nint8    responder_idx\nuint8   range_status\nuint8   antenna\nuint16  stopwatch_time\n\
    float32 distance      # Distance measurement using ToF\nfloat32 coarse_range\nfloat32 distance_err\n\
    geometry_msgs/Point responder_location\n================================\nMSG: geometry_msgs/Point\n\
    float64 x\nfloat64 y\nfloat64 z\n";
/// The definitions from `github.com/nooploop-dev/nlink_parser`.
const TAGFRAME0: &str = "uint8 role\nuint8 id\nuint32 local_time\nuint32 system_time\nfloat32 voltage\nfloat32[3] pos_3d\n\
    float32[3] eop_3d\nfloat32[3] vel_3d\nfloat32[8] dis_arr\n";
const NODEFRAME2: &str = "std_msgs/Header header\nuint8 role\nuint8 id\nfloat32 voltage\nLinktrackNode2[] nodes\n\
    ================================\nMSG: nlink_parser/LinktrackNode2\nuint8 role\nuint8 id\nfloat32 dis\nfloat32 fp_rssi\nfloat32 rx_rssi\n";
/// The definition from `github.com/GTEC-UDC/rosmsgs`.
const RANGING: &str =
    "int16 anchorId\nint16 tagId\nint32 range\nint32 seq\nfloat64 errorEstimation\n";

/// Writes a message's fields.
pub(super) struct Pen {
    message: Vec<u8>,
    is_cdr: bool,
}

impl Pen {
    pub(super) fn new(is_cdr: bool) -> Self {
        Self { message: if is_cdr { vec![0, 1, 0, 0] } else { Vec::new() }, is_cdr }
    }

    pub(super) fn put<const N: usize>(mut self, number: [u8; N]) -> Self {
        if self.is_cdr {
            self.message.resize((self.message.len() - 4).next_multiple_of(N) + 4, 0);
        }
        self.message.extend(number);
        self
    }

    pub(super) fn single(self, number: f64) -> Self {
        self.put((number as f32).to_le_bytes())
    }

    pub(super) fn message(self) -> Vec<u8> {
        self.message
    }

    fn singles(self, numbers: &[f64]) -> Self {
        numbers.iter().fold(self, |pen, number| pen.single(*number))
    }

    pub(super) fn header(mut self, t: f64, frame: &str) -> Self {
        if !self.is_cdr {
            self = self.put([0; 4]);
        }
        let (seconds, nanoseconds) = stamp(t);
        let length = frame.len() as u32 + u32::from(self.is_cdr);
        self = self
            .put(seconds.to_le_bytes())
            .put(nanoseconds.to_le_bytes())
            .put(length.to_le_bytes());
        self.message.extend(frame.as_bytes());
        if self.is_cdr {
            self.message.push(0);
        }
        self
    }
}

/// The index of a topic and a message on it.
type OnTopic = (usize, Vec<u8>);

/// A message type with its definition, its topics and a writer of its messages.
struct Kind {
    name: &'static str,
    definition: &'static str,
    topic: fn(usize) -> String,
    /// The messages of one epoch, for ROS 1 or in CDR.
    messages: fn(f64, [f64; 3], bool) -> Vec<OnTopic>,
    units: Option<&'static str>,
}

fn range_of(t: f64, frame: &str, range: f64, is_cdr: bool) -> Vec<u8> {
    Pen::new(is_cdr).header(t, frame).put([0]).singles(&[0.1, 0.0, 100.0, range]).message
}

const KINDS: [Kind; 6] = [
    Kind {
        name: "sensor_msgs/Range",
        definition: RANGE,
        topic: |anchor| format!("/uwb/anchor_{anchor}/range"),
        messages: |t, ranges, is_cdr| {
            let all = ranges.into_iter().enumerate();
            all.map(|(i, range)| (i, range_of(t, "tag", range, is_cdr))).collect()
        },
        units: None,
    },
    Kind {
        name: "sensor_msgs/Range",
        definition: "",
        topic: |_| "/uwb0/range".to_owned(),
        messages: |t, ranges, is_cdr| {
            let all = ranges.into_iter().enumerate();
            all.map(|(i, range)| (0, range_of(t, &format!("A{i}"), range, is_cdr))).collect()
        },
        units: None,
    },
    Kind {
        name: "uwb_driver/UwbRange",
        definition: UWB_RANGE,
        topic: |_| "/uwb_endorange_info".to_owned(),
        messages: |t, ranges, is_cdr| {
            let message = |(anchor, range): (usize, f64)| {
                let pen =
                    Pen::new(is_cdr).header(t, "uwb").put([1, 0]).put([200]).put([anchor as u8]);
                let pen = pen.put([0]).put([0]).put([0]).put([1]).put([9, 0]);
                let pen = pen.singles(&[range, range + 5.0, 0.1]);
                let pen = [1.0_f64, 2.0, 3.0].iter().fold(pen, |pen, x| pen.put(x.to_le_bytes()));
                (0, pen.message)
            };
            ranges.into_iter().enumerate().map(message).collect()
        },
        units: None,
    },
    Kind {
        name: "nlink_parser/LinktrackTagframe0",
        definition: TAGFRAME0,
        topic: |_| "/nlink_linktrack_tagframe0".to_owned(),
        messages: |_, [a, b, c], is_cdr| {
            let pen = Pen::new(is_cdr).put([2]).put([7]).put([1, 0, 0, 0]).put([2, 0, 0, 0]);
            let pen = pen.singles(&[3.9; 10]).singles(&[a, b, c, 0.0, 0.0, 0.0, 0.0, 0.0]);
            vec![(0, pen.message)]
        },
        units: None,
    },
    Kind {
        name: "nlink_parser/LinktrackNodeframe2",
        definition: NODEFRAME2,
        topic: |_| "/nlink_linktrack_nodeframe2".to_owned(),
        messages: |t, ranges, is_cdr| {
            let pen =
                Pen::new(is_cdr).header(t, "").put([2]).put([1]).single(3.9).put([3, 0, 0, 0]);
            let node = |pen: Pen, (anchor, range): (usize, &f64)| {
                pen.put([1]).put([anchor as u8]).singles(&[*range, -80.0, -79.0])
            };
            vec![(0, ranges.iter().enumerate().fold(pen, node).message)]
        },
        units: None,
    },
    Kind {
        name: "msgs/Ranging",
        definition: RANGING,
        topic: |_| "/gtec/toa/ranging".to_owned(),
        messages: |_, ranges, is_cdr| {
            let message = |(anchor, range): (usize, f64)| {
                let millimetres = (range * 1e3).round() as i32;
                let pen = Pen::new(is_cdr).put((anchor as i16).to_le_bytes()).put([9, 0]);
                let pen = pen.put(millimetres.to_le_bytes()).put([0; 4]).put([0; 8]);
                (0, pen.message)
            };
            ranges.into_iter().enumerate().map(message).collect()
        },
        units: Some("range=mm"),
    },
];

fn moments() -> impl Iterator<Item = (f64, [f64; 3])> {
    (0..200).map(|k| {
        let t = f64::from(k) * 0.05;
        (t, [3.0 + t, 5.0 - 0.2 * t, 7.5 + t.sin()].map(|range| (range * 1e3).round() / 1e3))
    })
}

/// A connection record of a bag, with a definition.
pub(super) fn connection(id: u32, topic: &str, kind: &str, definition: &str) -> Vec<u8> {
    let field = |name: &str, value: &[u8]| {
        let field = [name.as_bytes(), b"=", value].concat();
        [&(field.len() as u32).to_le_bytes()[..], &field].concat()
    };
    let data = [
        field("topic", topic.as_bytes()),
        field("type", kind.as_bytes()),
        field("message_definition", definition.as_bytes()),
    ];
    record(
        &[("conn", &id.to_le_bytes()), ("topic", topic.as_bytes()), ("op", &[7])],
        &data.concat(),
    )
}

/// The epochs as bags of ROS 1, uncompressed and compressed, and as MCAP of ROS 2.
fn files(kind: &Kind) -> [Vec<u8>; 3] {
    let topics = if (kind.topic)(0) == (kind.topic)(1) { 1 } else { 3 };
    let mut records = vec![connection(9, "/tf", "tf/tfMessage", "X x\n")];
    records.extend(
        (0..topics).map(|i| connection(i as u32, &(kind.topic)(i), kind.name, kind.definition)),
    );
    let mut mcap = file(true);
    let name = kind.name.replace('/', "/msg/");
    let channels: Vec<_> = (0..topics)
        .map(|i| {
            let schema = mcap.add_schema(&name, "ros2msg", kind.definition.as_bytes()).unwrap();
            mcap.add_channel(schema, &(kind.topic)(i), "cdr", &std::collections::BTreeMap::new())
                .unwrap()
        })
        .collect();
    for (t, ranges) in moments() {
        records.push(message(9, t, &[0; 4]));
        for (topic, data) in (kind.messages)(t, ranges, false) {
            records.push(message(topic as u32, t, &data));
        }
        for (topic, data) in (kind.messages)(t, ranges, true) {
            write(&mut mcap, channels[topic], super::imu::receipt(t), &data);
        }
    }
    [bag(&records, "", <[u8]>::to_vec), bag(&records, "lz4", lz4), bytes(mcap)]
}

fn options(units: Option<&str>) -> Options {
    Options { units: units.map(|it| it.parse().unwrap()).unwrap_or_default(), ..Options::default() }
}

fn read(file: &[u8], options: &Options) -> Result<Ranging, String> {
    let anchors = ["A0", "A1", "A2"].map(str::to_owned);
    let read = ranging::read(file, &anchors, options).map_err(|error| error.to_string())?;
    Ok(read.expect("a file of ROS"))
}

#[test]
fn every_message_is_the_same_ranges() {
    for kind in &KINDS {
        for file in files(kind) {
            let log = read(&file, &options(kind.units)).unwrap();
            assert_eq!(
                (log.ranges.len(), log.unlisted, log.damage.count()),
                (600, 0, 0),
                "{}",
                kind.name
            );
            let expected = moments()
                .flat_map(|(t, ranges)| (0..3).map(move |anchor| (t, anchor, ranges[anchor])));
            let first = log.ranges[0].time_us;
            for (found, (t, anchor, range)) in log.ranges.iter().zip(expected) {
                let off_us = (found.time_us - first).abs_diff((t * 1e6).round() as i64);
                assert!(found.anchor == anchor && off_us <= 1, "{}: {found:?}", kind.name);
                assert!((found.metres - range).abs() < 1e-5, "{}: {found:?}", kind.name);
            }
        }
    }
}

#[test]
fn what_was_understood_is_told() {
    let told = |kind: usize| {
        read(&files(&KINDS[kind])[0], &options(KINDS[kind].units)).unwrap().conclusion
    };
    assert_eq!(
        [0, 2, 3, 5].map(told),
        [
            "range in m: topics /uwb/anchor_0/range, /uwb/anchor_1/range, /uwb/anchor_2/range: ROS 1 bag",
            "distance in m: topic /uwb_endorange_info: ROS 1 bag",
            "dis_arr in m: topic /nlink_linktrack_tagframe0, times of receipt, as there are no stamps: ROS 1 bag",
            "range in mm: topic /gtec/toa/ranging, times of receipt, as there are no stamps: ROS 1 bag",
        ]
    );
    let error = read(&files(&KINDS[5])[2], &options(None)).unwrap_err();
    assert_eq!(error, "expected a unit of range, found whole numbers; --units range=mm decides");
    let coarse = Options { columns: "range=coarse_range".parse().unwrap(), ..Options::default() };
    let log = read(&files(&KINDS[2])[1], &coarse).unwrap();
    assert!(
        (log.ranges[0].metres - 8.0).abs() < 1e-6
            && log.conclusion.starts_with("coarse_range in m")
    );
}

#[test]
fn what_is_open_is_refused() {
    let plain = options(None);
    let with = |records: &[Vec<u8>], options: &Options| {
        read(&bag(records, "none", <[u8]>::to_vec), options)
    };
    let two = |topic: &str, id: u32| connection(id, topic, "uwb_driver/UwbRange", UWB_RANGE);
    let (_, heard) = (KINDS[2].messages)(0.0, [1.0, 2.0, 3.0], false).remove(0);
    let records =
        [two("/a/uwb", 0), two("/b/uwb", 1), message(0, 0.0, &heard), message(1, 0.0, &heard)];
    let error = with(&records, &plain).unwrap_err();
    assert_eq!(error, "expected one topic of ranges, found /a/uwb, /b/uwb; --topic /a/uwb decides");
    let said = |topic: &str| Options { topic: Some(topic.to_owned()), ..Options::default() };
    assert_eq!(with(&records, &said("b")).unwrap().ranges.len(), 1);
    let error = with(&records, &said("/c")).unwrap_err();
    assert_eq!(error, "expected ranges on topic /c, found them on /a/uwb, /b/uwb (--topic)");
    // Without a definition the position of a range is unknown.
    let records = [connection(0, "/uwb", "uwb_driver/UwbRange", ""), message(0, 0.0, &heard)];
    let error = with(&records, &plain).unwrap_err();
    assert!(
        error.ends_with("whose definition is in the file, found /uwb (uwb_driver/UwbRange)"),
        "{error}"
    );
    let error = with(&[two("/uwb", 0)], &plain).unwrap_err();
    assert_eq!(error, "expected messages of ranges, found none on /uwb");
    // A tag's own number does not identify an anchor.
    let own = connection(0, "/uwb", "radio/Range", "uint8 id\nfloat32 range\n");
    assert!(
        with(&[own, message(0, 0.0, &[1, 0, 0, 0, 0])], &plain)
            .unwrap_err()
            .contains("expected a topic of ranges")
    );
    // Topics and frames name different anchors.
    let range = |topic: &str, id: u32| connection(id, topic, "sensor_msgs/Range", RANGE);
    let sent = |id: u32, frame: &str| message(id, 0.0, &range_of(0.0, frame, 1.0, false));
    let records = [range("/uwb/0", 0), range("/uwb/1", 1), sent(0, "A1"), sent(1, "A2")];
    let error = with(&records, &plain).unwrap_err();
    assert!(error.starts_with("expected anchors by the names of topics or of frames"), "{error}");
    // The ranges of a sonar.
    let error = with(&[range("/sonar", 0), sent(0, "base_link")], &plain).unwrap_err();
    assert!(error.starts_with("expected ranges to anchors \"A0\""), "{error}");
    let time = Options { units: "t=ms".parse().unwrap(), ..Options::default() };
    let error = with(&[range("/uwb/0", 0), sent(0, "A0")], &time).unwrap_err();
    assert_eq!(error, "expected options of range, anchor alone, found one of t");
}

#[test]
fn damage_is_skipped_and_counted() {
    let [mut plain, ..] = files(&KINDS[2]);
    let at = plain.len() / 2;
    plain.splice(at..at + 7, [0x11; 13]);
    plain.truncate(plain.len() - 9);
    let log = read(&plain, &options(None)).unwrap();
    assert!(log.ranges.len() >= 597, "{}", log.ranges.len());
    assert!(!log.damage.sentences().is_empty());
    let strict = Options { strict: true, ..Options::default() };
    assert!(read(&plain, &strict).unwrap_err().starts_with("record "));
    plain.splice(at..at, vec![0x11; plain.len() / 10]);
    assert!(read(&plain, &options(None)).unwrap_err().contains("damaged records"));
}

/// Fails unless refusals are one sentence.
fn assert_harmless(file: &[u8], seed: u64) {
    let anchors = ["A0", "A1", "A2"].map(str::to_owned);
    let options = Options { units: "range=mm".parse().unwrap(), ..Options::default() };
    if let Err(error) = ranging::read(file, &anchors, &options) {
        assert!(!error.to_string().contains(['\n', '\r']), "seed {seed}: {error}");
    }
}

#[test]
fn damaged_ranges_do_no_harm() {
    for kind in &KINDS {
        let [plain, _, mcap] = files(kind);
        for file in [plain, mcap] {
            survives_reading(&file, 0..SEEDS / 4, assert_harmless);
        }
    }
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_ranges() {
    for kind in &KINDS {
        for file in files(kind) {
            survives_reading(&file, 0..MANY_SEEDS / 10, assert_harmless);
        }
    }
}
