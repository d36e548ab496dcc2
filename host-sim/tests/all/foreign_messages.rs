//! Tests with messages of ROS and of this program itself: the same answer as from plain text.

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;

use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::recording::{Recording, Walked};
use mcap::records::MessageHeader;
use mcap::{WriteOptions, Writer};
use serde_json::Value;

use crate::program::{Desk, host_sim, json, refusal};
use crate::room::Room;

/// The time (ns), anchor and range (m) on each line of a log.
fn rows(log: &str) -> Vec<(u64, u8, f64)> {
    let text = fs::read_to_string(log).expect("a log");
    let row = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        let t: f64 = fields[0].parse().expect("a time");
        let anchor = fields[1].trim_start_matches('A').parse().expect("a number");
        ((t * 1e9).round() as u64, anchor, fields[2].parse().expect("a range"))
    };
    text.lines().skip(1).map(row).collect()
}

fn stamp(ns: u64) -> Vec<u8> {
    [ns / 1_000_000_000, ns % 1_000_000_000].map(|it| (it as u32).to_le_bytes()).concat()
}

/// A bag of ROS 1 (<https://wiki.ros.org/Bags/Format/2.0>) with a topic of `sensor_msgs/Range` for each anchor.
fn bag(rows: &[(u64, u8, f64)]) -> Vec<u8> {
    let counted = |bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat();
    let field = |name: &str, value: &[u8]| counted(&[name.as_bytes(), b"=", value].concat());
    let record =
        |header: &[Vec<u8>], data: &[u8]| [counted(&header.concat()), counted(data)].concat();
    let id = |anchor: u8| field("conn", &u32::from(anchor).to_le_bytes());
    let mut bag = b"#ROSBAG V2.0\n".to_vec();
    for anchor in 0..4 {
        let topic = field("topic", format!("/uwb/a{anchor}/range").as_bytes());
        let definition =
            b"Header header\nuint8 radiation_type\nfloat32 field_of_view\nfloat32 min_range\n\
            float32 max_range\nfloat32 range\n";
        let data = [
            topic.clone(),
            field("type", b"sensor_msgs/Range"),
            field("message_definition", definition),
        ];
        bag.extend(record(&[id(anchor), topic, field("op", &[7])], &data.concat()));
    }
    for &(ns, anchor, range) in rows {
        let numbers = [0.1, 0.0, 100.0, range as f32].map(f32::to_le_bytes).concat();
        let message = [&[0; 4][..], &stamp(ns), &[3, 0, 0, 0], b"tag", &[0], &numbers].concat();
        let header = [id(anchor), field("op", &[2]), field("time", &stamp(ns + 3_000_000))];
        bag.extend(record(&header, &message));
    }
    bag
}

/// An MCAP file of ROS 2 with messages like `uwb_driver/UwbRange`, shortened.
fn ros2(rows: &[(u64, u8, f64)]) -> Vec<u8> {
    let options = WriteOptions::new().compression(None);
    let mut file = Writer::with_options(Cursor::new(Vec::new()), options).expect("a file");
    let definition = b"std_msgs/Header header\nuint8 requester_id\nuint8 responder_id\nfloat32 distance\nfloat32 distance_err\n";
    let schema =
        file.add_schema("uwb_driver/msg/UwbRange", "ros2msg", definition).expect("a schema");
    let channel_id = file.add_channel(schema, "/uwb", "cdr", &BTreeMap::new()).expect("a channel");
    for &(ns, anchor, range) in rows {
        let numbers = [range as f32, 0.03].map(f32::to_le_bytes).concat();
        // The numbers are aligned to four bytes after the first four.
        let message =
            [&[0, 1, 0, 0][..], &stamp(ns), &[2, 0, 0, 0], b"u\0", &[9, anchor], &numbers].concat();
        let header = MessageHeader { channel_id, sequence: 0, log_time: ns, publish_time: ns };
        file.write_to_known_channel(&header, &message).expect("a message");
    }
    file.finish().expect("an end");
    file.into_inner().into_inner()
}

