//! What a shell offers below a command: each shell reads the script that `completions` prints, and is asked.
//!
//! Where a shell is missing its test says SKIPPED, unless `KESTIRIM_REQUIRE_SHELLS` is set.

use std::env;
use std::fs;
use std::process::{Command, Stdio};

use crate::program::{Desk, host_sim, refusal, text};

/// Prints what bash offers for the last of the words.
const BASH: &str = r#"
source "$1"; shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
function=$(complete -p host-sim | sed 's/.* -F \([^ ]*\).*/\1/')
"$function" host-sim "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\n' "${COMPREPLY[@]}"
"#;

/// Types the words into an interactive shell, and prints the screen up to the option that is expected.
const ZSH: &str = r#"
zmodload zsh/zpty
script=$1 expected=$2; shift 2
zpty shell zsh -f -i
zpty -w shell "PS1= LISTMAX=0; stty columns 200 rows 2000; autoload -Uz compinit; compinit -u -D; source ${(q)script}; print rea''dy"
zpty -r shell screen '*ready*'
zpty -w -n shell "$*"$'\t\t'
zpty -r shell screen "*$expected*"
print -r -- "$screen"
zpty -d shell
"#;

const FISH: &str = "source $argv[1]; complete -C \"$argv[2..-1]\"";

/// Lines that a test types, and what is to be offered.
const LINES: [(&[&str], &str); 4] = [
    (&["host-sim", "replay", "robot", "--"], "--anchors"),
    (&["host-sim", "run", "drone", "--"], "--trials"),
    (&["host-sim", "calibrate", "pedestrian", "--"], "--out"),
    (&["host-sim", "live", "--"], "--system"),
];

/// Whether the shell is there.
fn has(shell: &str) -> bool {
    let there = Command::new(shell).arg("--version").stdout(Stdio::null()).status().is_ok();
    assert!(there || env::var_os("KESTIRIM_REQUIRE_SHELLS").is_none(), "{shell} is missing");
    if !there {
        println!("SKIPPED: {shell} is missing");
    }
    there
}

/// A file with the script for a shell.
fn script(desk: &Desk, shell: &str) -> String {
    let output = host_sim(&["completions", shell]);
    assert_eq!(output.status.code(), Some(0));
    let path = desk.named("script");
    fs::write(&path, &output.stdout).expect("the script");
    path
}

fn offered(shell: &str, arguments: &[&str]) -> String {
    // A shell that waits for what never comes is ended.
    let output = Command::new("timeout").args(["60", shell]).args(arguments).output().expect(shell);
    text(&output.stdout).to_owned()
}

#[test]
fn bash_completes_below_a_command() {
    if !has("bash") {
        return;
    }
    let desk = Desk::new();
    let script = script(&desk, "bash");
    for (words, expected) in LINES {
        let offered = offered("bash", &[&["--norc", "-c", BASH, "bash", &script], words].concat());
        assert!(offered.lines().any(|word| word == expected), "{words:?}: {offered}");
    }
}

#[test]
fn zsh_completes_below_a_command() {
    if !has("zsh") {
        return;
    }
    let desk = Desk::new();
    let script = script(&desk, "zsh");
    for (words, expected) in LINES {
        let offered =
            offered("zsh", &[&["-f", "-c", ZSH, "zsh", &script, expected], words].concat());
        assert!(offered.contains(expected), "{words:?}: {offered}");
    }
}

#[test]
fn fish_completes_below_a_command() {
    if !has("fish") {
        return;
    }
    let desk = Desk::new();
    let script = script(&desk, "fish");
    for (words, expected) in LINES {
        let offered = offered("fish", &[&["--no-config", "-c", FISH, &script], words].concat());
        let mut lines = offered.lines();
        assert!(
            lines.any(|line| line.split('\t').next() == Some(expected)),
            "{words:?}: {offered}"
        );
    }
}

#[test]
fn other_shells_are_told_how_to_complete_or_refused() {
    for shell in ["powershell", "elvish"] {
        let output = host_sim(&["completions", shell]);
        assert_eq!(output.status.code(), Some(0));
        assert!(text(&output.stdout).contains("calibrate"), "{shell}");
    }
    refusal(&["completions", "abacus"]);
}
