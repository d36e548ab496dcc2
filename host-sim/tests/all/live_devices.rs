//! Tests of `host-sim live` on a line shared by devices that identify themselves.

use std::ffi::OsString;
use std::net::UdpSocket;
use std::path::Path;

use host_sim::commands::{self, live::Live};
use kestirim_health::{Health, Reason};
use kestirim_telemetry::{EstimateHealth, Imu};
use serde_json::{Value, json};

use crate::live_senders::{played, played_with, walk, warns};
use crate::program::Desk;
use crate::sender::{frame, frame_of, length, wait_for};

/// The frames of a walk, sent by a device.
fn of(device: u32, boot: u32, walk: &[Imu]) -> Vec<Vec<u8>> {
    let numbered = walk.iter().enumerate();
    numbered.map(|(number, &imu)| frame_of(device, boot, imu, number)).collect()
}

/// Interleaves lists, one element of each in turn, until the longest ends.
fn in_turn(lists: &[Vec<Vec<u8>>]) -> Vec<Vec<u8>> {
    let longest = lists.iter().map(Vec::len).max().unwrap_or(0);
    let one_of_each = (0..longest).flat_map(|at| lists.iter().filter_map(move |it| it.get(at)));
    one_of_each.cloned().collect()
}

fn row(report: &Value, device: u32) -> &Value {
    let rows = report["devices"].as_array().expect("devices");
    rows.iter().find(|row| row["device"] == device).expect("the device")
}

#[test]
fn each_device_is_followed_as_if_it_were_alone() {
    let desk = Desk::new();
    let walks = [1, 2, 3].map(walk);
    let alone = walks.each_ref().map(|walk| {
        let frames: Vec<_> = walk.iter().enumerate().map(|(n, &imu)| frame(imu, n)).collect();
        played(&desk, &frames)
    });
    let mut lists: Vec<_> = (10..).zip(&walks).map(|(device, walk)| of(device, 4, walk)).collect();
    // One device loses frames, and two of its frames are swapped.
    lists[2].drain(100..110);
    lists[2].swap(200, 201);
    let report = played(&desk, &in_turn(&lists));
    for (device, alone) in (10..12).zip(&alone) {
        let row = row(&report, device);
        assert_eq!(row["path_length_m"], alone["path_length_m"], "device {device}");
        assert_eq!(row["position"], alone["position"], "device {device}");
        assert_eq!((&row["lost"], &row["boot"]), (&0.into(), &4.into()));
    }
    assert_eq!(row(&report, 12)["lost"], 10);
    assert_eq!(report["counts"]["lost"], 10);
    assert_eq!(report["counts"]["left_out"], 0);
    // Unless specified, the first device heard is shown in detail.
    assert_eq!(report["position"], alone[0]["position"]);
    let report = played_with(&desk, &in_turn(&lists), &["--device", "11"]);
    assert_eq!(report["position"], alone[1]["position"]);
    assert!(!warns(&report, "device"), "{report}");
}

#[test]
fn a_device_that_is_switched_on_again_begins_anew_at_once() {
    let desk = Desk::new();
    let (first, second) = (walk(1), walk(2));
    let alone = played(&desk, &of(7, 0, &second));
    let both = [of(7, 1, &first[..1000]), of(7, 2, &second)].concat();
    let report = played(&desk, &both);
    let row = row(&report, 7);
    assert_eq!((&row["restarts"], &row["boot"], &row["lost"]), (&1.into(), &2.into(), &0.into()));
    assert_eq!(report["path_length_m"], alone["path_length_m"]);
    assert_eq!(report["counts"]["refused"], 0);
}

