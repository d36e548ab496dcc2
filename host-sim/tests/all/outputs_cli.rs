//! Tests of the files that runs write, and of behaviour that shells and scripts rely on.

use std::fs;
use std::process::Command;

use crate::program::{Desk, host_sim, json, refusal};

#[test]
fn a_run_writes_tables_streams_and_a_report() {
    let desk = Desk::new();
    let [csv, mcap, folder] = ["robot.csv", "robot.mcap", "report"].map(|name| desk.named(name));
    let arguments = ["run", "robot", "--trials", "2", "--json"];
    let files = ["--csv", &csv, "--mcap", &mcap, "--report", &folder];
    let report = json(&host_sim(&[&arguments[..], &files].concat()));
    assert_eq!(report, json(&host_sim(&arguments)), "files change nothing of what is printed");
    let table = fs::read_to_string(&csv).expect("the tables");
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let header = rows.headers().expect("a header").clone();
    let numbers = ["value", "standard_error", "n", "published", "limit"];
    let numbers = numbers.map(|name| header.iter().position(|it| it == name).expect("a column"));
    let rows: Vec<_> = rows.records().collect::<Result<_, _>>().expect("rows");
    for row in &rows {
        for cell in numbers.map(|column| &row[column]).iter().filter(|cell| !cell.is_empty()) {
            assert!(cell.parse::<f64>().is_ok_and(f64::is_finite), "{cell:?} in {row:?}");
        }
    }
    // The published number stands beside the paper's own method, not beside ours.
    let mean = |method: &str| {
        let mut of = rows.iter().filter(|row| &row[1] == "robot-table-1" && &row[4] == method);
        of.find(|row| row[3].starts_with("mean")).map(|row| row[numbers[3]].to_owned())
    };
    assert_eq!(mean("published AEKF").as_deref(), Some("2.52"));
    assert_eq!(mean("default").as_deref(), Some(""));
    let magic = [0x89, b'M', b'C', b'A', b'P', b'0', b'\r', b'\n'];
    let streams = fs::read(&mcap).expect("the streams");
    assert!(streams.starts_with(&magic) && streams.ends_with(&magic));
    for name in ["index.html", "results.csv", "results.json", "robot.mcap"] {
        assert!(desk.path("report").join(name).is_file(), "{name}");
    }
    let figures = fs::read_dir(desk.path("report")).expect("the folder");
    let svg = figures
        .filter_map(Result::ok)
        .filter(|file| file.path().extension().is_some_and(|e| e == "svg"));
    let mut drawn = 0;
    for file in svg {
        let drawing = fs::read_to_string(file.path()).expect("text");
        assert!(drawing.trim_end().ends_with("</svg>"), "{:?}", file.path());
        drawn += 1;
    }
    assert!(drawn > 5, "{drawn} figures");
}

#[test]
fn two_outputs_are_two_files() {
    let desk = Desk::new();
    let both = desk.named("both");
    let sentence = refusal(&["run", "robot", "--csv", &both, "--mcap", &both]);
    assert!(sentence.contains("--csv and --mcap name the same file"), "{sentence}");
    assert!(!desk.path("both").exists());
}

#[test]
fn what_cannot_be_written_is_refused_before_anything_is_calculated() {
    let desk = Desk::new();
    let file = desk.named("file");
    fs::write(&file, "").expect("a file");
    let below = format!("{file}/report");
    // A hundred million trials would take a day.
    let long = ["run", "drone", "--trials", "100000000"];
    for output in ["--report", "--csv", "--mcap"] {
        let sentence = refusal(&[&long[..], &[output, &below]].concat());
        assert!(sentence.contains("cannot be written"), "{output}: {sentence}");
    }
    // The attempt leaves nothing behind.
    let unmade = desk.named("unmade/report");
    refusal(&["run", "robot", "--report", &unmade, "--csv", &below]);
    assert!(!desk.path("unmade").exists());
    let mut everything = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    let folder = desk.path("folder");
    fs::create_dir(&folder).expect("a folder");
    fs::write(folder.join("target"), "").expect("a file in its way");
    let output = everything.current_dir(&folder).output().expect("the program runs");
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
}

#[test]
fn a_slip_of_the_finger_is_told_what_was_meant() {
    for (arguments, meant) in [
        (&["run", "robit"][..], "robot"),
        (&["replay", "robot", "--ancors", "a", "--log", "b"], "--anchors"),
    ] {
        let sentence = refusal(arguments);
        assert!(sentence.contains(&format!("did you mean {meant}?")), "{sentence}");
    }
    assert!(!refusal(&["run", "abacus"]).contains("did you mean"));
}

#[test]
fn help_has_no_colours_where_nobody_wants_them() {
    let help = |name: &str, value: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_host-sim"));
        let output = program.arg("--help").env_remove("NO_COLOR").env(name, value).output();
        output.expect("the program runs").stdout.contains(&0x1b)
    };
    assert!(help("CLICOLOR_FORCE", "1"), "colours can be had");
    assert!(!help("NO_COLOR", "1"));
}
