//! Recorded ranges, smoothed: the positions of the tag, given the measurements before and after. Anchors are not
//! calibrated.
//!
//! The recordings are in `../shared/data/robot`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

use host_sim::metrics::mean;
use host_sim::systems::robot::recording::{Part, Recording, Truth};
use host_sim::systems::robot::track::{Tracks, track};
use kestirim_replay::robot::{Course, Epoch, Event, Setup, Trace, Tracked, Unsmoothed, smooth};
use kestirim_tests::recordings::folder_of;

use crate::robot_sigmas::{MOVING, STANDING, Told, opened};

/// The largest accepted root mean square error of each recording's positions, m: the published goal where there is one,
/// else a tenth more than was measured. All are below the tracker's, except for recordings of a stationary tag.
const GOALS: [(&str, f64); 13] = [
    ("plaza1", 0.25),
    ("labyrinth", 0.06),
    ("isas_walk1", 0.09),
    ("miluv_obst_random3_tag10", 0.25),
    ("inrol_env1", 0.105),
    ("lias_mid_tag0", 0.08),
    ("lias_mid_tag1", 0.08),
    ("lias_mid_tag2", 0.08),
    ("trek_m1l", 0.12),
    ("trek_m2r", 0.12),
    ("trek_m3s", 0.18),
    ("esp32_los2", 0.13),
    ("lias_static_814", 0.07),
];

/// Recordings that the smoother leaves to the tracker: three anchors of which mostly only one is received, or none
/// without a wall before it; and a tag that stands among four anchors, with a person before one or two of them, where
/// nothing determines the anchors' own biases.
const LEFT: [(&str, Unsmoothed); 6] = [
    ("esp32_nlos1", Unsmoothed::CommonBias),
    ("esp32_wall2", Unsmoothed::CommonBias),
    ("trek_4vba02", Unsmoothed::LessCertain),
    ("trek_4vba1", Unsmoothed::LessCertain),
    ("trek_4vba2s", Unsmoothed::LessCertain),
    ("trek_4vba12", Unsmoothed::Contradicts),
];

fn smoothed(name: &str, dimensions: &str) -> Option<(Recording, Tracks)> {
    let (recording, setup) = opened(&folder_of("robot")?, name, dimensions);
    let tracks = Tracks::smoothed_too(&recording, &setup).expect("a track");
    Some((recording, tracks))
}

#[test]
fn recordings_are_nearer_the_truth_and_say_how_near() {
    println!(
        "| | RMSE, cm | told, cm | error over it | 90 % regions hold |\n|---|---|---|---|---|"
    );
    let mut all = Vec::new();
    for (name, dimensions) in MOVING.iter().chain(&STANDING) {
        let Some((recording, tracks)) = smoothed(name, dimensions) else { return };
        let left = LEFT.iter().find(|(left, _)| left == name).map(|(_, reason)| *reason);
        assert_eq!(
            tracks.smoothed.as_ref().and_then(|it| it.as_ref().err().copied()),
            left,
            "{name}"
        );
        if left.is_some() {
            continue;
        }
        let told = Told::of_parts(&recording, &tracks.best());
        told.print(name);
        if let Some((_, goal)) = GOALS.iter().find(|(of, _)| of == name) {
            assert!(told.rmse_m() <= *goal, "{name}: {} m", told.rmse_m());
        }
        assert!((0.3..2.5).contains(&told.ratio()), "{name}: {}", told.ratio());
        all.push(told);
    }
    let together = Told::together(&all);
    together.print("together");
    assert!((0.7..1.5).contains(&together.ratio()), "{}", together.ratio());
}

/// Without wheels the tracker hardly follows the mower: each anchor is received every two seconds.
#[test]
fn a_mower_is_found_without_its_wheels() {
    let Some(folder) = folder_of("robot") else { return };
    let (mut recording, mut setup) = opened(&folder, "plaza1", "2");
    recording.parts[0]
        .events
        .retain(|event| !matches!(event, kestirim_replay::robot::Event::Wheels(_)));
    setup.has_wheels = false;
    let tracks = Tracks::smoothed_too(&recording, &setup).expect("a track");
    let [tracked, smoothed] = [
        Told::of_parts(&recording, &[&tracks.traces[0].epochs]),
        Told::of_parts(&recording, &tracks.best()),
    ];
    smoothed.print("plaza1, without its wheels");
    assert!(tracked.rmse_m() <= 1.6, "{} m", tracked.rmse_m());
    assert!(smoothed.rmse_m() <= 0.6, "{} m", smoothed.rmse_m());
}

/// In the two outdoor recordings the truth consists of the cones that were walked to, with times noted by hand: what
/// counts is the distance to the line between them.
#[test]
fn a_walk_between_cones_is_found_with_one_beacon_blocked() {
    for (name, goal) in [("outdoor_blocked", 0.35), ("outdoor_square", 0.25)] {
        let Some((recording, tracks)) = smoothed(name, "2") else { return };
        let Some(Truth::Course(truth)) = &recording.parts[0].truth else { panic!("{name}") };
        let across = across(tracks.best()[0], truth);
        println!("{name}: {:.1} cm across the way", 100.0 * across);
        assert!(tracks.smoothed().is_some() && across <= goal, "{name}: {across} m");
    }
}

