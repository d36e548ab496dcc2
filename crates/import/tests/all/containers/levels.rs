//! Levels with positions in bags of ROS 1 and MCAP files, by the definitions of the messages: those read are those
//! written.

use std::collections::BTreeMap;

use kestirim_import::Options;
use kestirim_import::levels::{self, Levels};

use super::imu::receipt;
use super::mcap::{bytes, file, write};
use super::ranges::{Pen, connection};
use super::rosbag::{bag, lz4, message};
use super::{MANY_SEEDS, SEEDS, survives_reading};

/// `docs.ros.org/en/noetic/api/sensor_msgs/html/msg/NavSatFix.html`
const FIX: &str = "uint8 COVARIANCE_TYPE_UNKNOWN = 0\nstd_msgs/Header header\nsensor_msgs/NavSatStatus status\n\
    float64 latitude\nfloat64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type\n\
    ================================\nMSG: sensor_msgs/NavSatStatus\nint8 STATUS_NO_FIX=-1\nint8 status\nuint16 service\n";
/// The definition from `mavros_msgs`, shortened behind the levels.
const RADIO: &str = "std_msgs/Header header\nuint8 rssi\nuint8 remrssi\nfloat32 rssi_dbm\n";

/// The name, type and definition of a topic.
type Topic = (&'static str, &'static str, &'static str);

const PLACES: Topic = ("/gps/fix", "sensor_msgs/NavSatFix", FIX);
const HEIGHTS: Topic = ("/mavros/global_position/rel_alt", "std_msgs/Float64", "float64 data");
const LEVELS: Topic = ("/lte/rx_power_dbm", "std_msgs/Float64", "");
const STATUS: Topic = ("/mavros/radio_status", "mavros_msgs/RadioStatus", RADIO);

/// The moments of the log: time in s, latitude, longitude, height, level.
fn moments() -> Vec<[f64; 5]> {
    let moment = |k: u32| {
        let t = f64::from(k) * 0.5;
        let (turn, level) = (0.1 * t, -60.0 - 0.25 * f64::from(k % 40));
        [t, 41.0 + 1e-4 * turn.sin(), 179.9999 + 1e-5 * t, 30.0 + 0.5 * t, level]
    };
    (0..120).map(moment).collect()
}

fn fix(is_cdr: bool, [t, latitude, longitude, height, _]: [f64; 5], status: i8) -> Vec<u8> {
    // Beyond the date line.
    let longitude = if longitude > 180.0 { longitude - 360.0 } else { longitude };
    let pen = Pen::new(is_cdr).header(t, "gps").put(status.to_le_bytes()).put([1, 0]);
    let numbers = [latitude, longitude, height + 812.5].into_iter().chain([1.0; 9]);
    numbers.fold(pen, |pen, number| pen.put(number.to_le_bytes())).put([2]).message()
}

fn number(is_cdr: bool, value: f64) -> Vec<u8> {
    Pen::new(is_cdr).put(value.to_le_bytes()).message()
}

fn status(is_cdr: bool, [t, .., level]: [f64; 5]) -> Vec<u8> {
    let pen = Pen::new(is_cdr).header(t, "").put([187]).put([190]);
    pen.single(level).message()
}

/// A message on a topic: the topic's index, the time in s, the writer for ROS 1 or CDR, and the moment that it holds.
type Sent = (usize, f64, fn(bool, [f64; 5]) -> Vec<u8>, [f64; 5]);

/// The same messages as bags of ROS 1, uncompressed and compressed, and as MCAP of ROS 2.
fn files(topics: &[Topic], sent: &[Sent]) -> [Vec<u8>; 3] {
    let mut records = Vec::new();
    let mut mcap = file(true);
    let mut channels = Vec::new();
    for (i, (name, kind, definition)) in topics.iter().enumerate() {
        records.push(connection(i as u32, name, kind, definition));
        let kind = kind.replace('/', "/msg/");
        let schema = mcap.add_schema(&kind, "ros2msg", definition.as_bytes()).unwrap();
        channels.push(mcap.add_channel(schema, name, "cdr", &BTreeMap::new()).unwrap());
    }
    for (topic, t, encode, moment) in sent {
        records.push(message(*topic as u32, *t, &encode(false, *moment)));
        write(&mut mcap, channels[*topic], receipt(*t), &encode(true, *moment));
    }
    [bag(&records, "", <[u8]>::to_vec), bag(&records, "lz4", lz4), bytes(mcap)]
}

/// Positions and heights twice a second, with levels between them.
fn sent(level: fn(bool, [f64; 5]) -> Vec<u8>) -> Vec<Sent> {
    let mut sent: Vec<Sent> = Vec::new();
    for pair in moments().windows(2) {
        let ([before, after], [t, ..]) = ([pair[0], pair[1]], pair[0]);
        sent.push((0, t, |is_cdr, moment| fix(is_cdr, moment, 0), before));
        sent.push((1, t, |is_cdr, moment| number(is_cdr, moment[3]), before));
        let middle: [f64; 5] = std::array::from_fn(|i| 0.5 * (before[i] + after[i]));
        sent.push((2, middle[0], level, [middle[0], middle[1], middle[2], middle[3], before[4]]));
    }
    sent
}

fn options(columns: &str, units: &str) -> Options {
    let mut options = Options::default();
    if !columns.is_empty() {
        options.columns = columns.parse().unwrap();
    }
    if !units.is_empty() {
        options.units = units.parse().unwrap();
    }
    options
}

fn read(file: &[u8], options: &Options) -> Result<Levels, String> {
    let read = levels::read(file, options).map_err(|error| error.to_string())?;
    Ok(read.expect("a file of ROS"))
}

fn plain(is_cdr: bool, moment: [f64; 5]) -> Vec<u8> {
    number(is_cdr, moment[4])
}

#[test]
fn levels_are_heard_where_they_were() {
    type Level = (Topic, fn(bool, [f64; 5]) -> Vec<u8>);
    for (topic, level) in
        [(LEVELS, plain as fn(bool, [f64; 5]) -> Vec<u8>), (STATUS, status)] as [Level; 2]
    {
        for file in files(&[PLACES, HEIGHTS, topic], &sent(level)) {
            let log = read(&file, &Options::default()).unwrap();
            // Beyond the last position nothing is known.
            assert_eq!((log.heard.len(), log.damage.count(), log.are_losses), (118, 0, false));
            let first = log.heard[0].time_us - 250_000;
            for (found, pair) in log.heard.iter().zip(moments().windows(2)) {
                let middle: [f64; 5] = std::array::from_fn(|i| 0.5 * (pair[0][i] + pair[1][i]));
                let off = (found.time_us - first) as f64 * 1e-6 - middle[0];
                assert!(off.abs() <= 2e-6, "{found:?}");
                let turn = found.longitude - middle[2];
                assert!((turn - 360.0 * (turn / 360.0).round()).abs() < 1e-9, "{found:?}");
                assert!((found.latitude - middle[1]).abs() < 1e-9, "{found:?}");
                assert!((found.height - middle[3]).abs() < 1e-6, "{found:?}");
                assert_eq!(found.level, pair[0][4]);
            }
        }
    }
}

#[test]
fn what_was_understood_is_told() {
    let [bag, ..] = files(&[PLACES, HEIGHTS, LEVELS], &sent(plain));
    assert_eq!(
        read(&bag, &Options::default()).unwrap().conclusions,
        [
            "data in dB: topic /lte/rx_power_dbm, places of /gps/fix, heights of /mavros/global_position/rel_alt, times of \
             receipt, as there are no stamps of all: ROS 1 bag",
            "levels left out, as no place or height is within two seconds: 1",
        ]
    );
    let mut unfixed = sent(plain);
    for place in [0, 30, 33] {
        unfixed[place].2 = |is_cdr, moment| fix(is_cdr, moment, -1);
    }
    let [bag, ..] = files(&[PLACES, HEIGHTS, LEVELS], &unfixed);
    let log = read(&bag, &Options::default()).unwrap();
    assert_eq!(log.heard.len(), 117);
    assert_eq!(log.conclusions[2], "places left out, as they have no fix: 3");
}

#[test]
fn what_is_open_is_refused() {
    let refused = |topics: &[Topic], sent: &[Sent], options: &Options| {
        read(&files(topics, sent)[0], options).unwrap_err()
    };
    let none = Options::default();
    let without = |topic: usize| -> Vec<Sent> {
        sent(plain).into_iter().filter(|(own, ..)| *own != topic).collect()
    };
    let all = [PLACES, HEIGHTS, LEVELS];
    assert_eq!(
        refused(&all[1..2], &[], &none),
        "expected places as a topic of sensor_msgs/NavSatFix, found none"
    );
    let no_height = refused(&all, &without(1), &none);
    assert!(no_height.contains("--columns h=TOPIC, or h=altitude"), "{no_height}");
    let log = read(&files(&all, &without(1))[2], &options("h=altitude", "")).unwrap();
    assert!((log.heard[0].height - 842.625).abs() < 1e-5, "{:?}", log.heard[0]);
    let of_names = refused(&all, &without(2), &none);
    assert!(of_names.contains("expected levels as a topic of a number"), "{of_names}");
    // A level that may mean anything, and one in a radio's own units.
    let doubtful = [PLACES, HEIGHTS, ("/radio/level", "std_msgs/Float64", "float64 data")];
    let sentence = refused(&doubtful, &sent(plain), &none);
    assert!(
        sentence.ends_with("found /radio/level; --columns rssi_db=/radio/level decides"),
        "{sentence}"
    );
    for said in [
        options("rssi_db=/radio/level", ""),
        Options { topic: Some("radio/level".to_owned()), ..Options::default() },
    ] {
        assert_eq!(read(&files(&doubtful, &sent(plain))[2], &said).unwrap().heard.len(), 118);
    }
    let own = [
        PLACES,
        HEIGHTS,
        ("/radio", "mavros_msgs/RadioStatus", "std_msgs/Header header\nuint8 rssi\n"),
    ];
    let of_radio: Vec<_> =
        sent(|is_cdr, [t, ..]| Pen::new(is_cdr).header(t, "").put([187]).message());
    let sentence = refused(&own, &of_radio, &none);
    assert!(sentence.contains("a radio's own units; --units rssi_db=dB decides"), "{sentence}");
    assert_eq!(
        read(&files(&own, &of_radio)[0], &options("", "rssi_db=dB")).unwrap().heard[0].level,
        187.0
    );
    // Two topics of levels.
    let two = [PLACES, HEIGHTS, LEVELS, ("/b/rssi", "std_msgs/Float64", "float64 data")];
    let mut of_two = sent(plain);
    of_two.push((3, 1.0, plain, moments()[2]));
    let sentence = refused(&two, &of_two, &none);
    assert!(
        sentence.contains("found /lte/rx_power_dbm, /b/rssi; --topic /lte/rx_power_dbm decides"),
        "{sentence}"
    );
    assert_eq!(levels::read(b"t,lat,lon,h,rssi_db\n", &none), Ok(None));
}

/// Fails unless the levels that are read are in order and finite, and refusals are one sentence.
fn assert_harmless(file: &[u8], seed: u64) {
    match levels::read(file, &Options::default()) {
        Ok(Some(log)) => {
            assert!(log.heard.is_sorted_by_key(|it| it.time_us), "seed {seed}");
            assert!(log.heard.iter().all(|it| it.level.is_finite()), "seed {seed}");
        }
        Ok(None) => {}
        Err(error) => assert!(!error.to_string().contains(['\n', '\r']), "seed {seed}: {error}"),
    }
}

#[test]
fn damaged_levels_do_no_harm() {
    for file in files(&[PLACES, HEIGHTS, STATUS], &sent(status)) {
        survives_reading(&file, 0..SEEDS / 4, assert_harmless);
    }
}

#[test]
#[ignore = "minutes"]
fn much_harm_to_levels() {
    for file in files(&[PLACES, HEIGHTS, STATUS], &sent(status)) {
        survives_reading(&file, 0..MANY_SEEDS / 10, assert_harmless);
    }
}
