//! Rooms in which all anchors but two fall silent after a third of the recording. With `--nocapture` each pair is
//! printed.
//!
//! The recordings are in `../shared/data/robot`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead.

use host_sim::system::HealthState;
use host_sim::systems::robot::{recording::Recording, track};
use kestirim_replay::robot::{Event, Setup};
use kestirim_tests::recordings::folder_of;

use crate::robot_sigmas::opened;

const ROOMS: [&str; 5] = ["lias_mid_tag0", "trek_4vba1", "trek_m2r", "esp32_los2", "isas_walk1"];
/// The largest number of pairs that are tried in a room.
const MOST_PAIRS: usize = 7;

/// The share of positions that are off by more than three standard deviations although they are reported as good, and
/// the share of those reported as good.
struct Told {
    silent: f64,
    good: f64,
}

fn with_two(recording: &mut Recording, pair: [usize; 2]) {
    for part in &mut recording.parts {
        let times = || part.events.iter().map(Event::time_us);
        let Some((first, last)) = times().min().zip(times().max()) else { continue };
        let third = first + (last - first) / 3;
        part.events.retain(|event| match event {
            Event::Range(range) => range.time_us < third || pair.contains(&range.anchor),
            _ => true,
        });
    }
}

fn told(recording: &Recording, setup: &Setup) -> Told {
    let traces = track::track(recording, setup).expect("a track");
    let (mut all, mut silent, mut good) = (0, 0, 0);
    for (part, trace) in recording.parts.iter().zip(&traces) {
        for epoch in &trace.epochs {
            let truth = part.truth.as_ref().and_then(|truth| truth.at(epoch.time_us));
            let Some(((position, sigma), truth)) = epoch.position.zip(epoch.sigma_m()).zip(truth)
            else {
                continue;
            };
            let error = (position[0] - truth[0]).hypot(position[1] - truth[1]);
            let is_good = epoch.health.state() == HealthState::Good;
            all += 1;
            good += usize::from(is_good);
            silent += usize::from(is_good && error > 3.0 * sigma);
        }
    }
    Told { silent: silent as f64 / all as f64, good: good as f64 / all as f64 }
}

#[test]
fn what_two_anchors_do_not_tell_is_said() {
    let Some(folder) = folder_of("robot") else { return };
    println!("| | anchors | silent and beyond 3 σ | good |\n|---|---|---|---|");
    let mut doubted = 0;
    for room in ROOMS {
        let (recording, setup) = opened(&folder, room, "2");
        let count = recording.anchors.names.len();
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let every = (count * (count - 1) / 2).div_ceil(MOST_PAIRS);
        for pair in pairs.step_by(every) {
            let mut recording = recording.clone();
            with_two(&mut recording, pair);
            let Told { silent, good } = told(&recording, &setup);
            println!(
                "| `{room}` | {} and {} | {:.1} % | {:.0} % |",
                recording.anchors.names[pair[0]],
                recording.anchors.names[pair[1]],
                100.0 * silent,
                100.0 * good
            );
            assert!(silent < 0.05, "{room}, {pair:?}: {silent}");
            doubted += usize::from(good < 0.9);
        }
    }
    assert!(doubted > 10, "{doubted}: a side is not known in many of them");
}