/// The last position from the measurements of a window of `seconds`, smoothed alone, at sixty times of each part: what
/// a window with the smoother's models would estimate while the tag moves.
#[test]
#[ignore = "a measurement: cargo test -p kestirim-tests --test all robot_smoothed::causal -- --ignored --nocapture"]
fn causal_windows_are_no_nearer_than_the_tracker() {
    println!("| | the tracker's RMSE, m | of 10 s | of all so far |\n|---|---|---|---|");
    let mut totals = [0.0; 3];
    for (name, dimensions) in MOVING {
        let Some(folder) = folder_of("robot") else { return };
        let (recording, setup) = opened(&folder, name, dimensions);
        let traces = track(&recording, &setup).expect("a track");
        let errors = [10.0, f64::INFINITY].map(|seconds| {
            let parts = recording.parts.iter().zip(&traces);
            let squares: Vec<_> =
                parts.flat_map(|(part, trace)| at_ends(&setup, part, trace, seconds)).collect();
            [0, 1].map(|which| mean(&squares.iter().map(|pair| pair[which]).collect::<Vec<_>>()))
        });
        let [[tracked, window], [_, all]] = errors.map(|squares| squares.map(f64::sqrt));
        println!("| `{name}` | {tracked:.3} | {window:.3} | {all:.3} |");
        for (total, error) in totals.iter_mut().zip([tracked, window, all]) {
            *total += error.ln();
        }
    }
    let [tracked, window, all] = totals.map(|total| (total / MOVING.len() as f64).exp());
    println!("| geometric mean | {tracked:.3} | {window:.3} | {all:.3} |");
    assert!(window > 1.05 * tracked && all > 0.95 * tracked, "a window pays now");
}

/// The squared errors of the tracker's last position and of the smoother's (or the tracker's again where that has
/// none), at the ends of stretches of `seconds` seconds.
fn at_ends(setup: &Setup, part: &Part, trace: &Trace, seconds: f64) -> Vec<[f64; 2]> {
    // For each epoch: its time, and the numbers of events and ranges up to its end.
    let (mut ends, mut ranges) = (Vec::new(), 0);
    for (index, event) in part.events.iter().enumerate() {
        match event {
            Event::Range(_) => ranges += 1,
            Event::EpochEnd { time_us } => ends.push((*time_us, index + 1, ranges)),
            _ => {}
        }
    }
    let count = ends.len().min(trace.epochs.len());
    let stretch = |last: usize| {
        let (time_us, events, ranges) = ends[last];
        let is_before = |end: &&(i64, usize, usize)| (time_us - end.0) as f64 * 1e-6 > seconds;
        let before = ends.iter().take_while(is_before).count();
        let (_, first_event, first_range) = before.checked_sub(1).map_or((0, 0, 0), |k| ends[k]);
        let cut = Trace {
            epochs: trace.epochs[before..=last].to_vec(),
            ranges: trace.ranges[first_range..ranges].to_vec(),
        };
        let events = &part.events[first_event..events];
        let smoothed = smooth(setup, &[Tracked { events, trace: &cut }], false).ok();
        let tracked = trace.epochs[last].position?;
        let smoothed = smoothed.and_then(|it| it.parts[0].last()?.position).unwrap_or(tracked);
        let truth = part.truth.as_ref()?.at(time_us)?;
        Some([tracked, smoothed].map(|at| (at[0] - truth[0]).powi(2) + (at[1] - truth[1]).powi(2)))
    };
    (1..=60).filter_map(|k| stretch((k * count / 60).checked_sub(1)?)).collect()
}

/// The root mean square distance (m) to the line between the true positions within five seconds.
fn across(epochs: &[Epoch], truth: &Course<2>) -> f64 {
    let rows = truth.rows();
    let times = rows[0].0..=rows[rows.len() - 1].0;
    let apart = epochs.iter().filter(|epoch| times.contains(&epoch.time_us)).filter_map(|epoch| {
        let ([x, y, _], now_us) = (epoch.position?, epoch.time_us);
        let near = rows
            .windows(2)
            .filter(|pair| pair[1].0 >= now_us - 5_000_000 && pair[0].0 <= now_us + 5_000_000);
        let distances = near.map(|pair| {
            let ([ax, ay], [bx, by]) = (pair[0].1, pair[1].1);
            let (dx, dy) = (bx - ax, by - ay);
            let along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy).max(1e-9);
            let along = along.clamp(0.0, 1.0);
            (x - ax - along * dx).hypot(y - ay - along * dy)
        });
        Some(distances.fold(f64::MAX, f64::min).powi(2))
    });
    let squares: Vec<f64> = apart.collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}
