//! The foot-mounted IMU: an MPU-9250, a log on a card, the path as telemetry.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use host_sim::systems::pedestrian::recording::log;
use kestirim_pedestrian::{Config, EkfTracker, ImuSample, PathUncertainty};
use kestirim_scalar::{Components, Q12_20, Scalar};
use kestirim_telemetry::{EstimateHealth, Footprint, Health, Imu, Message, Position};
use nalgebra::SVector;
use target_bench::streams::{Encode, Sample, walk};
use target_bench::{App, CORTEX_M0, CORTEX_M4F, Target};

use super::{card, image, telemetry};

/// Half of the sensor's resolution with 16 g and 2000 °/s, and the rounding of single precision.
const FORCE_STEP: f64 = 16.0 / 32768.0 * 9.806_65 / 2.0 + 1e-4;
const RATE_STEP: f64 = 0.001_065_264_436 / 2.0 + 1e-6;

/// The application's messages for these samples, computed on the host: positions, footprints and the path's health in
/// its order, and the length of the path (m).
fn on_host<T: Scalar>(samples: &[Imu]) -> (Vec<Message>, f32) {
    let config = Config::default();
    let mut tracker = EkfTracker::<T>::new(config);
    let mut uncertainty = PathUncertainty::<T>::new(config.sensor);
    let metres = |position: &SVector<T, 3>| position.as_array().map(T::to_f32);
    let footprint = |stride: kestirim_pedestrian::Stride<T>| {
        let (time_us, length) = (stride.time_us, stride.length.to_f32());
        Message::Footprint(Footprint { time_us, position: metres(&stride.position), length })
    };
    let sigma = |uncertainty: &PathUncertainty<T>| {
        let [x, y, _] = *uncertainty.standard_deviation().as_array();
        Some(x.max(y).to_f32())
    };
    let (mut told, mut reasons) = (Vec::new(), None);
    let mut last = Position { time_us: 0, position: [0.0; 3], sigma: None };
    for (index, sample) in samples.iter().enumerate() {
        let estimate = tracker
            .update(&ImuSample {
                time_us: sample.time_us,
                specific_force: SVector::from(sample.specific_force.map(T::from_f32)),
                angular_rate: SVector::from(sample.angular_rate.map(T::from_f32)),
            })
            .expect("a sensor measured this");
        last.time_us = sample.time_us;
        last.position = metres(&estimate.position);
        if (index + 1) % 10 == 0 {
            told.push(Position { sigma: sigma(&uncertainty), ..last }.into());
        }
        if let Some(stride) = estimate.stride {
            uncertainty.add(&stride);
            told.push(footprint(stride));
        }
        let now = tracker.warnings().health().bits();
        if reasons.replace(now) != Some(now) {
            told.push(EstimateHealth { time_us: sample.time_us, reasons: now }.into());
        }
    }
    if let Some(stride) = tracker.finish() {
        uncertainty.add(&stride);
        told.push(footprint(stride));
    }
    told.push(Position { sigma: sigma(&uncertainty), ..last }.into());
    (told, tracker.path_length().to_f32())
}

fn near(ours: [f32; 3], theirs: [f64; 3], tolerance: f64) -> bool {
    ours.iter().zip(theirs).all(|(&ours, theirs)| (f64::from(ours) - theirs).abs() <= tolerance)
}

/// Checks that the samples that were sent are those of the walk, within the sensor's resolution.
fn check_samples(sent: &[Imu], walk: &[Sample]) {
    assert_eq!(sent.len(), walk.len());
    let mut time_us = 0;
    for (sent, felt) in sent.iter().zip(walk) {
        time_us += u64::from(felt.elapsed_us);
        assert_eq!(sent.time_us, time_us);
        let (force, rate) = (felt.specific_force.map(f64::from), felt.angular_rate.map(f64::from));
        assert!(near(sent.specific_force, force, FORCE_STEP), "{sent:?} of {felt:?}");
        assert!(near(sent.angular_rate, rate, RATE_STEP), "{sent:?} of {felt:?}");
    }
}

