//! Recorded ranges with ground truth: the accuracy that the book promises, with one configuration for all.
//!
//! The recordings are in `../shared/data/robot`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

use std::path::Path;

use host_sim::metrics::{mean, median, rms};
use host_sim::system::{Detail, Files, ScalarKind, Settings, System};
use host_sim::systems::robot::Robot;
use host_sim::systems::robot::account::accuracy::Accuracy;
use host_sim::systems::robot::recording::points;
use host_sim::systems::robot::settings;
use kestirim_replay::robot::{FoundHeight, Trace, TrackerKind};
use kestirim_tests::recordings::folder_of;
use kestirim_tests::robot::{Method, Points, Recording, blocked};
use kestirim_uwb_ranging::LevelBias;

const SCALARS: [ScalarKind; 3] = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];

/// Runs a check in every number type.
fn in_every_scalar(check: impl Fn(Method)) {
    for scalar in SCALARS {
        check(Method { scalar, ..Method::DEFAULT });
    }
}

fn within(what: &str, method: Method, metres: f64, most: f64) {
    println!("{what}, {:?}: {:.2} cm (at most {:.2})", method.scalar, 100.0 * metres, 100.0 * most);
    assert!(metres <= most, "{what} in {:?}: {metres} m", method.scalar);
}

#[test]
fn points_among_four_corners() {
    let Some(folder) = folder_of("robot") else { return };
    let points = Points::read(&folder, true);
    let (learnt, tested) = (points.group("5_", true), points.group("5_", false));
    let biases = learnt.biases();
    in_every_scalar(|method| {
        within("90 points as they come", method, points.track(method, None).mean_m, 0.092);
        let calibrated = tested.track(method, Some(&biases));
        within("groups 1 to 4, calibrated at 5", method, calibrated.mean_m, 0.062);
    });
    // Other methods, with the errors that are known from these recordings.
    let method = |tracker| Method { tracker, ..Method::DEFAULT };
    let plain = points.track(method(TrackerKind::Lsq), None).mean_m;
    assert!((0.125..0.145).contains(&plain), "{plain}");
    let plain = points.track(method(TrackerKind::Ekf), None).mean_m;
    assert!((0.110..0.130).contains(&plain), "{plain}");
}

#[test]
fn a_person_in_the_way() {
    let Some(folder) = folder_of("robot") else { return };
    in_every_scalar(|method| {
        let errors = blocked(&folder, method, true);
        within("person in the way, calibrated", method, mean(&errors), 0.105);
    });
    let plain = Method { tracker: TrackerKind::Ekf, ..Method::DEFAULT };
    assert!(mean(&blocked(&folder, plain, true)) > 0.2, "the plain filter is drawn along");
}

#[test]
fn a_robot_that_creeps_among_three_anchors() {
    let Some(folder) = folder_of("robot") else { return };
    in_every_scalar(|method| {
        for (name, most) in [("esp32_los2", 0.06), ("esp32_wall2", 0.22)] {
            let (accuracy, followed) = Recording::read(&folder, name).track(method, None);
            within(name, method, accuracy.rmse_m, most);
            // A first position among three anchors takes five more ranges.
            assert!(accuracy.missed <= 2 && followed.lost_s() < 0.5, "never lost: {followed:?}");
        }
    });
}

#[test]
fn a_trolley_among_eight_anchors() {
    let Some(folder) = folder_of("robot") else { return };
    let biases = Points::read(&folder, false).biases();
    in_every_scalar(|method| {
        for name in ["lias_mid_tag0", "lias_mid_tag1", "lias_mid_tag2"] {
            let recording = Recording::read(&folder, name);
            let (accuracy, followed) = recording.track(method, Some(biases.clone()));
            within(name, method, accuracy.rmse_m, 0.066);
            // A first position among eight anchors takes three more ranges.
            assert!(accuracy.missed <= 1 && followed.lost_s() < 0.1, "never lost: {followed:?}");
        }
    });
}

#[test]
fn single_ranges_in_a_labyrinth() {
    let Some(folder) = folder_of("robot") else { return };
    let recording = Recording::read(&folder, "labyrinth");
    let biases = recording.biases(10.0);
    in_every_scalar(|method| {
        let (accuracy, followed) = recording.track(method, Some(biases.clone()));
        within("labyrinth", method, accuracy.rmse_m, 0.14);
        // Three of four anchors do not yet determine a position.
        assert!(accuracy.missed <= 3 && followed.lost_s() < 0.5);
    });
}

#[test]
fn a_tag_carried_about_as_it_comes() {
    let Some(folder) = folder_of("robot") else { return };
    in_every_scalar(|method| {
        for name in ["trek_m1l", "trek_m2r", "trek_m3s"] {
            let (accuracy, _) = Recording::read(&folder, name).track(method, None);
            within(name, method, accuracy.rmse_m, 0.25);
            assert_eq!(accuracy.missed, 0);
        }
    });
}

