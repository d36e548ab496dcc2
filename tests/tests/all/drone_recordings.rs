//! A recorded flight with truth: the accuracy that the book promises, with settings that are not fitted to it.
//!
//! It stands beside the repository in `../shared/data/drone`. Where it is absent this test says SKIPPED and
//! passes; with `KESTIRIM_REQUIRE_DATA=1` it fails instead.

use host_sim::system::{AnySystem, Files, Settings, Source, Wanted};
use host_sim::systems::drone::Drone;
use kestirim_tests::recordings::folder_of;

#[test]
fn a_rover_is_found_from_the_air() {
    let Some(folder) = folder_of("drone") else { return };
    let flight = folder.join("afar_1204");
    let mut files = Files::default();
    for (field, name) in [("log", "stops.csv"), ("truth", "truth.csv"), ("area", "area.csv")] {
        files.add(field, flight.join(name));
    }
    let settings = Settings::new(Drone.settings());
    let opened = Drone.open(Source::Files(files), &settings).expect("a recording can be read");
    let account = opened.replay(&settings, &Wanted::default()).expect("the user is found");
    let accuracy = &account.report["accuracy"];
    println!("{accuracy}, expected {} m", account.report["sd_m"]);
    let after = accuracy["error_after_s"].as_array().expect("there is a truth");
    let ten_minutes = after.iter().find(|after| after["s"] == 600.0);
    let error = ten_minutes.and_then(|after| after["error_m"].as_f64());
    assert!(error.is_some_and(|error| error <= 80.0), "{accuracy}");
    assert_eq!(accuracy["in_90_percent_region"], true);
    assert!(account.warnings.is_empty(), "{:?}", account.warnings);
}
