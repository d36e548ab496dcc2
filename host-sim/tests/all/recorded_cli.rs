//! Tests of the recorded part of the report, from a folder of data.

use std::fmt::Write as _;
use std::fs;

use crate::program::{Desk, host_sim, refusal, text};

const ANCHORS: [[f64; 3]; 3] = [[0.0, 0.0, 2.0], [6.0, 0.0, 2.0], [3.0, 5.0, 2.0]];

/// Writes a stationary robot with a still IMU to the folder, as one of the recordings whose results are reported.
fn lay_out(desk: &Desk) {
    let folder = desk.path("data/robot/esp32_wall2");
    fs::create_dir_all(&folder).expect("a folder");
    let mut anchors = "anchor,x,y,z\n".to_owned();
    for (index, [x, y, z]) in ANCHORS.iter().enumerate() {
        writeln!(anchors, "{index},{x},{y},{z}").expect("memory");
    }
    let mut ranges = "t,anchor,range\n".to_owned();
    let mut truth = "t,x,y,z\n".to_owned();
    let mut imu = "t,qw,qx,qy,qz,lax,lay,laz\n".to_owned();
    for step in 0..200 {
        let t = f64::from(step) * 0.1;
        let place = [2.5, 2.0, 0.015];
        for (index, anchor) in ANCHORS.iter().enumerate() {
            let squares = anchor.iter().zip(place).map(|(a, p)| (a - p).powi(2));
            writeln!(ranges, "{t:.1},{index},{:.4}", squares.sum::<f64>().sqrt()).expect("memory");
        }
        writeln!(truth, "{t:.1},{:.4},{},{}", place[0], place[1], place[2]).expect("memory");
        writeln!(imu, "{t:.1},1,0,0,0,0,0,0").expect("memory");
    }
    let files = [("anchors", anchors), ("ranges", ranges), ("truth", truth), ("imu", imu)];
    for (name, contents) in files {
        fs::write(folder.join(format!("{name}.csv")), contents).expect("a file");
    }
}

/// The page and the table of a report with the recordings of a folder.
fn report(desk: &Desk) -> (String, String) {
    let [folder, data] = ["report", "data"].map(|name| desk.named(name));
    let output = host_sim(&["run", "robot", "--trials", "2", "--report", &folder, "--data", &data]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let read = |name: &str| fs::read_to_string(desk.path("report").join(name)).expect("a file");
    (read("index.html"), read("results.csv"))
}

#[test]
fn recordings_that_are_there_are_shown_and_the_others_named() {
    let desk = Desk::new();
    lay_out(&desk);
    let (page, table) = report(&desk);
    let id = "robot-recorded-wall-esp32-wall2-plan";
    assert!(page.contains(&format!(r#"data-figure="{id}""#)));
    assert!(desk.path("report").join(format!("{id}.svg")).is_file());
    assert!(page.contains("trek_4vba0: robot/trek_4vba0/anchors.csv and 5 more are missing"));
    assert!(page.contains("host-sim replay robot"));
    let mut rows = csv::Reader::from_reader(table.as_bytes());
    let rows: Vec<_> = rows.records().collect::<Result<_, _>>().expect("rows");
    let row = rows.iter().find(|row| &row[1] == "robot-recorded-wall" && &row[2] == "RMSE");
    let row = row.expect("a number of the recording");
    // The ranges have no noise.
    assert!(row[5].parse::<f64>().expect("a number") < 5.0, "{row:?}");
    assert_eq!(&row[9], "30", "what is known of it");
    let command = rows.iter().find(|row| &row[3] == "esp32_wall2").expect("the recording");
    assert!(command[11].contains("--height 0.015"), "{command:?}");
}

#[test]
fn an_empty_folder_gives_a_sentence_for_each_recording() {
    let desk = Desk::new();
    fs::create_dir(desk.path("data")).expect("a folder");
    let (page, table) = report(&desk);
    assert!(page.contains("No recording that the results are told of is there."));
    assert!(page.contains("plaza1: robot/plaza1/anchors.csv and 3 more are missing"));
    assert!(!table.contains("robot-recorded"));
}

#[test]
fn a_folder_of_data_has_to_be_there_and_a_report_asked_for() {
    let desk = Desk::new();
    let [folder, data] = ["report", "nowhere"].map(|name| desk.named(name));
    let sentence = refusal(&["run", "robot", "--report", &folder, "--data", &data]);
    assert!(sentence.contains("nowhere: cannot be read"), "{sentence}");
    assert!(!desk.path("report").exists());
    assert!(refusal(&["run", "robot", "--data", &data]).contains("--report"));
}