#[test]
fn two_senders_with_one_device_number_are_told() {
    let desk = Desk::new();
    let (first, second) = (walk(1), walk(2));
    // A second sender with the same boot, with an earlier one, and one that does not count its boots.
    let count = first.len().min(second.len());
    let alone = played(&desk, &of(7, 3, &first[..count]));
    for boot in [3, 2] {
        let lists = [of(7, 3, &first[..count]), of(7, boot, &second[..count])];
        let report = played(&desk, &in_turn(&lists));
        assert!(warns(&report, "two senders use this number"), "{report}");
        assert_eq!(row(&report, 7)["another"], count);
        assert_eq!(report["path_length_m"], alone["path_length_m"]);
        assert_eq!(report["counts"]["lost"], 0);
    }
    let report = played(&desk, &[of(7, 0, &first), of(7, 0, &second[..500])].concat());
    assert!(warns(&report, "does not count its boots"), "{report}");
}

#[test]
fn each_device_tells_how_far_it_relies_on_its_own_estimate() {
    let desk = Desk::new();
    let walk = walk(1);
    let lists: Vec<_> = [(7, Health::GOOD), (8, Reason::Axes.into())]
        .into_iter()
        .map(|(device, health)| {
            let reasons = health.bits();
            let told = EstimateHealth { time_us: walk[walk.len() - 1].time_us, reasons };
            [of(device, 1, &walk), vec![frame_of(device, 1, told, walk.len())]].concat()
        })
        .collect();
    let report = played(&desk, &in_turn(&lists));
    for (device, own, reasons) in [(7, "good", json!([])), (8, "bad", json!(["axes"]))] {
        let row = row(&report, device);
        assert_eq!(row["own_health"], json!({ "state": own, "reasons": reasons }));
        // What is estimated here has a health of its own.
        assert_eq!(row["health"]["state"], "good");
    }
    assert!(warns(&report, "device 8 does not rely on its own estimate: bad: axes"), "{report}");
    assert!(!warns(&report, "device 7"), "{report}");
    // Of a device that is shown in detail, and of one whose reason a later version has.
    let report = played_with(&desk, &in_turn(&lists), &["--device", "8"]);
    assert!(warns(&report, "the sender does not rely on its own estimate: bad: axes"), "{report}");
    let later = EstimateHealth { time_us: 0, reasons: 1 << 15 };
    let report = played(&desk, &[lists[0].clone(), vec![frame_of(9, 1, later, 0)]].concat());
    let unknown = json!({ "state": "bad", "reasons": ["unknown"] });
    assert_eq!(row(&report, 9)["own_health"], unknown);
}

#[test]
fn any_number_of_devices_send_to_one_port_and_are_in_a_table() {
    let desk = Desk::new();
    let recording = desk.named("port.frames");
    let line = ["host-sim", "live", "--headless", "--udp", "127.0.0.1:0", "--record", &recording];
    let typed: Vec<_> =
        [&line[..], &["--system", "pedestrian"]].concat().into_iter().map(OsString::from).collect();
    let matches = commands::command(&typed).get_matches_from(&typed);
    let live = Live::of(matches.subcommand_matches("live").expect("the command")).expect("a port");
    let address = live.address().expect("it listens");
    let walk = &walk(1)[..20];
    let mut sent = 0;
    for device in 0..300 {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        for frame in of(device, 1, walk) {
            socket.send_to(&frame, address).expect("it is sent");
            sent += frame.len() as u64;
        }
        wait_for("the frames", || length(Path::new(&recording)) >= sent);
    }
    wait_for("all devices", || live.counts().received == 300 * 20);
    let answer = live.answer();
    let rows = &answer.tables.first().expect("a table").rows;
    assert_eq!((rows.len(), answer.tables.len()), (300, 1));
    assert!(rows.iter().all(|row| row[2] == "20" && row[3] == "0"), "{rows:?}");
    live.stopper().stop();
    let report = live.finish().expect("a report");
    assert_eq!(report.devices.len(), 300);
    let told = report.warnings.iter().any(|it| it.contains("sender"));
    assert!(!told, "{:?}", report.warnings);
    assert!(report.to_string().contains("and 280 more devices"), "{report}");
}
