//! A robot on wheels of whose ranges some are lost. With `--nocapture` the errors are printed.
//!
//! The recordings are in `../shared/data/robot`, beside the repository. Where they are absent this test prints SKIPPED
//! and passes; with `KESTIRIM_REQUIRE_DATA=1` it fails instead.

use host_sim::system::HealthState;
use host_sim::systems::robot::{recording::Recording, track};
use kestirim_replay::robot::{Event, Setup};
use kestirim_simulate::random::{stream, uniform};
use kestirim_tests::recordings::folder_of;

use crate::robot_sigmas::opened;

/// The number of draws of each share.
const DRAWS: u64 = 100;
/// The time before which the heading need not be known, µs.
const BEGINNING_US: i64 = 5_000_000;

/// The recording with about this percentage of its ranges.
fn thinned(recording: &Recording, percent: u64, draw: u64) -> Recording {
    let mut random = stream(percent, draw);
    let mut recording = recording.clone();
    for part in &mut recording.parts {
        part.events.retain(|event| {
            !matches!(event, Event::Range(_)) || 100.0 * uniform(&mut random) < percent as f64
        });
    }
    recording
}

/// The RMSE after the beginning, m, and the share of positions said to be good that are off by more than three standard deviations.
fn told(recording: &Recording, setup: &Setup) -> [f64; 2] {
    let traces = track::track(recording, setup).expect("a track");
    let (mut squares, mut all, mut silent) = (0.0, 0, 0);
    for (part, trace) in recording.parts.iter().zip(&traces) {
        let begin = trace.epochs.first().map_or(0, |epoch| epoch.time_us);
        for epoch in trace.epochs.iter().filter(|it| it.time_us - begin > BEGINNING_US) {
            let truth = part.truth.as_ref().and_then(|truth| truth.at(epoch.time_us));
            let Some(((position, sigma), truth)) = epoch.position.zip(epoch.sigma_m()).zip(truth)
            else {
                continue;
            };
            let error = (position[0] - truth[0]).hypot(position[1] - truth[1]);
            let is_good = epoch.health.state() == HealthState::Good;
            squares += error * error;
            silent += usize::from(is_good && error > 3.0 * sigma);
            all += 1;
        }
    }
    [(squares / all as f64).sqrt(), silent as f64 / all as f64]
}

#[test]
fn a_robot_on_wheels_needs_few_ranges() {
    let Some(folder) = folder_of("robot") else { return };
    let (recording, setup) = opened(&folder, "labyrinth", "2");
    assert!(setup.has_wheels);
    println!(
        "| ranges kept | median RMSE, m | largest | silent and beyond 3 σ, mean |\n|---|---|---|---|"
    );
    for (percent, most) in [(70, 0.16), (50, 0.25), (30, 0.42)] {
        let draws = (0..DRAWS).map(|draw| told(&thinned(&recording, percent, draw), &setup));
        let (mut errors, silent): (Vec<f64>, Vec<f64>) = draws.map(|[a, b]| (a, b)).unzip();
        errors.sort_by(f64::total_cmp);
        let (median, largest) = (errors[errors.len() / 2], errors[errors.len() - 1]);
        let silent = silent.iter().sum::<f64>() / silent.len() as f64;
        println!("| {percent} % | {median:.2} | {largest:.2} | {:.1} % |", 100.0 * silent);
        assert!(median < most && silent < 0.06, "{percent} %: {median} m, {silent}");
    }
}