#[test]
fn wild_ranges_do_little_harm() {
    let Some(folder) = folder_of("robot") else { return };
    in_every_scalar(|method| {
        for (name, most) in [("esp32_los2", 0.15), ("esp32_wall2", 0.25), ("trek_m1l", 0.2)] {
            let (accuracy, followed) = Recording::read(&folder, name).spoiled().track(method, None);
            within(&format!("{name}, spoiled"), method, accuracy.rmse_m, most);
            assert!(accuracy.missed <= 3 && followed.lost_s() < 1.0, "{name}: {followed:?}");
        }
    });
}

/// Ranges with a clear view: true distance (m), measured one (m), and received level (dBm).
fn ranges_by_level() -> Option<Vec<(f64, f64, f64)>> {
    /// The height of the stationary antenna, m; the recording gives that of the other one.
    const FIXED_HEIGHT: f64 = 1.05;
    let file = folder_of("robot")?.join("cucu_static_los_nlos/ranges.csv");
    let text = std::fs::read_to_string(file).expect("ranges");
    let rows = text.lines().skip(1).filter_map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |column: usize| fields.get(column)?.parse::<f64>().ok();
        let rise = number(1)? * 0.01 - FIXED_HEIGHT;
        let distance = number(2)?.hypot(rise);
        let wild = (number(3)? - distance).abs() > 1.0;
        (fields[0] == "LOS" && !wild).then_some((distance, number(3)?, number(4)?))
    });
    Some(rows.collect())
}

#[test]
fn the_received_level_tells_most_of_the_bias() {
    let Some(rows) = ranges_by_level() else { return };
    // Knots are computed from the distances with even numbers, and tested on those with odd ones.
    let even = |distance: f64| (distance / 4.0).floor() as i64 % 2 == 0;
    let levels = [-86.0, -85.0, -84.0, -83.0, -82.0, -81.0, -80.0, -79.0_f64];
    let knots = levels.map(|level| {
        let near =
            rows.iter().filter(|(distance, _, rx)| even(*distance) && (rx - level).abs() < 0.5);
        let errors: Vec<f64> = near.map(|(distance, range, _)| range - distance).collect();
        assert!(errors.len() > 20, "{level} dBm: {}", errors.len());
        (level, median(&errors))
    });
    let table = LevelBias::new(knots).expect("levels that rise");
    let errors = |corrected: &dyn Fn(f64, f64) -> f64| {
        let tested = rows.iter().filter(|(distance, ..)| !even(*distance));
        rms(&tested
            .map(|(distance, range, rx)| corrected(*range, *rx) - distance)
            .collect::<Vec<_>>())
    };
    let plain = errors(&|range, _| range);
    let corrected = errors(&|range, level| table.corrected(range, level));
    let wrong_sign = errors(&|range, level| range + table.bias(level));
    println!(
        "by level: {plain:.3} m becomes {corrected:.3} m, with the wrong sign {wrong_sign:.3} m"
    );
    assert!(corrected < 0.3 * plain && corrected < 0.07, "{plain} {corrected}");
    assert!(wrong_sign > plain);
}

/// The results of a recording with ground truth.
struct Found {
    /// The known height, m, and the estimated height with its standard deviation; `None` if the run was refused.
    known_m: f64,
    height: Option<FoundHeight>,
    /// The root mean square errors of the position at the known and at the estimated height, m.
    at_known_m: f64,
    at_found_m: Option<f64>,
    /// The shares of positions within 2.5 σ of the truth, as the ellipse gives it, at the known and at the estimated
    /// height.
    within_at_known: f64,
    within: Option<f64>,
}

/// Whether the truth lies within 2.5 σ of an estimate's ellipse.
fn is_within(position: [f64; 3], [xx, xy, yy]: [f64; 3], truth: [f64; 2]) -> bool {
    let (x, y) = (position[0] - truth[0], position[1] - truth[1]);
    let squared = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / (xx * yy - xy * xy);
    squared <= 2.5 * 2.5
}

