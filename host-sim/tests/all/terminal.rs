//! Tests that tables fit into the terminal.

use std::process::Command;

use crate::program::{is_short, text};

/// The width of the widest row of a table that a command prints, in columns; `None` if it prints no table.
fn widest_row(arguments: &[&str], columns: Option<u16>) -> Option<usize> {
    let mut program = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    program.args(arguments).env_remove("COLUMNS");
    if let Some(columns) = columns {
        program.env("COLUMNS", columns.to_string());
    }
    let output = program.output().expect("the program runs");
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    let printed = text(&output.stdout);
    let rows = printed.lines().filter(|line| line.starts_with(['│', '┌', '╞', '└']));
    rows.map(|row| row.chars().count()).max()
}

#[test]
fn tables_of_every_system_fit_into_60_and_80_columns() {
    for system in ["pedestrian", "robot", "drone", "gnss", "uav"] {
        let run = ["run", system, "--trials", "2"];
        let all = if is_short() { &[60][..] } else { &[60, 80] };
        for &columns in all {
            let widest = widest_row(&run, Some(columns)).expect("a table");
            assert!(widest <= usize::from(columns), "{system}: {widest} in {columns} columns");
        }
    }
}

#[test]
fn a_pipe_gets_whole_lines() {
    let run = ["run", "uav", "--trials", "2"];
    assert!(widest_row(&run, None) > Some(100));
    // An implausible width is ignored.
    assert_eq!(widest_row(&run, Some(0)), widest_row(&run, None));
}

#[test]
fn the_list_of_files_fits_into_80_columns() {
    let mut program = Command::new(env!("CARGO_BIN_EXE_host-sim"));
    let output = program.arg("list").env("COLUMNS", "80").output().expect("the program runs");
    let list = text(&output.stdout);
    assert!(list.contains("--anchors"));
    for line in list.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
}