#[test]
fn ranges_of_ros_give_the_same_path() {
    let room = Room::clean();
    let replay = |log: &str| {
        let files = ["replay", "robot", "--anchors", &room.anchors, "--log", log, "--json"];
        json(&host_sim(&[&files[..], &["--truth", &room.truth, "--height", "1"]].concat()))
    };
    let plain = replay(&room.log);
    let rmse = |report: &Value| report["accuracy"]["rmse_m"].as_f64().expect("a number");
    let rows = rows(&room.log);
    for (name, file, told) in [
        ("log.bag", bag(&rows), "topics /uwb/a0/range, /uwb/a1/range"),
        ("log.mcap", ros2(&rows), "distance in m: topic /uwb: MCAP"),
    ] {
        let found = replay(&room.desk.file(name, file));
        assert_eq!(found["updates"], plain["updates"], "{name}");
        assert_eq!(found["warnings"], plain["warnings"], "{name}");
        assert!(found["import"][0].as_str().is_some_and(|it| it.contains(told)), "{name}: {found}");
        let off_mm = 1e3 * (rmse(&found) - rmse(&plain)).abs();
        assert!(off_mm < 0.1, "{name}: {off_mm} mm");
    }
    let other = room.desk.file("other.mcap", ros2(&[]));
    let sentence = refusal(&["replay", "robot", "--anchors", &room.anchors, "--log", &other]);
    assert!(sentence.contains("expected messages of ranges, found none on /uwb"), "{sentence}");
}

#[test]
fn what_is_written_of_a_walk_is_the_same_walk() {
    let desk = Desk::new();
    let walk = Recording::synthetic(Walked::Route, 100.0, 1, 0).expect("a walk");
    let row = |sample: &Sample| {
        let [ax, ay, az] = sample.specific_force;
        let [gx, gy, gz] = sample.angular_rate;
        format!("{},{ax},{ay},{az},{gx},{gy},{gz}\n", sample.time_us as f64 * 1e-6)
    };
    let rows: String = walk.log.samples.iter().map(row).collect();
    let plain = desk.file("walk.csv", format!("t,ax,ay,az,gx,gy,gz\n{rows}"));
    let own = desk.named("own.mcap");
    let replay = |log: &str, more: &[&str]| {
        json(&host_sim(&[&["replay", "pedestrian", "--json", "--log", log][..], more].concat()))
    };
    let (expected, found) = (replay(&plain, &["--mcap", &own]), replay(&own, &[]));
    assert_eq!(
        (&found["samples"], &found["warnings"]),
        (&expected["samples"], &expected["warnings"])
    );
    let strides = |report: &Value| report["strides"].as_array().expect("strides").clone();
    let (found, expected) = (strides(&found), strides(&expected));
    assert_eq!(found.len(), expected.len());
    assert!(found.len() >= 8, "{}", found.len());
    for (found, expected) in found.iter().zip(&expected) {
        for axis in ["x", "y", "z", "length_m"] {
            let number = |stride: &Value| stride[axis].as_f64().expect("a number");
            let off = (number(found) - number(expected)).abs();
            assert!(off < 1e-3, "{axis}: {off} m");
        }
    }
}

/// A flight around a user: time (ns), latitude, longitude, height, level.
fn flight() -> Vec<(u64, [f64; 4])> {
    let row = |k: u32| {
        let (angle, radius) = (f64::from(k) * 0.7, 50.0 + 7.0 * f64::from(k));
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        let level = -20.0 - 20.0 * (x - 120.0).hypot(y + 40.0).hypot(40.0).log10();
        let ns = 1_700_000_000_000_000_000 + u64::from(k) * 1_000_000_000;
        (ns, [51.5 + y / 111_267.0, 7.25 + x / 69_460.0, 40.0 + 0.1 * f64::from(k), level])
    };
    (0..60).map(row).collect()
}

/// A bag of ROS 1 with `sensor_msgs/NavSatFix` and two numbers of `std_msgs`.
fn bag_of_levels(rows: &[(u64, [f64; 4])]) -> Vec<u8> {
    const FIX: &str = "Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\n\
        float64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type\n=====\n\
        MSG: sensor_msgs/NavSatStatus\nint8 status\nuint16 service\n";
    let counted = |bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], bytes].concat();
    let field = |name: &str, value: &[u8]| counted(&[name.as_bytes(), b"=", value].concat());
    let record =
        |header: &[Vec<u8>], data: &[u8]| [counted(&header.concat()), counted(data)].concat();
    let id = |topic: u32| field("conn", &topic.to_le_bytes());
    let mut bag = b"#ROSBAG V2.0\n".to_vec();
    for (topic, name, kind, definition) in [
        (0, "/gps/fix", "sensor_msgs/NavSatFix", FIX),
        (1, "/rel_alt", "std_msgs/Float64", "float64 data\n"),
        (2, "/radio/rssi", "std_msgs/Float64", "float64 data\n"),
    ] {
        let name = field("topic", name.as_bytes());
        let data = [
            name.clone(),
            field("type", kind.as_bytes()),
            field("message_definition", definition.as_bytes()),
        ];
        bag.extend(record(&[id(topic), name, field("op", &[7])], &data.concat()));
    }
    for &(ns, [latitude, longitude, height, level]) in rows {
        let numbers = [latitude, longitude, height + 90.0].into_iter().chain([1.0; 9]);
        let numbers: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        let fix = [&[0; 4][..], &stamp(ns), &[1, 0, 0, 0], b"g", &[0, 1, 0], &numbers, &[2]];
        let (height, level) = (height.to_le_bytes(), level.to_le_bytes());
        for (topic, message) in [(0, &fix.concat()[..]), (1, &height), (2, &level)] {
            let header = [id(topic), field("op", &[2]), field("time", &stamp(ns))];
            bag.extend(record(&header, message));
        }
    }
    bag
}

