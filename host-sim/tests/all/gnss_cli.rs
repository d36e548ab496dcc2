//! Tests of the GNSS receiver's commands: exit status, standard output, standard error, files.

use std::collections::BTreeMap;
use std::fs;

use crate::program::{Desk, host_sim, json, refusal, rows_of, text};
use crate::station::{self, BEGIN, Fault, INTERVAL, MARKER, satellites};
use serde_json::Value;

/// The number of epochs in a recording of an hour and twenty minutes.
const EPOCHS: u32 = 160;
/// The end of orbits that cover the whole recording (s).
const LATE: f64 = 18_000.0;

/// Writes the files of a receiver, and returns the command that replays them.
fn replay(
    desk: &Desk,
    epochs: u32,
    orbits_until: f64,
    fault: impl Fn(u32, u8) -> Option<Fault>,
) -> Vec<String> {
    let obs = desk.file("test.rnx", station::rinex(epochs, fault));
    let sp3 = desk.file("test.sp3", station::sp3(orbits_until, &satellites()));
    let antex = desk.file("test.atx", station::antex(&satellites()));
    let arguments = ["replay", "gnss", "--obs", &obs, "--sp3", &sp3, "--antex", &antex];
    arguments.map(str::to_owned).to_vec()
}

fn with(arguments: &[String], more: &[&str]) -> Vec<String> {
    arguments.iter().cloned().chain(more.iter().map(|&it| it.to_owned())).collect()
}

fn report(arguments: &[String], more: &[&str]) -> Value {
    json(&host_sim(&with(&with(arguments, more), &["--json"])))
}

fn refused(arguments: &[String], more: &[&str]) -> String {
    let all = with(arguments, more);
    refusal(&all.iter().map(String::as_str).collect::<Vec<_>>())
}

fn marker() -> String {
    MARKER.map(|metres| metres.to_string()).join(",")
}

fn warnings(report: &Value) -> Vec<&str> {
    let all = report["warnings"].as_array().expect("an array");
    all.iter().map(|it| it.as_str().expect("a sentence")).collect()
}

#[test]
fn a_receiver_is_found() {
    let desk = Desk::new();
    let files = replay(&desk, EPOCHS, LATE, |_, _| Some(Fault::NONE));
    let (track, residuals) = (desk.named("track.csv"), desk.named("residuals.csv"));
    let more = ["--truth", &marker(), "--track", &track, "--residuals", &residuals];
    let found = report(&files, &more);
    assert_eq!((&found["system"], &found["epochs"]), (&"gnss".into(), &EPOCHS.into()));
    assert_eq!(found["solved"], EPOCHS);
    assert_eq!((&found["rejected"], &found["slips"]), (&0.into(), &0.into()));
    assert!(found["deweighted"].is_u64());
    for vector in ["position_ecef_m", "sd_enu_m"] {
        assert_eq!(found[vector].as_array().map(Vec::len), Some(3));
    }
    let accuracy = &found["accuracy"];
    for (measure, limit) in [("final_3d_m", 0.02), ("rms_3d_m", 0.02), ("convergence_min", 30.0)] {
        assert!(accuracy[measure].as_f64().is_some_and(|it| it < limit), "{accuracy}");
    }
    // The only warning is that the ocean loading is not known.
    assert!(matches!(&*warnings(&found), [one] if one.contains("--blq")), "{found}");

    let (header, track) = rows_of::<7>(&track);
    assert_eq!(header, "t,x,y,z,sde,sdn,sdu,health");
    assert_eq!(track.len(), EPOCHS as usize);
    assert!(track[0].0[0] == 7200.0 && (track[0].0[1] - 3_582_105.0).abs() < 50.0, "{track:?}");
    assert!(track.iter().all(|(numbers, health)| health == "good" && numbers[6] > 0.0));
    let residuals = fs::read_to_string(&residuals).expect("residuals");
    let rows = found["observations"].as_u64().expect("a number") / 2;
    assert_eq!(residuals.lines().count() as u64, 1 + rows);
    let (first, _) = residuals.lines().nth(1).and_then(|row| row.rsplit_once(',')).expect("a row");
    assert_eq!(first.split(',').count(), 12);
    assert!(residuals.lines().nth(1).is_some_and(|row| row.ends_with(",new")));
    // There are no other files on the desk.
    assert_eq!(fs::read_dir(desk.path(".")).expect("the folder").count(), 5);

    let table = host_sim(&with(&files, &more));
    assert!(text(&table.stdout).contains("below 10 cm after"));
    assert!(text(&table.stderr).contains("warning: the load of the oceans"));
}

