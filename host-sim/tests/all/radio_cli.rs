//! Tests of radios' own timestamps, of differences, and of the survey of anchors.

use std::fmt::Write;

use crate::program::{Desk, host_sim, json, refusal, text};
use crate::room::{ANCHORS, Room, distance, place};
use host_sim::random::stream;
use host_sim::systems::robot::simulate::radio::{Clock, exchange};

/// The RMSE of the room's track from another form of log.
fn rmse(room: &Room, log: &str, more: &[&str]) -> f64 {
    let mut arguments = vec!["replay", "robot", "--anchors", &room.anchors, "--log", log];
    arguments.extend(["--truth", &room.truth, "--height", "1", "--json"]);
    arguments.extend(more);
    json(&host_sim(&arguments))["accuracy"]["rmse_m"].as_f64().expect("an accuracy")
}

#[test]
fn six_stamps_are_followed_with_and_without_a_level() {
    let room = Room::clean();
    let (plain, mut levelled) = (stamps(0.0), "t,anchor,t1,t2,t3,t4,t5,t6,rx_dbm\n".to_owned());
    for row in stamps(0.086).lines().skip(1) {
        let _ = writeln!(levelled, "{row},-95");
    }
    for (name, log) in [("plain.csv", &plain), ("levelled.csv", &levelled)] {
        let log = room.desk.file(name, log);
        for scalar in ["f32", "fixed"] {
            let rmse = rmse(&room, &log, &["--scalar", scalar]);
            assert!(rmse < 0.1, "{name}, {scalar}: {rmse}");
        }
    }
}

/// Logs of six timestamps per exchange with each anchor every 100 ms, with ranges too long by `excess`; every ninth
/// exchange is torn.
fn stamps(excess: f64) -> String {
    let mut rng = stream(5, 0);
    let tag = Clock::draw(&mut rng);
    let clocks = [(); 4].map(|()| Clock::draw(&mut rng));
    let mut log = "t,anchor,t1,t2,t3,t4,t5,t6\n".to_owned();
    for k in 0..1600 {
        let (epoch, anchor) = (k / 4, k % 4);
        let t = 0.1 * f64::from(epoch);
        let range = distance(ANCHORS[anchor as usize], place(t)) + excess;
        let at = t + 0.01 * f64::from(anchor);
        let clocks = [&tag, &clocks[anchor as usize]];
        let stamps = exchange(&mut rng, clocks, (at, range), [1e-3, 2e-3], 0.05);
        let _ = write!(log, "{t:.3},A{anchor}");
        for (place, stamp) in stamps.iter().enumerate() {
            let is_lost = k % 9 == 8 && place > 3;
            let _ = if is_lost { write!(log, ",") } else { write!(log, ",{}", stamp.ticks()) };
        }
        log.push('\n');
    }
    log
}

#[test]
fn differences_are_followed() {
    let room = Room::clean();
    let mut log = "t,anchor_a,anchor_b,difference\n".to_owned();
    let mut crazyflie = "Timestamp,tdoa2.d3-0,tdoa2.d0-1,tdoa2.d1-2,tdoa2.d2-3\n".to_owned();
    for k in 0..4000 {
        let t = 0.01 * k as f64;
        let [one, other] = [k % 4, (k + 1) % 4];
        let noise = ((k * 7919) % 101) as f64 / 1000.0 - 0.05;
        let [far, near] = [other, one].map(|anchor| distance(ANCHORS[anchor], place(t)));
        let difference = far - near + noise;
        let _ = writeln!(log, "{t:.3},A{one},A{other},{difference:.4}");
        let mut columns = [""; 4].map(str::to_owned);
        columns[other] = format!("{difference:.4}");
        let _ = writeln!(crazyflie, "{},{}", 10 * k, columns.join(","));
    }
    for (name, log) in [("plain.csv", log), ("crazyflie.csv", crazyflie)] {
        let log = room.desk.file(name, log);
        for scalar in ["f32", "f64", "fixed"] {
            let rmse = rmse(&room, &log, &["--scalar", scalar]);
            assert!(rmse < 0.12, "{name}, {scalar}: {rmse}");
        }
    }
}

#[test]
fn anchors_are_surveyed_and_their_file_is_taken() {
    let desk = Desk::new();
    let places: [[f64; 3]; 5] =
        [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [8.0, 6.0, 0.0], [1.0, 5.0, 3.0], [4.0, 7.0, 2.0]];
    let mut ranges = "anchor_a,anchor_b,range\n".to_owned();
    for (i, a) in places.iter().enumerate() {
        for (j, b) in places.iter().enumerate().filter(|(j, _)| *j != i) {
            let range = (a[0] - b[0]).hypot(a[1] - b[1]).hypot(a[2] - b[2]);
            let _ = writeln!(ranges, "N{i},N{j},{:.3}", range + 0.01 * ((i + j) % 3) as f64);
        }
    }
    let (ranges, out) = (desk.file("between.csv", ranges), desk.named("anchors.csv"));
    let survey = ["survey", "robot", "--ranges", &ranges, "--out", &out];
    let found = json(&host_sim(&[&survey[..], &["--json"]].concat()));
    for (anchor, place) in found["anchors"].as_array().expect("anchors").iter().zip(places) {
        for (axis, expected) in place.iter().enumerate() {
            let error = anchor["position_m"][axis].as_f64().expect("metres") - expected;
            assert!(error.abs() < 0.1, "{anchor}");
        }
    }
    assert!(text(&host_sim(&survey).stdout).contains("mirror image"));
    let log = desk.file("log.csv", "t,anchor,range\n0,N0,3\n0,N1,7\n0,N2,7\n0,N3,4\n0.1,N4,6\n");
    let replay = ["replay", "robot", "--anchors", &out, "--log", &log, "--dim", "3", "--json"];
    assert!(host_sim(&replay).status.success());
    let few = desk.file("few.csv", "anchor_a,anchor_b,range\na,b,3\nb,c,4\nc,a,5\n");
    let said = refusal(&["survey", "robot", "--ranges", &few, "--out", &desk.named("x.csv")]);
    assert!(said.contains("4 anchors"), "{said}");
}
