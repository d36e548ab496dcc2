//! Tests of sweeps: shards that are cut, killed, repeated and merged equal a single run bit for bit; archives lose no
//! recording.
//!
//! The long forms are ignored: `cargo test --release -p host-sim --test sweep -- --ignored --nocapture`.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Duration;

use kestirim_simulate::random::{stream, uniform};
use tempfile::TempDir;

fn host_sim(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    command.current_dir(folder).args(arguments);
    for engine in ["HQ_TASK_ID", "SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"] {
        command.env_remove(engine);
    }
    command.output().expect("the program runs")
}

/// The standard output of the program.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = host_sim(folder, arguments);
    let complaint = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {complaint}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The one sentence of a refusal.
fn refusal(folder: &Path, arguments: &[&str]) -> String {
    let output = host_sim(folder, arguments);
    let sentence = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {sentence}");
    assert_eq!(sentence.trim_end().lines().count(), 1, "{sentence}");
    sentence
}

/// A temporary folder with a plan.
fn with_plan(text: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("plan.toml"), text).expect("a plan");
    folder
}

/// Computes all shards of a plan by separate calls, the last first.
fn in_shards(folder: &Path, count: u32, into: &str) {
    fs::create_dir_all(folder.join(into)).expect("a folder");
    for index in (0..count).rev() {
        let out = format!("{into}/{index}.csv");
        printed(
            folder,
            &["sweep", "plan.toml", "--shard", &format!("{index}/{count}"), "--out", &out],
        );
    }
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    paths
}

#[test]
fn a_plan_of_one_experiment_prints_what_run_prints() {
    for name in ["robot", "pedestrian", "uav", "gnss", "drone"] {
        let folder = with_plan(&format!("system = '{name}'\ntrials = 1\nseeds = [3]"));
        let folder = folder.path();
        in_shards(folder, 3, "rows");
        let run = ["run", name, "--trials", "1", "--seed", "3"];
        if name == "robot" {
            assert_eq!(printed(folder, &["merge", "rows"]), printed(folder, &run));
        }
        let json = [&run[..], &["--json"]].concat();
        assert_eq!(printed(folder, &["merge", "rows", "--json"]), printed(folder, &json), "{name}");
    }
}

/// Without a number of trials the drone's experiment ends once its precision is reached, and so does a sweep.
#[test]
fn trials_beyond_those_that_are_enough_do_not_count() {
    let folder = with_plan("system = 'drone'\n[settings]\nfilter = 'best'\nparticles = 50");
    let folder = folder.path();
    in_shards(folder, 2, "rows");
    let run = ["run", "drone", "--filter", "best", "--particles", "50", "--json"];
    assert_eq!(printed(folder, &["merge", "rows", "--json"]), printed(folder, &run));
}

const GRID: &str = "system = 'drone'\ntrials = 40\nseeds = [1, 2]\nshards = 6\n\
                    [settings]\nfilter = 'published'\nparticles = [100, 200]\nheight = 500";

#[test]
fn any_sharding_gives_the_rows_of_a_single_run() {
    let folder = with_plan(GRID);
    let folder = folder.path();
    let (rows, text) = single_run(folder);
    for count in [1, 4, 7] {
        let into = format!("in-{count}");
        in_shards(folder, count, &into);
        let out = format!("{into}.csv");
        assert_eq!(printed(folder, &["merge", &into, "--out", &out]), text);
        assert!(fs::read(folder.join(&out)).expect("rows") == rows, "{count} shards: other rows");
    }
}

fn single_run(folder: &Path) -> (Vec<u8>, String) {
    fs::create_dir_all(folder.join("one")).expect("a folder");
    printed(folder, &["sweep", "plan.toml", "--out", "one/all.csv"]);
    (fs::read(folder.join("one/all.csv")).expect("rows"), printed(folder, &["merge", "one"]))
}