#[test]
fn what_was_found_can_be_looked_at_in_other_programs() {
    let desk = Desk::new();
    let files = replay(&desk, 40, LATE, |_, _| Some(Fault::NONE));
    let messages = |more: &[&str]| {
        let file = desk.named("run.mcap");
        report(&files, &[more, &["--mcap", &file]].concat());
        let bytes = fs::read(&file).expect("a file");
        let mut counts = BTreeMap::new();
        for message in mcap::MessageStream::new(&bytes).expect("an MCAP file") {
            *counts.entry(message.expect("a message").channel.topic.clone()).or_insert(0) += 1;
        }
        counts
    };
    let found = messages(&["--truth", &marker()]);
    let each = ["/gnss/estimate", "/gnss/estimate/pose", "/gnss/truth", "/gnss/satellites"];
    let rest = ["/gnss/code_residuals", "/gnss/phase_residuals"];
    for topic in each.into_iter().chain(rest) {
        assert_eq!(found.get(topic), Some(&40), "{topic}: {found:?}");
    }
    assert_eq!(found.get("/gnss/estimate/path"), Some(&1));
    assert_eq!(messages(&[]).get("/gnss/truth"), None);
}

#[test]
fn the_truth_serves_accuracy_alone() {
    let desk = Desk::new();
    let files = replay(&desk, 40, LATE, |_, _| Some(Fault::NONE));
    let track = |name: &str, more: &[&str]| {
        let file = desk.named(name);
        let found = report(&files, &[more, &["--track", &file]].concat());
        (fs::read(&file).expect("a track"), found)
    };
    let (bare, without) = track("bare.csv", &[]);
    assert!(without["accuracy"].is_null());
    // A leading minus sign is part of the number.
    let (wrong, elsewhere) = track("wrong.csv", &["--truth", "-3582104.7,532590.2,5232755.1"]);
    assert!(elsewhere["accuracy"]["final_3d_m"].as_f64().is_some_and(|error| error > 1e6));
    assert!(elsewhere["accuracy"]["rms_3d_m"].is_null(), "an hour has not passed");
    assert!(elsewhere["accuracy"]["convergence_min"].is_null());
    assert_eq!(bare, wrong);
    assert_eq!(without["position_ecef_m"], elsewhere["position_ecef_m"]);
}

#[test]
fn until_is_the_last_epoch() {
    let desk = Desk::new();
    let files = replay(&desk, 40, LATE, |_, _| Some(Fault::NONE));
    let last = (BEGIN + 20.0 * INTERVAL).to_string();
    let found = report(&files, &["--until", &last]);
    assert_eq!((&found["epochs"], &found["solved"]), (&21.into(), &21.into()));
    assert!(refused(&files, &["--until", "7199"]).contains("7200 s"));
}

#[test]
fn epochs_without_a_solution_are_told_with_the_reason() {
    let desk = Desk::new();
    // The first two epochs have three satellites; the orbits end after half an hour.
    let fault = |epoch, prn| (epoch > 1 || prn % 10 == 3).then_some(Fault::NONE);
    let found = report(&replay(&desk, EPOCHS, 9000.0, fault), &["--truth", &marker()]);
    assert_eq!((&found["epochs"], &found["solved"]), (&EPOCHS.into(), &59.into()));
    let told = warnings(&found).concat();
    assert!(told.contains("101 epochs without a solution, the first at 7200 s: fewer"), "{told}");
    assert!(told.contains("observations without an orbit: G"), "{told}");
    assert!(found["unused"]["no_orbit"].as_u64().is_some_and(|count| count > 500));
    // The minutes count from the first epoch, which has no solution.
    assert!(found["accuracy"]["convergence_min"].as_f64().is_some_and(|it| it >= 1.0));

    let incomplete = Fault { incomplete: true, ..Fault::NONE };
    let bare =
        replay(&desk, 40, LATE, |epoch, _| Some(if epoch < 30 { Fault::NONE } else { incomplete }));
    let found = report(&bare, &[]);
    assert_eq!(found["solved"], 30);
    let told = warnings(&found).concat();
    assert!(told.contains("10 epochs without a solution, the first at 8100 s"), "{told}");
    assert!(told.contains("with incomplete observations"), "{told}");

    let files = replay(&desk, 5, LATE, |_, prn| (prn < 8).then_some(Fault::NONE));
    let told = refused(&files, &["--mask", "60"]);
    assert!(told.contains("test.rnx: none of its 5 epochs"), "{told}");
    let other = fs::read_to_string(&files[5]).expect("orbits").replace("2020  6 25", "2020  6 20");
    fs::write(&files[5], other).expect("the folder can be written");
    let told = refused(&files, &[]);
    assert!(told.contains("the orbits are of another time"), "{told}");
}

