//! Runs the program and examines its output.

// Each test uses a part of it.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

pub(crate) fn host_sim<S: AsRef<std::ffi::OsStr>>(arguments: &[S]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_host-sim")).args(arguments).output().expect("the program runs")
}

/// Whether only the short form of the tests is asked for (`KESTIRIM_SHORT=1`).
pub(crate) fn is_short() -> bool {
    std::env::var("KESTIRIM_SHORT").is_ok_and(|it| it == "1")
}

/// Whether a program is missing, which is reported; fails if the environment variable `required` is set.
pub(crate) fn is_missing(program: &str, required: &str) -> bool {
    let is_missing = Command::new(program).arg("--version").output().is_err();
    if is_missing {
        assert!(std::env::var_os(required).is_none(), "{program} is missing");
        println!("SKIPPED: {program} is missing");
    }
    is_missing
}

pub(crate) fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("the program speaks UTF-8")
}

pub(crate) fn json(output: &Output) -> Value {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object")
}

/// The one sentence of a refusal.
pub(crate) fn refusal(arguments: &[&str]) -> String {
    let output = host_sim(arguments);
    let sentence = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {sentence}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert_eq!(sentence.trim_end().lines().count(), 1, "{sentence}");
    // Paths are not counted: their length depends on the folder.
    let own = sentence
        .trim_start_matches("host-sim: ")
        .split_whitespace()
        .filter(|word| !word.contains('/'));
    let length: usize = own.map(|word| word.chars().count() + 1).sum();
    assert!(length <= 200, "{length} characters: {sentence}");
    sentence.to_owned()
}

/// The number of messages on each topic of an MCAP file.
pub(crate) fn messages(file: impl AsRef<Path>) -> BTreeMap<String, usize> {
    let bytes = fs::read(file).expect("a file");
    let mut counts = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).expect("an MCAP file") {
        *counts.entry(message.expect("a message").channel.topic.clone()).or_insert(0) += 1;
    }
    counts
}

/// The header and rows of a track: its first columns as numbers, and the last, which is the health.
pub(crate) fn rows_of<const N: usize>(file: impl AsRef<Path>) -> (String, Vec<([f64; N], String)>) {
    let written = fs::read_to_string(file).expect("a track");
    let mut lines = written.lines();
    let header = lines.next().expect("a header").to_owned();
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(fields.len(), header.split(',').count(), "{line}");
        let number = |column: usize| fields[column].parse().expect("a number");
        (std::array::from_fn(number), fields[fields.len() - 1].to_owned())
    };
    let rows = lines.map(row).collect();
    (header, rows)
}

/// A temporary folder for files, with their paths as text.
pub(crate) struct Desk(TempDir);

impl Desk {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder for the test"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> String {
        fs::write(self.path(name), contents).expect("the folder can be written");
        self.named(name)
    }

    pub(crate) fn named(&self, name: &str) -> String {
        self.path(name).to_str().expect("a plain name").to_owned()
    }
}
