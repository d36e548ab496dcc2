//! The book's table: every tracker, mode and detector on every group of walks with footprints.
//!
//! `cargo test --release -p kestirim-tests --test all pedestrian_table:: -- --ignored --nocapture`

use host_sim::metrics::{mean, median};
use host_sim::system::{ScalarKind, Settings, System};
use host_sim::systems::pedestrian::Pedestrian;
use host_sim::systems::pedestrian::settings::options;
use kestirim_replay::pedestrian::{Options, SensorClass, TrackerKind};
use kestirim_tests::recordings::{self, GCP, GCP_FAST, Group, gcp, vicon};

#[test]
#[ignore = "a table for the book, not a check"]
fn table() {
    let Some(folder) = recordings::folder() else { return };
    let industrial = Options { sensor: SensorClass::Industrial, ..Options::default() };
    let lite = Options { tracker: TrackerKind::Lite, ..industrial };
    let fixed = Options { scalar: ScalarKind::Fixed, ..industrial };
    let detector = |name| {
        let mut settings = Settings::new(Pedestrian::settings(None));
        settings.set("detector", name).expect("a detector");
        options(&settings).detector
    };
    let rows = [
        ("ekf", industrial),
        ("ekf --causal", Options { causal: true, ..industrial }),
        ("lite", lite),
        ("lite --causal", Options { causal: true, ..lite }),
        ("ekf --scalar fixed", fixed),
        ("lite --scalar fixed", Options { tracker: TrackerKind::Lite, ..fixed }),
        ("ekf --contact-height 0", Options { contact_height_m: Some(0.0), ..industrial }),
        ("ekf --contact-height 0.04", Options { contact_height_m: Some(0.04), ..industrial }),
        ("ekf --contact-height 0.10", Options { contact_height_m: Some(0.1), ..industrial }),
        ("ekf --detector shoe", Options { detector: detector("shoe"), ..industrial }),
        (
            "ekf --detector angular-rate",
            Options { detector: detector("angular-rate"), ..industrial },
        ),
        ("lite --detector variance", Options { detector: detector("variance"), ..lite }),
        ("lite --detector magnitude:0.1", Options { detector: detector("magnitude:0.1"), ..lite }),
    ];
    let mut lines = Vec::new();
    for (name, options) in rows {
        let groups = [
            Group::track(gcp(&folder, &GCP), None, &options),
            Group::track(gcp(&folder, &GCP), Some(50.0), &options),
            Group::track(gcp(&folder, &GCP_FAST), None, &options),
            Group::track(vicon(&folder), None, &options),
        ];
        let cells = groups.map(|group| {
            let (path, worst) = (mean(&group.path_errors), group.worst_path());
            format!("{path:.2} / {worst:.2} % · {:.3} m", median(&group.rmse_m))
        });
        lines.push(format!("| `{name}` | {} |", cells.join(" | ")));
    }
    println!("\n| | gcp | gcp at 50 Hz | gcp, fast | Vicon |\n|---|---|---|---|---|");
    println!("{}", lines.join("\n"));
    println!("mean / worst error of the path length · median RMSE of the footprints");
}