/// A recording as `host-sim replay robot` opens it, with and without the height.
fn found(folder: &Path, name: &str, scalar: &str) -> Found {
    let folder = folder.join(name);
    let file = |name: &str| Some(folder.join(name)).filter(|path| path.exists());
    let mut files = Files::default();
    for (field, name) in [
        ("anchors", "anchors.csv"),
        ("log", "ranges.csv"),
        ("truth", "truth.csv"),
        ("imu", "imu.csv"),
        ("odom", "odom.csv"),
    ] {
        if let Some(path) = file(name) {
            files.add(field, path);
        }
    }
    let settings = Settings::new(Robot::settings(None));
    let recording = Robot::read(&files, &settings).expect("a recording");
    let settings = |height: Option<f64>| {
        let mut sent = serde_json::Map::new();
        sent.insert("scalar".to_owned(), scalar.into());
        if let Some(height) = height {
            sent.insert("height".to_owned(), height.into());
        }
        Settings::sent(Robot::settings(Some(&recording)), &sent).expect("settings")
    };
    let course = points::read_course(&folder.join("truth.csv"), ["z"]).expect("heights");
    let known_m = mean(&course.rows().iter().map(|(_, [z])| *z).collect::<Vec<_>>());
    let track = |settings: &Settings| {
        Robot::track(&recording, settings, Detail::Every).map(|tracks| tracks.traces)
    };
    let rmse = |traces: &[Trace]| Accuracy::of_recording(&recording, traces).map(|it| it.rmse_m);
    let at_known = track(&settings(Some(known_m))).expect("a track");
    let without = settings(None);
    let traces = track(&without).ok();
    let within = |traces: &Vec<Trace>| {
        let mut all = Vec::new();
        for (part, trace) in recording.parts.iter().zip(traces) {
            all.extend(trace.epochs.iter().filter_map(|epoch| {
                let truth = part.truth.as_ref()?.at(epoch.time_us)?;
                Some(f64::from(is_within(epoch.position?, epoch.spread?, truth)))
            }));
        }
        mean(&all)
    };
    Found {
        known_m,
        height: settings::of_recording(&recording, &without).ok().and_then(|setup| setup.found),
        at_known_m: rmse(&at_known).unwrap_or(f64::NAN),
        at_found_m: traces.as_ref().and_then(|traces| rmse(traces)),
        within_at_known: within(&at_known),
        within: traces.as_ref().map(within),
    }
}

#[test]
fn a_height_that_nobody_says_is_found_or_asked_for() {
    let Some(folder) = folder_of("robot") else { return };
    for scalar in ["f32", "f64", "fixed"] {
        for (name, most) in [("esp32_los2", 0.15), ("esp32_wall2", 0.25)] {
            let found = found(&folder, name, scalar);
            match found.at_found_m {
                Some(rmse_m) => assert!(rmse_m <= most, "{name}, {scalar}: {rmse_m} m"),
                None => println!("{name}, {scalar}: refused"),
            }
            assert!(found.within.is_none_or(|within| within >= 0.9), "{name}: {:?}", found.within);
        }
    }
}

/// Recordings whose tag stays at one known height.
const AT_A_HEIGHT: [&str; 20] = [
    "esp32_los2",
    "esp32_nlos1",
    "esp32_wall2",
    "labyrinth",
    "lias_mid_tag0",
    "lias_mid_tag1",
    "lias_mid_tag2",
    "trek_4vba0",
    "trek_4vba02",
    "trek_4vba1",
    "trek_4vba12",
    "trek_4vba22",
    "trek_4vba2s",
    "trek_4vba32",
    "trek_4vba3s",
    "trek_4vnm",
    "trek_4vnm2",
    "trek_m1l",
    "trek_m2r",
    "trek_m3s",
];

#[test]
fn heights_are_honest() {
    let Some(folder) = folder_of("robot") else { return };
    let (mut honest, mut told) = (0, 0);
    println!(
        "| | known, m | found, m | position by it, cm | known: RMSE, cm | within | found: RMSE, cm | within |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for name in AT_A_HEIGHT {
        let found = found(&folder, name, "f32");
        let known = format!("{:.2} | ", found.known_m);
        let (known_cm, within) = (100.0 * found.at_known_m, 100.0 * found.within_at_known);
        let at_known = format!("{known_cm:.1} | {within:.0} %");
        let Some((height, rmse_m)) = found.height.zip(found.at_found_m) else {
            println!("| `{name}` | {known}refused | | {at_known} | | |");
            continue;
        };
        println!(
            "| `{name}` | {known}{:.2} ± {:.2} | {:.1} | {at_known} | {:.1} | {:.0} % |",
            height.metres,
            height.sigma_m,
            100.0 * height.position_sigma_m,
            100.0 * rmse_m,
            100.0 * found.within.unwrap_or_default(),
        );
        told += 1;
        honest += u32::from((height.metres - found.known_m).abs() <= 2.5 * height.sigma_m);
        // The estimated height costs no more accuracy than was stated.
        let most = found.at_known_m + 2.5 * height.position_sigma_m;
        assert!(rmse_m < most, "{name}: {rmse_m} m");
    }
    assert!(told >= 16 && 10 * honest >= 9 * told, "{honest} of {told}");
}