/// Checks that `host-sim replay pedestrian` reads the log on the card, and that it holds what was sent.
fn check_log<T: Scalar>(text: &[u8], sent: &[Imu], path: f32) -> Result<()> {
    let log = log::parse(Path::new("WALK.TXT"), text, &log::Options::default())?;
    assert_eq!(log.warnings, Vec::<String>::new());
    assert_eq!(log.samples.len(), sent.len());
    for (logged, sent) in log.samples.iter().zip(sent) {
        assert_eq!(logged.time_us, sent.time_us / 1_000 * 1_000, "whole milliseconds");
        // Half of the last decimal: 0.0001 g, 0.01 °/s.
        assert!(near(sent.specific_force, logged.specific_force, 6e-4), "{logged:?} of {sent:?}");
        assert!(near(sent.angular_rate, logged.angular_rate, 9e-5), "{logged:?} of {sent:?}");
    }
    let read: Vec<Imu> = log
        .samples
        .iter()
        .map(|sample| Imu {
            time_us: sample.time_us,
            specific_force: sample.specific_force.map(|value| value as f32),
            angular_rate: sample.angular_rate.map(|value| value as f32),
        })
        .collect();
    let (_, replayed) = on_host::<T>(&read);
    ensure!((replayed - path).abs() < 0.02 * path, "the log walks {replayed} m, the foot {path} m");
    Ok(())
}

fn check<T: Scalar>(target: &'static Target) -> Result<()> {
    let Some(app) = App::of(target, "pedestrian-firmware")? else { return Ok(()) };
    let walk = walk();
    let run = app.run(&walk.encode(), Some(&card::blank()?))?;
    let lines = image::log(&app, &run)?;
    ensure!(run.success, "{}{lines:#?}", run.console);

    let messages = telemetry::messages(&run.telemetry);
    let (health, rest) = messages.split_last().context("something was sent")?;
    let sent: Vec<Imu> = rest
        .iter()
        .filter_map(|message| if let Message::Imu(sample) = message { Some(*sample) } else { None })
        .collect();
    check_samples(&sent, &walk);
    let (expected, path) = on_host::<T>(&sent);
    let told: Vec<Message> =
        rest.iter().filter(|message| !matches!(message, Message::Imu(_))).copied().collect();
    assert_eq!(told, expected, "the very bits");
    ensure!((11.0..14.0).contains(&path), "the route is 12.6 m, not {path}");
    let (time_us, accepted) = (sent.last().context("a walk")?.time_us, walk.len() as u32);
    assert_eq!(*health, Health { time_us, accepted, rejected: 0, failed: 0 }.into());
    assert_eq!(telemetry::doubts(&messages).last(), Some(&0), "the walk is good");

    let mut written = run.card.context("the card")?;
    check_log::<T>(&card::file(&mut written, "WALK.TXT")?, &sent, path)?;

    let count = |text: &str| lines.iter().filter(|line| line.starts_with(text)).count();
    let strides = expected.iter().filter(|told| matches!(told, Message::Footprint(_))).count();
    // The last stride is complete only when the walk is over.
    assert_eq!(count("info Stride("), strides - 1, "{lines:#?}");
    assert!(count("info Stance(") >= strides, "{lines:#?}");
    let last = lines.last().context("something was logged")?;
    assert!(last.starts_with(&format!("info Summary {{ accepted: {accepted}, ")), "{last}");
    assert_eq!(count("info "), lines.len(), "nothing went wrong: {lines:#?}");

    image::check("pedestrian-firmware", &app)
}

#[test]
fn cortex_m0() -> Result<()> {
    check::<Q12_20>(&CORTEX_M0)
}

#[test]
fn cortex_m4f() -> Result<()> {
    check::<f32>(&CORTEX_M4F)
}

#[test]
fn without_a_card_it_says_so() -> Result<()> {
    let Some(app) = App::of(&CORTEX_M4F, "pedestrian-firmware")? else { return Ok(()) };
    let run = app.run(&walk().encode(), None)?;
    assert!(!run.success);
    let lines = image::log(&app, &run)?;
    assert_eq!(lines, ["error Log(DeviceError(CardNotFound))"]);
    Ok(())
}
