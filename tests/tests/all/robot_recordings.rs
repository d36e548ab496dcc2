//! Recorded ranges with truth: the accuracy that the book promises, one configuration for all.
//!
//! The recordings stand beside the repository in `../shared/data/robot`. Where they are absent these tests say
//! SKIPPED and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

use host_sim::metrics::{mean, median, rms};
use host_sim::system::ScalarKind;
use host_sim::systems::robot::settings::TrackerKind;
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
    // The methods beside it, as they are known from these recordings.
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
            assert_eq!((accuracy.missed, followed.lost_s()), (0, 0.0), "never lost");
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
            assert_eq!((accuracy.missed, followed.lost_s()), (0, 0.0), "never lost");
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
        // Three of four anchors are not yet a position.
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

/// A range with a clear view: true distance, measured one (m), and the received level (dBm).
fn ranges_by_level() -> Option<Vec<(f64, f64, f64)>> {
    /// Height of the antenna that stayed where it was, m; the recording names that of the other one.
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
    // Knots from the distances with even numbers, tested on those with odd ones.
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