#[test]
fn a_hole_an_overlap_or_another_plan_is_refused_by_name() {
    let folder = with_plan(GRID);
    let folder = folder.path();
    in_shards(folder, 4, "rows");
    let missing = folder.join("rows/2.csv");
    let kept = fs::read(&missing).expect("a shard");
    fs::remove_file(&missing).expect("it is there");
    assert!(refusal(folder, &["merge", "rows"]).contains("rows 80 to 119 of 160 are missing"));
    fs::write(&missing, &kept).expect("a shard");
    fs::write(folder.join("rows/twice.csv"), &kept).expect("a shard");
    assert!(
        refusal(folder, &["merge", "rows"])
            .contains("2.csv and rows/twice.csv have rows in common")
    );
    fs::remove_file(folder.join("rows/twice.csv")).expect("it is there");
    fs::write(&missing, &kept[..kept.len() - 300]).expect("a shard");
    assert!(refusal(folder, &["merge", "rows"]).contains("rows/2.csv: "));
    let text = String::from_utf8(kept.clone()).expect("text");
    fs::write(&missing, text.replace("\"version\":\"", "\"version\":\"9")).expect("a shard");
    assert!(refusal(folder, &["merge", "rows"]).contains("2.csv is by version 9"));
    fs::write(&missing, text.replacen("\n2,staying 0,0,", "\n2,staying 0,7,", 1)).expect("a shard");
    assert!(refusal(folder, &["merge", "rows"]).contains("2.csv, line 3"));
    fs::write(folder.join("plan.toml"), GRID.replace("500", "600")).expect("a plan");
    printed(folder, &["sweep", "plan.toml", "--shard", "2/4", "--out", "other.csv"]);
    fs::rename(folder.join("other.csv"), &missing).expect("a shard");
    assert!(
        refusal(folder, &["merge", "rows"]).contains("0.csv and rows/2.csv are of different plans")
    );
    assert!(
        refusal(folder, &["sweep", "plan.toml", "--shard", "1/4", "--out", "rows/1.csv"])
            .contains("another plan")
    );
    assert!(refusal(folder, &["merge", "nowhere"]).contains("nowhere"));
    assert!(refusal(folder, &["sweep", "plan.toml", "--shard", "4/4"]).contains("0/N"));
    fs::write(folder.join("plan.toml"), "system = 'boat'").expect("a plan");
    assert!(refusal(folder, &["sweep", "plan.toml"]).contains("boat"));
}

/// Kills and resumes a sweep a number of times, at arbitrary moments.
fn killed(times: u32, plan: &str, longest: Duration) {
    let folder = with_plan(plan);
    let folder = folder.path();
    let (expected, text) = single_run(folder);
    let mut random = stream(7, 0);
    for _ in 0..times {
        let mut sweep = Command::new(env!("CARGO_BIN_EXE_host-sim"))
            .current_dir(folder)
            .args(["sweep", "plan.toml", "--out", "rows"])
            .stderr(Stdio::null())
            .spawn()
            .expect("the program runs");
        sleep(longest.mul_f64(uniform(&mut random)));
        sweep.kill().expect("SIGKILL");
        sweep.wait().expect("it ends");
    }
    printed(folder, &["sweep", "plan.toml", "--out", "rows"]);
    // Neither drafts nor partial files are left.
    let left = files(&folder.join("rows"));
    assert!(left.iter().all(|path| path.extension().is_some_and(|it| it == "csv")), "{left:?}");
    assert_eq!(printed(folder, &["merge", "rows", "--out", "all.csv"]), text);
    assert!(fs::read(folder.join("all.csv")).expect("rows") == expected, "other rows");
}

#[test]
fn killed_three_times_it_gives_the_same_rows() {
    killed(3, GRID, Duration::from_millis(300));
}

#[test]
#[ignore = "the long form: 20 kills, half a minute"]
fn killed_twenty_times_it_gives_the_same_rows() {
    killed(
        20,
        &GRID.replace("trials = 40", "trials = 4000").replace("shards = 6", "shards = 60"),
        Duration::from_millis(1500),
    );
}

#[test]
#[ignore = "the long form: a million trials, minutes"]
fn a_million_trials_in_four_shards_print_the_text_of_one() {
    let plan = "system = 'drone'\ntrials = 1_000_000\n[settings]\nfilter = 'best'\nparticles = 20\nmeasurements = 4";
    let folder = with_plan(plan);
    let folder = folder.path();
    let (rows, text) = single_run(folder);
    in_shards(folder, 4, "rows");
    assert_eq!(printed(folder, &["merge", "rows", "--out", "all.csv"]), text);
    assert!(fs::read(folder.join("all.csv")).expect("rows") == rows, "other rows");
}

#[test]
fn an_engine_tells_which_shard() {
    let folder = with_plan(GRID);
    let folder = folder.path();
    let (_, text) = single_run(folder);
    for (index, engine) in ["HQ_TASK_ID", "SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"]
        .into_iter()
        .cycle()
        .take(6)
        .enumerate()
    {
        let output = Command::new(env!("CARGO_BIN_EXE_host-sim"))
            .current_dir(folder)
            .args(["sweep", "plan.toml", "--out", "rows"])
            .env(engine, index.to_string())
            .output()
            .expect("the program runs");
        assert!(output.status.success());
        assert!(
            String::from_utf8_lossy(&output.stderr)
                .contains(&format!("shard {index}/6, as {engine} says"))
        );
    }
    assert_eq!(printed(folder, &["merge", "rows"]), text);
    assert!(printed(folder, &["sweep", "plan.toml", "--jobs"]).starts_with("6 shards of 160 rows"));
    let summary = printed(folder, &["merge", "rows", "--summary"]);
    assert!(summary.contains("approximately") && summary.contains("limit_m"), "{summary}");
}

/// Whether the flight with this number is broken.
fn is_broken(number: u32) -> bool {
    number % 20 == 10
}

