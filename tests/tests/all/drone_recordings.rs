//! Recorded flights with ground truth: the accuracy that the book promises, with one setting for all.
//!
//! They are in `../shared/data/drone`, beside the repository. Where they are absent these tests print SKIPPED and pass;
//! with `KESTIRIM_REQUIRE_DATA=1` they fail instead.

use std::path::Path;

use host_sim::system::{Account, AnySystem, Files, Settings, Source, Wanted};
use host_sim::systems::drone::Drone;
use kestirim_tests::recordings::folder_of;

fn replay(folder: &Path, log: &str, truth: &str, area: &str) -> Account {
    let mut files = Files::default();
    for (field, name) in [("log", log), ("truth", truth), ("area", area)] {
        files.add(field, folder.join(name));
    }
    let settings = Settings::new(Drone.settings());
    let opened = Drone.open(Source::Files(files), &settings).expect("a recording can be read");
    let account = opened.replay(&settings, &Wanted::default()).expect("the user is found");
    // None of these users moves.
    assert!(account.warnings.iter().all(|it| !it.contains("--window")), "{:?}", account.warnings);
    account
}

/// The error and expected error of the last estimate, m, and whether the 90 % region contains the truth.
fn last(account: &Account) -> (f64, f64, bool) {
    let accuracy = &account.report["accuracy"];
    let error = accuracy["error_m"].as_f64().expect("there is a truth");
    let sigma = account.report["sd_m"].as_f64().expect("a standard deviation");
    println!("{} {error:.1} m, expected {sigma:.1} m", account.report["measurements"]);
    (error, sigma, accuracy["in_90_percent_region"] == true)
}

#[test]
fn transmitters_are_found_from_the_air() {
    let Some(folder) = folder_of("drone") else { return };
    let flight = folder.join("afar_1204");
    let rover = replay(&flight, "stops.csv", "truth.csv", "area.csv");
    assert!(rover.warnings.is_empty(), "{:?}", rover.warnings);
    let mut all = vec![last(&rover)];
    assert!(all[0].0 <= 60.0, "a rover, after ten minutes");
    let find = |folder: &str, name: &str| {
        let files = ["", "-truth", "-area"].map(|part| format!("{name}{part}.csv"));
        last(&replay(
            &folder_of("drone").expect("it was there").join(folder),
            &files[0],
            &files[1],
            &files[2],
        ))
    };
    all.push(find("lora_20190619", "lora_20190619"));
    assert!(all[1].0 <= 12.0, "a LoRa node");
    let flights =
        [419, 435].into_iter().flat_map(|flight| (0..3).map(move |collar| (flight, collar)));
    let collars: Vec<_> = flights
        .map(|(flight, collar)| find("collars", &format!("collar_000{flight}_{collar}")))
        .collect();
    let mut errors: Vec<f64> = collars.iter().map(|collar| collar.0).collect();
    errors.sort_by(f64::total_cmp);
    assert!(errors[2].midpoint(errors[3]) <= 15.0, "{errors:?}");
    assert!(errors.iter().sum::<f64>() / 6.0 <= 20.0, "{errors:?}");
    all.extend(collars);
    let square =
        |of: fn(&(f64, f64, bool)) -> f64| all.iter().map(|it| of(it).powi(2)).sum::<f64>();
    let ratio = (square(|it| it.1) / square(|it| it.0)).sqrt();
    println!("σ over error, root mean square: {ratio:.2}");
    assert!((0.7..1.5).contains(&ratio), "{ratio}");
    assert!(all.iter().filter(|it| it.2).count() >= 7, "{all:?}");
}
