//! Tests of the page's scripts: they are short, and checked as far as their types are known.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::is_missing;

/// The maximum number of lines of own JavaScript.
const MOST_LINES: usize = 1200;

fn scripts() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    let files = fs::read_dir(folder).expect("the assets").filter_map(Result::ok);
    let paths = files.map(|file| file.path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "js")).collect()
}

#[test]
fn there_is_little_of_it() {
    let lines = |path: &PathBuf| fs::read_to_string(path).expect("text").lines().count();
    let all: usize = scripts().iter().map(lines).sum();
    assert!((100..=MOST_LINES).contains(&all), "{all} lines");
}

#[test]
fn types_names_and_results_are_right() {
    // Debian's package is node-typescript.
    if is_missing("tsc", "KESTIRIM_REQUIRE_BROWSER") {
        return;
    }
    let known = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/page.d.ts");
    let checks = ["--noUnusedLocals", "--noUnusedParameters", "--noImplicitReturns"];
    let output = Command::new("tsc")
        .args(["--allowJs", "--checkJs", "--noEmit", "--target", "es2022"])
        .args(["--lib", "es2022,dom,dom.iterable"])
        .args(checks)
        .arg(known)
        .args(scripts())
        .output()
        .expect("tsc runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
