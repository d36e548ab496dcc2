//! The book's tables: every tracker on every group of recordings, and the effect of halving and doubling each constant.
//!
//! `cargo test --release -p kestirim-tests --test all robot_table:: -- --ignored --nocapture`

use std::path::Path;

use host_sim::metrics::mean;
use kestirim_adaptive_kalman::Learning;
use kestirim_replay::robot::TrackerKind;
use kestirim_tests::recordings::folder_of;
use kestirim_tests::robot::{Change, Method, Points, Recording, blocked};

/// Recordings, read once.
struct Data {
    corners: Points,
    learnt: Vec<f64>,
    all: Vec<f64>,
    trolleys: Vec<Recording>,
    creeping: Vec<Recording>,
    labyrinth: Recording,
    carried: Vec<Recording>,
}

impl Data {
    fn read(folder: &Path) -> Self {
        let corners = Points::read(folder, true);
        let learnt = corners.group("5_", true).biases();
        let read =
            |names: &[&str]| names.iter().map(|name| Recording::read(folder, name)).collect();
        Self {
            learnt,
            all: Points::read(folder, false).biases(),
            trolleys: read(&["lias_mid_tag0", "lias_mid_tag1", "lias_mid_tag2"]),
            creeping: read(&["esp32_los2", "esp32_wall2"]),
            labyrinth: Recording::read(folder, "labyrinth"),
            carried: read(&["trek_m1l", "trek_m2r", "trek_m3s"]),
            corners,
        }
    }

    /// The errors in cm, in the order of the table's columns.
    fn row(&self, folder: &Path, method: Method) -> Vec<f64> {
        let rmse = |recording: &Recording, biases: Option<&Vec<f64>>| {
            recording.track(method, biases.cloned()).0.rmse_m
        };
        let tested = self.corners.group("5_", false);
        let maze = self.labyrinth.biases(10.0);
        let trolleys: Vec<f64> =
            self.trolleys.iter().map(|recording| rmse(recording, Some(&self.all))).collect();
        let carried: Vec<f64> =
            self.carried.iter().map(|recording| rmse(recording, None)).collect();
        let metres = [
            self.corners.track(method, None).mean_m,
            tested.track(method, Some(&self.learnt)).mean_m,
            mean(&blocked(folder, method, true)),
            mean(&blocked(folder, method, false)),
            rmse(&self.creeping[0], None),
            rmse(&self.creeping[1], None),
            mean(&trolleys),
            rmse(&self.labyrinth, Some(&maze)),
            mean(&carried),
        ];
        metres.iter().map(|metres| 100.0 * metres).collect()
    }
}

const HEADER: &str = "| | points | calibrated | person, calibrated | person | creeping | behind a wall \
                      | trolley, calibrated | labyrinth, calibrated | carried |";

fn print(folder: &Path, data: &Data, rows: &[(&str, Method)]) {
    println!("\n{HEADER}\n|---|---|---|---|---|---|---|---|---|---|");
    for (name, method) in rows {
        let cells: Vec<String> =
            data.row(folder, *method).iter().map(|error| format!("{error:.1}")).collect();
        println!("| {name} | {} |", cells.join(" | "));
    }
}

#[test]
#[ignore = "a table for the book, not a check"]
fn trackers() {
    let Some(folder) = folder_of("robot") else { return };
    let of = |tracker| Method { tracker, ..Method::DEFAULT };
    let rows = [
        ("`lsq`", of(TrackerKind::Lsq)),
        ("`nls`", of(TrackerKind::Nls)),
        ("`ekf`", of(TrackerKind::Ekf)),
        ("`aekf`", of(TrackerKind::Aekf)),
        ("`aekf-published`", of(TrackerKind::AekfPublished)),
        ("`default`", Method::DEFAULT),
    ];
    print(&folder, &Data::read(&folder), &rows);
}

fn learning(change: impl FnOnce([f64; 3]) -> [f64; 3], least: f64) -> Option<Learning<f64>> {
    let [forgetting, least, most] = change([0.99, least, 9.0]);
    Learning::new(forgetting, least, most).ok()
}

/// The least variance of ranges of calibrated anchors; others have four times as much.
const LEAST: f64 = 0.0025;

#[test]
#[ignore = "a table for the book, not a check"]
fn constants() {
    let Some(folder) = folder_of("robot") else { return };
    let changes: [(&str, Change); 17] = [
        ("as they are", |_| {}),
        ("σ of a range to begin with × ½", |config| config.range_sigma *= 0.5),
        ("× 2", |config| config.range_sigma *= 2.0),
        ("acceleration density × ½", |config| config.acceleration_density *= 0.5),
        ("× 2", |config| config.acceleration_density *= 2.0),
        ("decay time × ½", |config| config.decay_time = Some(1.0)),
        ("× 2", |config| config.decay_time = Some(4.0)),
        ("gate at 3.5 σ", |config| config.gate = Some(12.5)),
        ("at 7 σ", |config| config.gate = Some(50.0)),
        ("no gate", |config| config.gate = None),
        ("Huber's long threshold × ½", |config| {
            if let Some(huber) = &mut config.huber {
                huber.long *= 0.5;
            }
        }),
        ("× 2", |config| {
            if let Some(huber) = &mut config.huber {
                huber.long *= 2.0;
            }
        }),
        ("no Huber", |config| config.huber = None),
        ("R learnt over 50 ranges", |config| {
            config.learning = learning(|[_, least, most]| [0.98, least, most], LEAST);
        }),
        ("over 200", |config| {
            config.learning = learning(|[_, least, most]| [0.995, least, most], LEAST);
        }),
        ("least σ 7 cm", |config| {
            config.learning = learning(|[alpha, least, most]| [alpha, 2.0 * least, most], LEAST);
        }),
        ("R not learnt", |config| config.learning = None),
    ];
    let rows: Vec<_> = changes
        .map(|(name, change)| (name, Method { change: Some(change), ..Method::DEFAULT }))
        .into();
    print(&folder, &Data::read(&folder), &rows);
}
