//! Tests of shell completion below a command: each shell reads the script that `completions` prints, and is asked for
//! completions.
//!
//! If a shell is missing its test reports SKIPPED, unless `KESTIRIM_REQUIRE_SHELLS` is set.

use std::fs;
use std::process::Command;

use crate::program::{Desk, host_sim, is_missing, refusal, text};

/// A script that prints bash's completions of the last word.
const BASH: &str = r#"
source "$1"; shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
function=$(complete -p host-sim | sed 's/.* -F \([^ ]*\).*/\1/')
"$function" host-sim "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
printf '%s\n' "${COMPREPLY[@]}"
"#;

/// A script that types the words into an interactive shell, and prints the screen up to the expected option.
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

/// Lines to complete, each with an expected completion.
const LINES: [(&[&str], &str); 4] = [
    (&["host-sim", "replay", "robot", "--"], "--anchors"),
    (&["host-sim", "run", "drone", "--"], "--trials"),
    (&["host-sim", "calibrate", "pedestrian", "--"], "--out"),
    (&["host-sim", "live", "--"], "--system"),
];

/// Whether the shell is installed.
fn has(shell: &str) -> bool {
    !is_missing(shell, "KESTIRIM_REQUIRE_SHELLS")
}

/// Writes the completion script for a shell and returns its path.
fn script(desk: &Desk, shell: &str) -> String {
    let output = host_sim(&["completions", shell]);
    assert_eq!(output.status.code(), Some(0));
    let path = desk.named("script");
    fs::write(&path, &output.stdout).expect("the script");
    path
}

/// Asserts the completions of each line in a shell: `arguments` precede its words, and depend on the script and the
/// expected completion.
fn assert_offered(
    shell: &str,
    arguments: impl for<'a> Fn(&'a str, &'a str) -> Vec<&'a str>,
    has_offered: impl Fn(&str, &str) -> bool,
) {
    if !has(shell) {
        return;
    }
    let desk = Desk::new();
    let script = script(&desk, shell);
    for (words, expected) in LINES {
        // The timeout ends a shell that waits for ever.
        let mut command = Command::new("timeout");
        command.args(["60", shell]).args(arguments(&script, expected)).args(words);
        let output = command.output().expect(shell);
        let offered = text(&output.stdout);
        assert!(has_offered(offered, expected), "{words:?}: {offered}");
    }
}

#[test]
fn bash_completes_below_a_command() {
    assert_offered(
        "bash",
        |script, _| vec!["--norc", "-c", BASH, "bash", script],
        |offered, expected| offered.lines().any(|word| word == expected),
    );
}

#[test]
fn zsh_completes_below_a_command() {
    assert_offered(
        "zsh",
        |script, expected| vec!["-f", "-c", ZSH, "zsh", script, expected],
        |screen, expected| screen.contains(expected),
    );
}

#[test]
fn fish_completes_below_a_command() {
    assert_offered(
        "fish",
        |script, _| vec!["--no-config", "-c", FISH, script],
        |offered, expected| offered.lines().any(|line| line.split('\t').next() == Some(expected)),
    );
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
