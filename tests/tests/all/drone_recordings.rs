//! A recorded flight with truth: the accuracy that the book promises, with settings that are not fitted to it.
//!
//! It stands beside the repository in `../shared/data/drone`. Where it is absent this test says SKIPPED and
//! passes; with `KESTIRIM_REQUIRE_DATA=1` it fails instead.

use host_sim::systems::drone::replay::Replay;
use kestirim_tests::recordings::folder_of;

#[test]
fn a_rover_is_found_from_the_air() {
    let Some(folder) = folder_of("drone") else { return };
    let flight = folder.join("afar_1204");
    let replay = Replay {
        log: flight.join("stops.csv"),
        truth: Some(flight.join("truth.csv")),
        environment: None,
        free_space: true,
        area: Some(flight.join("area.csv")),
        track: None,
        mcap: None,
        json: true,
    };
    let report = replay.report().expect("a recording can be read");
    let accuracy = report.accuracy.expect("there is a truth");
    println!("{:.1} m off, expected {:.1} m; {accuracy:?}", accuracy.error_m, report.sd_m);
    let ten_minutes = accuracy.error_after_s.iter().find(|after| after.s == 600.0);
    assert!(ten_minutes.is_some_and(|after| after.error_m <= 80.0), "{accuracy:?}");
    assert_eq!(accuracy.in_90_percent_region, Some(true));
    assert!(report.warnings.is_empty(), "{:?}", report.warnings);
}
