//! What the programs read: recordings, and what is made here where a recording would be too much for a test.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::ppp::{Epochs, station};

/// Numbers of a stream, little-endian.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn whole(&mut self, number: u32) {
        self.0.extend(number.to_le_bytes());
    }

    fn floats(&mut self, numbers: &[f64]) {
        self.0.extend(numbers.iter().flat_map(|number| (*number as f32).to_le_bytes()));
    }

    fn doubles(&mut self, numbers: &[f64]) {
        self.0.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }
}

/// The rows of a table with a head.
fn table(file: &Path) -> Result<Vec<Vec<f64>>> {
    let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
    let row = |line: &str| {
        line.split(',').map(|cell| Ok(cell.trim().parse()?)).collect::<Result<Vec<f64>>>()
    };
    text.lines().skip(1).map(row).collect()
}

fn micros(seconds: f64) -> u64 {
    (seconds * 1e6).round() as u64
}

/// Twenty seconds of a walk with a foot-mounted IMU at 200 Hz (exp31 of the data of geodetic control points).
pub(crate) fn walk(data: &Path) -> Result<Vec<u8>> {
    let mut bytes = Bytes::default();
    let mut last_us = 0;
    for row in table(&data.join("pedestrian/gcp/exp31_imu.csv"))?.iter().take(4000) {
        let time_us = micros(row[0]);
        bytes.whole((time_us - last_us) as u32);
        bytes.floats(&row[1..7]);
        last_us = time_us;
    }
    Ok(bytes.0)
}

/// Ranges and wheels of a robot on a square (plaza1); and an IMU that shakes a little, made here.
pub(crate) fn drive(data: &Path) -> Result<Vec<u8>> {
    let folder = data.join("robot/plaza1");
    let anchors = table(&folder.join("anchors.csv"))?;
    let mut bytes = Bytes::default();
    bytes.whole(anchors.len() as u32);
    bytes.whole(0);
    bytes.floats(&[0.5]);
    for anchor in &anchors {
        bytes.floats(&[anchor[1], anchor[2], anchor[3], 0.0]);
    }
    let place = |name: f64| anchors.iter().position(|anchor| anchor[0] == name);
    let mut events = Vec::new();
    for row in table(&folder.join("ranges.csv"))? {
        let anchor = place(row[1]).context("a known anchor")? as u32;
        events.push((micros(row[0]), 0, anchor, [row[2], 0.0, 0.0]));
    }
    for (index, row) in table(&folder.join("odom.csv"))?.iter().enumerate() {
        let speed = f64::midpoint(row[1], row[2]);
        let turn_rate = (row[2] - row[1]) / row[3];
        events.push((micros(row[0]), 2, 0, [speed, turn_rate, 0.0]));
        let shake = 0.3 * (index as f64 * 0.7).sin() * speed;
        events.push((micros(row[0]), 1, 0, [shake, -shake, 9.8 + shake]));
    }
    events.sort_by_key(|(time_us, kind, ..)| (*time_us, *kind));
    let mut last_us = events.first().map_or(0, |event| event.0);
    for (time_us, kind, anchor, values) in events.into_iter().take(3000) {
        bytes.whole((time_us - last_us) as u32);
        bytes.whole(kind);
        bytes.whole(anchor);
        bytes.floats(&values);
        last_us = time_us;
    }
    Ok(bytes.0)
}

/// Levels that a drone received from a `LoRa` transmitter.
pub(crate) fn search(data: &Path) -> Result<Vec<u8>> {
    let folder = data.join("drone/lora_20190619");
    let area = table(&folder.join("lora_20190619-area.csv"))?;
    let mut bytes = Bytes::default();
    bytes.whole(area.len() as u32);
    for corner in &area {
        bytes.floats(&corner[..2]);
    }
    for row in table(&folder.join("lora_20190619.csv"))? {
        bytes.floats(&row[1..5]);
    }
    Ok(bytes.0)
}

/// Four seconds at 100 Hz of an aircraft that is shaken, with a gap, outputs that are missing, and a spike.
pub(crate) fn flight() -> Vec<u8> {
    let mut bytes = Bytes::default();
    for index in 0..400_u32 {
        bytes.whole(if index == 200 { 130_000 } else { 10_000 });
        bytes.whole(if index % 10 == 3 { 5 } else { 7 });
        let t = f64::from(index) * 0.01;
        let elevator = 0.02 * (3.0 * t).sin();
        bytes.floats(&[elevator, 0.05 * (0.7 * t).cos()]);
        let spike = if index == 300 { 20.0 } else { 0.0 };
        let rate = -0.2 * (3.0 * t + 0.4).sin() + 0.004 * (57.0 * t).cos();
        let airspeed = 1.2 * (0.9 * t).sin() + 0.3 * (91.0 * t).sin() + spike;
        bytes.floats(&[rate, airspeed, 0.07 * (3.0 * t + 0.4).cos()]);
    }
    bytes.0
}

/// Epochs of ten satellites above a station, made by the filter's own model, with two outliers.
pub(crate) fn epochs() -> Vec<u8> {
    let mut bytes = Bytes::default();
    for epoch in Epochs::at(station()) {
        bytes.0.extend(epoch.time.day().to_le_bytes());
        bytes.whole(epoch.observations.len() as u32);
        bytes.doubles(&[epoch.time.second()]);
        for observation in &epoch.observations {
            let state = &observation.state;
            bytes.doubles(&[f64::from(observation.satellite)]);
            bytes.doubles(&observation.code);
            bytes.doubles(&observation.phase);
            bytes.doubles(state.position.as_slice());
            bytes.doubles(state.velocity.as_slice());
            bytes.doubles(&[state.clock, state.clock_interval, state.clock_distance]);
        }
    }
    bytes.0
}
