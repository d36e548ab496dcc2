//! Tests of `host-sim live` on a line with reordered frames, or shared by two senders.

use std::ffi::OsString;
use std::net::UdpSocket;
use std::path::Path;

use host_sim::commands::{self, live::Live};
use host_sim::random::stream;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::measure;
use kestirim_telemetry::Imu;
use serde_json::Value;

use crate::program::{Desk, host_sim, json};
use crate::sender::{frame, length, wait_for};

/// The IMU samples of a walk.
pub(crate) fn walk(seed: u64) -> Vec<Imu> {
    let mut rng = stream(seed, 0);
    let ideal = Scenario::draw(&mut rng).ideal_imu(100.0);
    let narrow = |vector: [f64; 3]| vector.map(|number| number as f32);
    let samples = measure(&mut rng, &ideal, 100.0);
    let imu = |sample: &host_sim::systems::pedestrian::Sample| Imu {
        time_us: sample.time_us,
        specific_force: narrow(sample.specific_force),
        angular_rate: narrow(sample.angular_rate),
    };
    samples.iter().map(imu).collect()
}

fn numbered(walk: &[Imu], first: usize) -> Vec<Vec<u8>> {
    walk.iter().enumerate().map(|(index, &imu)| frame(imu, first + index)).collect()
}

/// The report on a recording of these frames.
pub(crate) fn played(desk: &Desk, frames: &[Vec<u8>]) -> Value {
    played_with(desk, frames, &[])
}

/// The report on a recording of these frames, with further options.
pub(crate) fn played_with(desk: &Desk, frames: &[Vec<u8>], more: &[&str]) -> Value {
    let file = desk.file("line.frames", frames.concat());
    let options = ["live", "--headless", "--file", &file, "--system", "pedestrian", "--json"];
    json(&host_sim(&[&options, more].concat()))
}

pub(crate) fn warns(report: &Value, of: &str) -> bool {
    report["warnings"].as_array().expect("a list").iter().any(|it| it.to_string().contains(of))
}

#[test]
fn frames_that_overtake_each_other_change_nothing() {
    let desk = Desk::new();
    let mut frames = numbered(&walk(1), 65_000);
    let clean = played(&desk, &frames);
    assert!(clean["path_length_m"].as_f64().expect("a path") > 10.0);
    frames[1..].chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
    frames[1..].chunks_mut(5).for_each(<[_]>::reverse);
    let swapped = played(&desk, &frames);
    assert_eq!(swapped["path_length_m"], clean["path_length_m"]);
    assert_eq!(swapped["position"], clean["position"]);
    assert_eq!(swapped["counts"], clean["counts"]);
    assert_eq!(swapped["counts"]["lost"], 0);
}

#[test]
fn of_two_senders_on_one_line_the_first_is_followed_and_the_second_told() {
    let desk = Desk::new();
    let (first, second) = (numbered(&walk(1), 0), numbered(&walk(2), 30_000));
    let clean = played(&desk, &first);
    let both: Vec<_> =
        first.iter().zip(&second).flat_map(|(a, b)| [a.clone(), b.clone()]).collect();
    let report = played(&desk, &both);
    assert_eq!(report["counts"]["lost"], 0);
    assert!(warns(&report, "a second sender"), "{report}");
    let metres = |report: &Value| report["path_length_m"].as_f64().expect("a path");
    let shorter: f64 = metres(&played(&desk, &first[..first.len().min(second.len())]));
    assert!((metres(&report) - shorter).abs() < 0.01 * metres(&clean), "{report}");
}

#[test]
fn of_two_senders_to_one_port_the_first_is_followed_and_the_second_told() {
    let desk = Desk::new();
    let recording = desk.named("port.frames");
    let line = ["host-sim", "live", "--headless", "--udp", "127.0.0.1:0", "--record", &recording];
    let typed: Vec<_> =
        [&line[..], &["--system", "pedestrian"]].concat().into_iter().map(OsString::from).collect();
    let matches = commands::command(&typed).get_matches_from(&typed);
    let live = Live::of(matches.subcommand_matches("live").expect("the command")).expect("a port");
    let address = live.address().expect("it listens");
    let [a, b] = [0; 2].map(|_| UdpSocket::bind("127.0.0.1:0").expect("a socket"));
    // Both count from zero: only their addresses tell them apart.
    let (first, second) = (numbered(&walk(1), 0), numbered(&walk(2), 0));
    let mut sent = 0;
    for (index, (mine, others)) in first.iter().zip(&second).enumerate() {
        a.send_to(mine, address).expect("it is sent");
        b.send_to(others, address).expect("it is sent");
        // The second sender's first datagram is accepted, as it is not yet known that there are two.
        sent += mine.len() as u64 + if index == 0 { others.len() as u64 } else { 0 };
        wait_for("a frame", || length(Path::new(&recording)) >= sent);
    }
    live.stopper().stop();
    let report = live.finish().expect("a report");
    let count = first.len().min(second.len());
    let alone = played(&desk, &first[..count]);
    assert_eq!(report.path_length_m, alone["path_length_m"].as_f64());
    assert_eq!(report.counts.lost, 0);
    assert!(report.warnings.iter().any(|it| it.contains("of a second sender")), "{report:?}");
}