#[test]
fn faults_are_counted_and_a_gap_is_no_slip() {
    let desk = Desk::new();
    let clean = replay(&desk, EPOCHS, LATE, |_, _| Some(Fault::NONE));
    let residuals = desk.named("residuals.csv");
    report(&clean, &["--residuals", &residuals]);
    // A satellite that is in view all the time.
    let rows = fs::read_to_string(&residuals).expect("residuals");
    let always = satellites().into_iter().find(|prn| {
        let column = format!(",{prn},");
        let rows = rows.lines().filter(|row| row.contains(&column));
        rows.count() == EPOCHS as usize
    });
    let always = always.expect("one of thirty");
    let files = replay(&desk, EPOCHS, LATE, |epoch, prn| match (epoch, prn == always) {
        (100, true) => Some(Fault { lock_lost: true, ..Fault::NONE }),
        (120, true) => Some(Fault { code: 30.0, ..Fault::NONE }),
        (130..=145, true) => None,
        _ => Some(Fault::NONE),
    });
    let found = report(&files, &["--residuals", &residuals]);
    // An outlier of the code may also appear as slips.
    let kinds = found["slips_by_kind"].as_object().expect("an object");
    assert_eq!(found["slips"], kinds.values().filter_map(Value::as_u64).sum::<u64>());
    assert_eq!(kinds["loss_of_lock"], 1);
    assert_eq!((&found["rejected"], &found["rejected_by_kind"]["code"]), (&1.into(), &1.into()));
    assert_eq!(found["most_rejected"][0]["satellite"], format!("G{always:02}"));
    let rows = fs::read_to_string(&residuals).expect("residuals");
    let at = |epoch: u32| {
        let start = format!("{:.6},{always},", BEGIN + INTERVAL * f64::from(epoch));
        rows.lines().find(|row| row.starts_with(&start)).expect("a row")
    };
    assert!(at(100).ends_with(",loss-of-lock") && at(146).ends_with(",gap"));
    assert!(at(120).contains(",rejected,"));
}

#[test]
fn all_filters_are_compared() {
    let desk = Desk::new();
    let files = replay(&desk, EPOCHS, 9000.0, |_, _| Some(Fault::NONE));
    let all = with(&files, &["--filter", "all", "--mode", "kinematic", "--process-noise", "1e-4"]);
    let found = report(&all, &["--truth", &marker()]);
    let filters = found["filters"].as_array().expect("an array");
    let names: Vec<_> = filters.iter().map(|it| it["filter"].as_str().expect("a name")).collect();
    assert_eq!(names, ["gkf", "rkf", "skf", "ikf", "adaptive", "default"]);
    for filter in filters {
        assert_eq!((&filter["epochs"], &filter["solved"]), (&EPOCHS.into(), &61.into()));
        assert!(filter["accuracy"]["final_3d_m"].as_f64().is_some_and(|it| it < 0.1), "{filter}");
    }
    // A warning that is the same for all filters is given once.
    assert_eq!(warnings(&found).iter().filter(|it| it.contains("without a solution")).count(), 1);
    let alone =
        report(&files, &["--filter", "gkf", "--mode", "kinematic", "--process-noise", "1e-4"]);
    assert_eq!(alone["position_ecef_m"], filters[0]["position_ecef_m"]);
    let table = host_sim(&with(&all, &["--printed"]));
    assert!(text(&table.stdout).contains("rkf (published)"));
    assert!(!text(&table.stdout).contains("gkf (published)"));
    // The answer does not depend on the number of threads.
    let run = |threads: &str| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_host-sim"));
        command.args(&all).arg("--json").env("RAYON_NUM_THREADS", threads);
        command.output().expect("the program runs").stdout
    };
    assert_eq!(run("1"), run("3"));
}
