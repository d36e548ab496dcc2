//! The foot's node on embassy and on RTIC: samples arrive on a serial port, byte by byte by interrupt, and the output
//! equals what the host computes, bit for bit.

use anyhow::{Result, ensure};
use foot_node::{FRAME, Node};
use kestirim_pedestrian::SensorClass;
use kestirim_telemetry::{Footprint, Health, Imu, Message, encode};
use target_bench::streams::walk;
use target_bench::{App, CORTEX_M4F};

use super::{image, telemetry};

/// A walk as frames, with noise between two of them and a farewell at the end; and the number of frames.
fn line() -> (Vec<u8>, u32) {
    let (mut line, mut sequence, mut time_us) = (Vec::new(), 0, 0);
    let mut send = |message: Message, line: &mut Vec<u8>| {
        let mut buffer = [0; FRAME];
        line.extend(encode(&message, sequence, &mut buffer).expect("room"));
        sequence += 1;
    };
    let walk = walk();
    for (index, sample) in walk.iter().enumerate() {
        time_us += u64::from(sample.elapsed_us);
        let (specific_force, angular_rate) = (sample.specific_force, sample.angular_rate);
        send(Imu { time_us, specific_force, angular_rate }.into(), &mut line);
        if index == 100 {
            line.extend(b"noise\0");
        }
    }
    send(Health { time_us, accepted: 0, rejected: 0, failed: 0 }.into(), &mut line);
    (line, walk.len() as u32)
}

fn on_host(line: &[u8]) -> Vec<u8> {
    let (mut node, mut sent) = (Node::new(SensorClass::Consumer), Vec::new());
    let mut buffer = [0; FRAME];
    for &byte in line {
        sent.extend(node.take(byte, &mut buffer).iter().flat_map(|answer| answer.frame));
    }
    sent
}

fn check(program: &'static str, resumed: &[&str]) -> Result<()> {
    let Some(app) = App::of_machine(&CORTEX_M4F, program)? else { return Ok(()) };
    let (line, samples) = line();
    let run = app.run_on_line(&line)?;
    ensure!(run.success, "{}", run.console);
    assert_eq!(run.telemetry, on_host(&line), "the very bits");

    let messages = telemetry::messages(&run.telemetry);
    let strides: Vec<&Footprint> = messages
        .iter()
        .filter_map(
            |message| if let Message::Footprint(stride) = message { Some(stride) } else { None },
        )
        .collect();
    let path: f32 = strides.iter().map(|stride| stride.length).sum();
    ensure!((9.0..14.0).contains(&path), "the route is 12.6 m, not {path}");
    let Some(Message::Health(health)) = messages.last() else { panic!("no farewell") };
    assert_eq!((health.accepted, health.rejected, health.failed), (samples, 0, 1));
    assert_eq!(telemetry::doubts(&messages).last(), Some(&0), "the walk is good");
    assert_eq!(image::log(&app, &run)?, ["info farewell"]);
    image::check_panics_but_in(resumed, program, &app)
}

#[test]
fn on_embassy() -> Result<()> {
    check("foot-embassy", &["apps/foot-embassy/src/main.rs", "apps/foot-embassy/src/serial.rs"])
}

#[test]
fn on_rtic() -> Result<()> {
    check("foot-rtic", &["apps/foot-rtic/src/main.rs"])
}
