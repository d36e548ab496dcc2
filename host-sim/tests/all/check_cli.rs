//! Tests of `host-sim check`: clean logs have no fault, and each injected fault is reported with a remedy.

use std::fs;

use host_sim::random::stream;
use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::{measure, razor_text};
use serde_json::{Value, json};

use crate::program::{Desk, host_sim, json as parsed, text};
use crate::room::{ANCHORS, Room, line};

fn faults(arguments: &[&str]) -> Vec<String> {
    let report = parsed(&host_sim(&[&["check"], arguments, &["--json"]].concat()));
    let findings = report["findings"].as_array().expect("findings").clone();
    let told = |finding: &Value| {
        let [found, consequence, remedy] = ["found", "consequence", "remedy"]
            .map(|part| finding[part].as_str().unwrap_or_default());
        format!("{found}; {consequence}; {remedy}")
    };
    let faults: Vec<_> =
        findings.iter().filter(|it| it["consequence"].is_string()).map(told).collect();
    assert_eq!(report["faults"], faults.len());
    faults
}

fn walk() -> Vec<Sample> {
    let mut rng = stream(4, 0);
    let ideal = Scenario::draw(&mut rng).ideal_imu(100.0);
    measure(&mut rng, &ideal, 100.0)
}

#[test]
fn the_faults_of_a_walk_are_told_with_what_to_do() {
    let desk = Desk::new();
    let told = |name: &str, samples: &[Sample]| {
        let log = desk.file(name, razor_text(samples));
        faults(&["pedestrian", "--log", &log])
    };
    let clean = walk();
    assert_eq!(told("clean.txt", &clean), [""; 0]);
    let mut clipped = clean.clone();
    for sample in &mut clipped {
        sample.angular_rate = sample.angular_rate.map(|rate| rate.clamp(-4.36, 4.36));
    }
    let sentences = told("clipped.txt", &clipped);
    assert!(sentences[0].contains("gyroscope saturated at 250 °/s"), "{sentences:?}");
    assert!(sentences[0].contains("±300 °/s"), "{sentences:?}");
    let mut stuck = clean.clone();
    let middle = stuck.len() / 2;
    let last = stuck[middle];
    for sample in &mut stuck[middle..middle + 60] {
        sample.specific_force = last.specific_force;
        sample.angular_rate = last.angular_rate;
    }
    let sentences = told("stuck.txt", &stuck);
    assert!(sentences[0].contains("repeated itself once"), "{sentences:?}");
    let mut slow = clean.clone();
    slow.retain(|sample| sample.time_us / 10_000 % 5 == 0);
    assert!(told("slow.txt", &slow)[0].contains("20.0 Hz"));
    // The replay warns as well.
    let log = desk.named("stuck.txt");
    let replay = parsed(&host_sim(&["replay", "pedestrian", "--json", "--log", &log]));
    assert!(replay["warnings"].to_string().contains("repeated itself"), "{replay}");
    // The foot was in a swing: its rotation in the meantime is lost as well.
    assert_eq!(replay["health"]["state"], "bad");
    assert_eq!(replay["health"]["reasons"][0], "stuck");
    let table = host_sim(&["check", "pedestrian", "--log", &desk.named("clean.txt")]);
    assert!(text(&table.stdout).contains("at rest, gravity 9."), "{}", text(&table.stdout));
}

#[test]
fn the_faults_of_ranges_are_told_with_what_to_do() {
    let room = Room::clean();
    let height = ["--height", "1"];
    let told = |anchors: &str, log: &str| {
        let files = ["robot", "--anchors", anchors, "--log", log];
        faults(&[&files[..], &height].concat())
    };
    assert_eq!(told(&room.anchors, &room.log), [""; 0]);
    let places = fs::read_to_string(&room.anchors).expect("anchors");
    let swapped = places.replace("A1,", "Ax,").replace("A2,", "A1,").replace("Ax,", "A2,");
    let swapped = room.desk.file("swapped.csv", swapped);
    let sentences = told(&swapped, &room.log);
    assert!(sentences[0].contains("A2 and A1 swapped"), "{sentences:?}");
    let feet = Room::new([0.0; 4], |_, t, anchor, range| vec![line(t, anchor, range / 0.3048)]);
    let sentences = told(&feet.anchors, &feet.log);
    assert!(sentences[0].contains("--units range=ft"), "{sentences:?}");
    let stuck = Room::new([0.0; 4], |epoch, t, anchor, range| {
        vec![line(t, anchor, if anchor == 2 && epoch > 200 { 4.321 } else { range })]
    });
    let sentences = told(&stuck.anchors, &stuck.log);
    assert!(sentences.iter().any(|it| it.contains("A2 stays at 4.321 m")), "{sentences:?}");
    let cut = Room::new([0.0; 4], |_, t, anchor, range| vec![line(t, anchor, range.min(5.0))]);
    let sentences = told(&cut.anchors, &cut.log);
    assert!(sentences.iter().any(|it| it.contains("exactly 5 m")), "{sentences:?}");
    // The replay warns as well.
    let files = ["replay", "robot", "--json", "--anchors", &swapped, "--log", &room.log];
    let replay = parsed(&host_sim(&[&files[..], &height].concat()));
    assert!(replay["warnings"].to_string().contains("swapped"), "{replay}");
    assert_eq!(replay["health"]["state"], "bad");
    assert!(replay["health"]["reasons"].as_array().expect("reasons").contains(&json!("anchor")));
    let clean = room.report(&height);
    assert_eq!(clean["health"], json!({ "state": "good", "reasons": [] }));
}

#[test]
fn anchors_in_one_plane_do_not_tell_a_tag_from_its_mirror_image() {
    let room = Room::clean();
    assert_eq!(room.report(&["--dim", "3"])["warnings"], Value::Array(vec![]));
    let level =
        ANCHORS.iter().enumerate().fold("anchor,x,y,z\n".to_owned(), |text, (i, [x, y, _])| {
            text + &format!("{i},{x},{y},2.1\n")
        });
    let level = room.desk.file("level.csv", level);
    let start = ["replay", "robot", "--anchors", &level, "--log", &room.log];
    let report = parsed(&host_sim(&[&start[..], &["--dim", "3", "--json"]].concat()));
    let warnings = report["warnings"].to_string();
    assert!(warnings.contains("all anchors are within 0 cm of one plane"), "{report}");
    assert_eq!(report["health"]["state"], "bad", "{report}");
}