/// Flights of a drone around a user, one in twenty of which is broken in one of several ways.
fn archive(folder: &Path, count: u32) -> u32 {
    let mut broken = 0;
    for number in 0..count {
        let path = folder.join(format!("{}/flight-{number:05}.csv", number % 10));
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        let mut text = "t,x,y,h,path_loss_db\n".to_owned();
        for k in 0..12 {
            let (sine, cosine) = f64::from(k + number).sin_cos();
            let (x, y) = (1000.0 + 600.0 * cosine, 1000.0 + 600.0 * sine);
            let user = 500.0 + f64::from(number % 1000);
            let loss = 78.0 + 20.0 * (((x - user).hypot(y - user)).hypot(800.0) / 800.0).log10();
            writeln!(text, "{},{x:.1},{y:.1},800,{loss:.2}", 5 * k).expect("a text takes it");
        }
        if is_broken(number) {
            broken += 1;
            text = match (number / 20) % 3 {
                0 => String::new(),
                1 => "t,x,y,h\n1,2,3,4\n".to_owned(),
                _ => text.replace("path_loss_db", "voltage"),
            };
        }
        fs::write(path, text).expect("a flight");
    }
    broken
}

fn no_recording_is_lost(count: u32) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let broken = archive(folder, count);
    // Through a known channel, which is quick to compute.
    let by = |more: &[&str]| {
        printed(folder, &[&["replay", "drone", "--environment", "urban"], more].concat())
    };
    let told = by(&["--logs", "*/*.csv", "--out", "table.csv"]);
    assert!(
        told.contains(&format!("{count} lines")) && told.contains(&format!("{broken} failed")),
        "{told}"
    );
    let text = fs::read_to_string(folder.join("table.csv")).expect("a table");
    let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let header = table.headers().expect("a header").clone();
    let place = |name: &str| header.iter().position(|column| column == name).expect(name);
    let (recording, error, health) = (place("recording"), place("error"), place("health"));
    let mut seen = Vec::new();
    for row in table.records() {
        let row = row.expect("a row");
        let number: u32 =
            row[recording][row[recording].len() - 9..][..5].parse().expect("a number");
        let is_broken = is_broken(number);
        assert_eq!(row[error].is_empty(), !is_broken, "{row:?}");
        assert_eq!(row[health].is_empty(), is_broken, "{row:?}");
        assert!(!is_broken || row[error].contains(&format!("flight-{number:05}.csv")), "{row:?}");
        seen.push(number);
    }
    seen.sort_unstable();
    assert_eq!(seen, (0..count).collect::<Vec<_>>());
    // Where no recording has a result, that is a failure, and the reason of the first is told.
    let broken = ["replay", "drone", "--logs", "0/flight-*10.csv", "--out", "none.csv"];
    let told = refusal(folder, &broken);
    assert!(
        told.contains("no recording has a result") && told.contains("flight-00010.csv"),
        "{told}"
    );
    assert!(folder.join("none.csv").exists());
    // A recording replayed by itself has the same report.
    let alone = by(&["--log", "7/flight-00007.csv", "--json"]);
    let alone: serde_json::Value = serde_json::from_str(&alone).expect("an object");
    let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text.as_bytes());
    let row = table
        .records()
        .map(|row| row.expect("a row"))
        .find(|row| row[recording].contains("flight-00007"));
    let sigma = row.expect("a row")[place("sd_m")].parse::<f64>().expect("a number");
    assert_eq!(alone["sd_m"].as_f64(), Some(sigma), "{alone}");
}

#[test]
fn sixty_recordings_of_which_some_are_broken() {
    no_recording_is_lost(60);
}

#[test]
#[ignore = "the long form: minutes"]
fn ten_thousand_recordings_of_which_some_are_broken() {
    no_recording_is_lost(10_000);
}

#[test]
fn a_plan_of_recordings_is_cut_as_one_of_trials() {
    let folder = with_plan(
        "system = 'drone'\nlogs = 'flights/*/*.csv'\nshards = 3\n[settings]\nenvironment = ['suburban', 'urban']",
    );
    let folder = folder.path();
    archive(&folder.join("flights"), 30);
    printed(folder, &["sweep", "plan.toml", "--out", "rows"]);
    let told = printed(folder, &["merge", "rows", "--out", "table.csv"]);
    assert!(told.contains("60 lines") && told.contains("2 failed"), "{told}");
    let text = fs::read_to_string(folder.join("table.csv")).expect("a table");
    assert!(text.contains("--environment suburban") && text.contains("sha256"));
    fs::write(folder.join("flights/3/flight-00003.csv"), "changed").expect("a flight");
    fs::remove_file(folder.join("rows/shard-00000-of-00003.csv")).expect("a shard");
    printed(folder, &["sweep", "plan.toml", "--out", "rows"]);
    printed(folder, &["merge", "rows"]);
}
