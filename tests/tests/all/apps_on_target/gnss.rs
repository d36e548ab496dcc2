//! The receiver of carrier phases: a u-blox module and a modem with products on serial ports, the station's position as
//! telemetry.

use anyhow::{Result, bail, ensure};
use gnss_app::{STATES, site};
use kestirim_gnss_files::{self as files, Antennas, Clocks, Orbits, Text};
use kestirim_ppp_filter::{PppFilter, SatelliteObservation, Slipped, Solution};
use kestirim_replay::gnss::Products;
use kestirim_scalar::Components;
use kestirim_telemetry::{GlobalPosition, Message};
use kestirim_tests::ppp::{OUTLIERS, START, station};
use nalgebra::Vector3;
use target_bench::{App, CORTEX_M4F};

use super::gnss_stream::{
    ONE_CARRIER, Observed, SLIP, SLIPPED, UNKNOWN, clocks, encode, observe, orbits,
};
use super::{image, telemetry};

/// The time between epochs, µs.
const INTERVAL_US: u64 = 30_000_000;
/// The largest accepted error of the position, m, given codes of ten satellites and few epochs.
const CLOSE: f64 = 2.5;

/// The solutions of the host's own readers and filter from the same files and observations.
fn on_host(epochs: &[Observed]) -> Result<Vec<Solution<STATES>>> {
    let text = |text: String| Text::unpack("file", text.into_bytes());
    let orbits = Orbits::parse(&[text(orbits())?])?;
    let clocks = Clocks::parse(&[text(clocks(epochs.len()))?])?;
    let start = files::GpsTime::new(START.day(), START.second());
    let products = Products::new(start, &orbits, Some(&clocks), &Antennas::default());
    let mut filter = PppFilter::new(site::config());
    let solve = |epoch: &Observed| {
        let sighting = |sighting: &SatelliteObservation<'_>| {
            let observed = files::Observed {
                prn: sighting.satellite,
                code: sighting.code.map(Some),
                phase: sighting.phase.map(Some),
                loss_of_lock: [false, sighting.lock_lost],
                ..files::Observed::default()
            };
            let sighting =
                products.observation(epoch.time(), &observed).expect("there are products");
            SatelliteObservation { antenna: site::satellite_antenna(), ..sighting }
        };
        let observations: Vec<_> = epoch.observations.iter().map(sighting).collect();
        Ok(filter.process(epoch.time(), &site::receiver(), &observations)?)
    };
    epochs.iter().map(solve).collect()
}

/// The message that the target must send for a solution.
fn position(index: usize, solution: &Solution<STATES>) -> GlobalPosition {
    let sigma = Some((solution.covariance.trace() / 3.0).sqrt() as f32);
    let time_us = INTERVAL_US * (index as u64 + 1);
    GlobalPosition { time_us, position: *solution.position.as_array(), sigma }
}

/// The lines that the target must log for a solution.
fn log(solution: &Solution<STATES>) -> Vec<String> {
    let mut lines =
        vec![format!("warn G{ONE_CARRIER} Incomplete"), format!("warn G{UNKNOWN} NoOrbit")];
    for report in &solution.satellites {
        for (what, decision) in [("code", &report.code), ("phase", &report.phase)] {
            if decision.was_treated() {
                lines.push(format!("warn G{} {what} {:?}", report.satellite, decision.reason));
            }
        }
        if let Some(slipped @ (Slipped::Seen(_) | Slipped::Contradicted)) = report.slipped {
            lines.push(format!("info G{} slipped: {slipped:?}", report.satellite));
        }
    }
    lines
}

/// Checks that all faults are found, and nothing else. (The ionosphere of the images is a flat layer, which low
/// satellites cross so obliquely that their phases on L1 and L2 diverge by decimetres: that looks like slips, and is
/// excluded here.)
fn check_faults(solutions: &[Solution<STATES>]) -> Result<()> {
    for (index, solution) in solutions.iter().enumerate() {
        let mut told = log(solution).split_off(2);
        told.retain(|line| !line.ends_with("slipped: Seen(GeometryFree)"));
        match (index, &*told) {
            (SLIP, [line]) => {
                assert_eq!(*line, format!("info G{SLIPPED} slipped: Seen(LossOfLock)"));
            }
            (OUTLIERS, [phase, code]) => {
                ensure!(phase.starts_with("warn G2 phase") && code.starts_with("warn G7 code"));
            }
            (_, []) => {}
            (_, lines) => bail!("epoch {index}: {lines:?}"),
        }
    }
    Ok(())
}

#[test]
fn cortex_m4f() -> Result<()> {
    let Some(app) = App::of_machine(&CORTEX_M4F, "gnss-firmware")? else { return Ok(()) };
    let epochs = observe();
    let run = app.run(&encode(&epochs), None)?;
    ensure!(run.success, "{}", run.console);

    let (mut path, mut health, mut doubts) = (Vec::new(), None, Vec::new());
    for message in telemetry::messages(&run.telemetry) {
        match message {
            Message::GlobalPosition(position) => path.push(position),
            Message::Health(counts) => health = Some(counts),
            Message::EstimateHealth(estimate) => doubts.push(estimate.reasons),
            other => bail!("{other:?}"),
        }
    }
    let solutions = on_host(&epochs)?;
    let expected: Vec<_> =
        solutions.iter().enumerate().map(|(index, solution)| position(index, solution)).collect();
    assert_eq!(path, expected, "the very bits");
    for position in &path {
        let error = (Vector3::from(position.position) - station()).norm();
        println!("{error:.3} m from the station, sigma {:?} m", position.sigma);
        ensure!(error < CLOSE, "the station is found {error} m off");
    }
    // A damaged message and a damaged line.
    let counts = health.map(|health| (health.accepted as usize, health.rejected, health.failed));
    assert_eq!(counts, Some((epochs.len(), 0, 2)));

    let expected: Vec<_> =
        solutions.iter().map(|solution| solution.health.in_short().bits()).collect();
    assert_eq!(doubts, expected);

    let lines = image::log(&app, &run)?;
    assert_eq!(lines, solutions.iter().flat_map(log).collect::<Vec<_>>());
    check_faults(&solutions)?;
    image::check_panics("gnss-firmware", &app)
}
