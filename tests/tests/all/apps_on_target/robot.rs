//! The robot: a DW1000 on SPI that ranges to four anchors, a BNO055 on I²C, the path as telemetry.

use anyhow::{Context, Result, ensure};
use host_sim::random::{normal, stream};
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_telemetry::{Message, Range};
use kestirim_uwb_tracker::{Anchor, CalibratedPlaneTracker, Config, InertialSample, RangeSample};
use nalgebra::{SVector, Vector2};
use robot_app::{HEIGHT, SITES};
use target_bench::{App, RV32IMC};

use super::{image, telemetry};

/// The error that an exchange adds to a range, m: a tick of the counters is 4.7 mm.
const TICK: f32 = 0.005;
/// The error that this adds to a position, m.
const APART: f64 = 0.02;
/// The duration of an anchor's turn, µs, and the number of turns.
const TURN: u32 = 25_000;
const STEPS: u32 = 1_200;

/// The measurements of the robot's devices in one turn.
struct Turn {
    /// The position of the robot, m.
    tag: [f64; 2],
    /// The range to the anchor whose turn it is, m; `None` if the anchor is silent.
    range: Option<f32>,
    /// The acceleration, cm/s².
    acceleration: [i32; 3],
}

fn metres(centimetres: i32) -> f64 {
    f64::from(centimetres) / 100.0
}

/// Two rounds on an ellipse among the anchors, which are silent now and then.
fn ride() -> Vec<Turn> {
    let mut rng = stream(5, 0);
    let turn = |step: u32| {
        let angle = 0.3 * f64::from(step * TURN) * 1e-6;
        let tag = [5.0 + 3.0 * angle.cos(), 4.0 + 2.0 * angle.sin()];
        let [x, y, z] = SITES[step as usize % SITES.len()].place.map(metres);
        let squares = [x - tag[0], y - tag[1], z - metres(HEIGHT)].map(|side| side * side);
        let range = squares.iter().sum::<f64>().sqrt() + normal(&mut rng, 0.05);
        let shake = [0.0, 0.0, 981.0].map(|mean| (mean + normal(&mut rng, 30.0)) as i32);
        Turn { tag, range: (step % 13 != 7).then_some(range as f32), acceleration: shake }
    };
    (0..STEPS).map(turn).collect()
}

fn encode(ride: &[Turn]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (step, turn) in ride.iter().enumerate() {
        bytes.extend(if step == 0 { 0 } else { TURN }.to_le_bytes());
        bytes.extend(turn.range.unwrap_or(f32::NAN).to_le_bytes());
        bytes.extend(turn.acceleration.iter().flat_map(|count| count.to_le_bytes()));
    }
    bytes
}

/// The position of the robot after every range, as the host's own tracker estimates it.
fn on_host(ride: &[Turn], ranges: &[Range]) -> Vec<[f32; 2]> {
    let anchors = SITES.map(|site| Anchor {
        position: SVector::from(site.place.map(|cm| Q12_20::from_micro(10_000 * cm))),
        bias: Q12_20::ZERO,
    });
    let config = Config::calibrated(Q12_20::from_micro(10_000 * HEIGHT));
    let mut tracker = CalibratedPlaneTracker::<Q12_20, 4>::new(config, &anchors).expect("a room");
    let mut ranges = ranges.iter().peekable();
    let mut path = Vec::new();
    for (step, turn) in ride.iter().enumerate() {
        let time_us = step as u64 * u64::from(TURN);
        let acceleration =
            SVector::from(turn.acceleration.map(|count| Q12_20::from_micro(10_000 * count)));
        let sample = InertialSample { time_us, acceleration, push: None };
        tracker.inertial(&sample).expect("an acceleration");
        let Some(range) = ranges.next_if(|range| range.time_us == time_us) else { continue };
        let (anchor, range) = (usize::from(range.anchor), Q12_20::from_f32(range.range));
        tracker.range(&RangeSample { time_us, anchor, range }).expect("a range");
        let position = tracker.position().map(|position| position.map(Scalar::to_f32));
        path.extend(position.map(<[f32; 2]>::from));
    }
    path
}

#[test]
fn rv32imc() -> Result<()> {
    let Some(app) = App::of(&RV32IMC, "robot-firmware")? else { return Ok(()) };
    let ride = ride();
    let run = app.run(&encode(&ride), None)?;
    ensure!(run.success, "{}", run.console);

    let messages = telemetry::messages(&run.telemetry);
    let (mut ranges, mut path, mut health, mut doubts) = (Vec::new(), Vec::new(), None, None);
    for message in messages {
        match message {
            Message::Range(range) => ranges.push(range),
            Message::Position(position) => path.push(position),
            Message::Health(counts) => health = Some(counts),
            Message::EstimateHealth(estimate) => doubts = Some(estimate.reasons),
            other => anyhow::bail!("{other:?}"),
        }
    }
    // Two-way ranging as a whole yields the true ranges, with the turn's time and anchor.
    let measured: Vec<Range> = (0_u32..)
        .zip(&ride)
        .filter_map(|(step, turn)| {
            let (time_us, anchor) = (u64::from(step * TURN), step as u16 % SITES.len() as u16);
            Some(Range { time_us, anchor, range: turn.range? })
        })
        .collect();
    assert_eq!(ranges.len(), measured.len());
    let mut worst = 0_f32;
    for (told, measured) in ranges.iter().zip(&measured) {
        assert_eq!((told.time_us, told.anchor), (measured.time_us, measured.anchor));
        worst = worst.max((told.range - measured.range).abs());
    }
    ensure!(worst < TICK, "a range is {worst} m off");
    // The path is bit for bit what the host computes from the ranges that were sent.
    let told: Vec<[f32; 2]> =
        path.iter().map(|told| [told.position[0], told.position[1]]).collect();
    assert_eq!(told, on_host(&ride, &ranges));
    // The path is close to that from the true ranges, and to the robot's.
    let ideal = on_host(&ride, &measured);
    assert_eq!(told.len(), ideal.len());
    let (mut apart, mut squares) = (0_f64, 0.0);
    for ((told, ideal), position) in told.iter().zip(&ideal).zip(&path) {
        let [told, ideal] = [told, ideal].map(|place| Vector2::from(place.map(f64::from)));
        apart = apart.max((told - ideal).norm());
        let tag = ride[(position.time_us / u64::from(TURN)) as usize].tag;
        squares += (told - Vector2::from(tag)).norm_squared();
    }
    ensure!(apart < APART, "a position is {apart} m off");
    let rmse = (squares / path.len() as f64).sqrt();
    ensure!(rmse < 0.1, "the path is {rmse} m off");
    assert_eq!(doubts, Some(0), "the path is good");
    let silent = STEPS - measured.len() as u32;
    let health = health.context("health was told")?;
    assert_eq!((health.accepted as usize, health.failed), (measured.len() - 4, silent));

    let lines = image::log(&app, &run)?;
    let count = |text: &str| lines.iter().filter(|line| line.starts_with(text)).count();
    assert_eq!(count("info Step { anchor: 3, range: Ok(Started)"), 1, "{lines:#?}");
    assert_eq!(count("warn "), silent as usize, "{lines:#?}");
    println!(
        "{} exchanges: ranges at most {:.1} mm and positions {:.1} mm from the host's, {rmse:.3} m from the robot",
        measured.len(),
        worst * 1e3,
        apart * 1e3,
    );
    image::check("robot-firmware", &app)
}