/// An MCAP file of ROS 2 with `sensor_msgs/NavSatFix` and two numbers of `std_msgs`, whose definitions are missing.
fn mcap_of_levels(rows: &[(u64, [f64; 4])]) -> Vec<u8> {
    let options = WriteOptions::new().compression(None);
    let mut file = Writer::with_options(Cursor::new(Vec::new()), options).expect("a file");
    let mut channel = |name: &str, kind: &str| {
        let schema = file.add_schema(kind, "ros2msg", b"").expect("a schema");
        file.add_channel(schema, name, "cdr", &BTreeMap::new()).expect("a channel")
    };
    let fix = channel("/gps/fix", "sensor_msgs/msg/NavSatFix");
    let height_of = channel("/rel_alt", "std_msgs/msg/Float64");
    let level_of = channel("/radio/rssi", "std_msgs/msg/Float64");
    for &(ns, [latitude, longitude, height, level]) in rows {
        let numbers = [latitude, longitude, height + 90.0].into_iter().chain([1.0; 9]);
        let numbers: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
        // After the first four bytes: timestamp, "g" with its terminator, status and service at 14 and 16, the doubles
        // at 24.
        let header = [&[0, 1, 0, 0][..], &stamp(ns), &[2, 0, 0, 0], b"g\0", &[0, 0, 1, 0], &[0; 6]];
        let place = [&header.concat()[..], &numbers, &[2]].concat();
        let plain = |value: f64| [&[0, 1, 0, 0][..], &value.to_le_bytes()].concat();
        for (channel_id, message) in
            [(fix, place), (height_of, plain(height)), (level_of, plain(level))]
        {
            let header = MessageHeader { channel_id, sequence: 0, log_time: ns, publish_time: ns };
            file.write_to_known_channel(&header, &message).expect("a message");
        }
    }
    file.finish().expect("an end");
    file.into_inner().into_inner()
}

#[test]
fn levels_in_messages_give_the_same_place() {
    let (desk, rows) = (Desk::new(), flight());
    let line = |(ns, [latitude, longitude, height, level]): &(u64, [f64; 4])| {
        format!("{},{latitude},{longitude},{height},{level}\n", ns / 1_000_000_000)
    };
    let table = "t,lat,lon,h,rssi_db\n".to_owned() + &rows.iter().map(line).collect::<String>();
    let replay = |log: &str| json(&host_sim(&["replay", "drone", "--log", log, "--json"]));
    let place = |report: &Value| {
        ["x", "y"].map(|axis| report["estimate"][axis].as_f64().expect("a number"))
    };
    let plain = replay(&desk.file("plain.csv", table));
    for (name, bytes) in [("ros1.bag", bag_of_levels(&rows)), ("ros2.mcap", mcap_of_levels(&rows))]
    {
        let report = replay(&desk.file(name, bytes));
        assert_eq!(report["measurements"], plain["measurements"], "{name}");
        let (found, expected) = (place(&report), place(&plain));
        let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        assert!(off < 1e-3, "{name}: {off} m");
        let told = report["import"].to_string();
        assert!(told.contains("/radio/rssi, places of /gps/fix, heights of /rel_alt"), "{told}");
    }
    // The altitude is not a height above the user.
    let mut bag = bag_of_levels(&rows);
    let name = b"/rel_alt";
    while let Some(at) = bag.windows(name.len()).position(|it| it == name) {
        bag[at + 1..at + 8].copy_from_slice(b"nothing");
    }
    let sentence = refusal(&["replay", "drone", "--log", &desk.file("flat.bag", bag)]);
    assert!(sentence.contains("--columns h=TOPIC, or h=altitude"), "{sentence}");
}
