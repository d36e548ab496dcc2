//! The fault matrix: faults put into recordings, their effect on the answer, and whether the user was told.
//!
//! A case is silently wrong if its error is more than three times the clean one and more than three times the reported
//! standard deviation, and neither health nor a warning nor a refusal says so. Each such case is listed in [`UNSEEN`]
//! with the reason; a new one fails, and so does a listed one that is reported by now. With `--nocapture` the whole
//! table is printed as in the book.

mod drone;
mod gnss;
mod pedestrian;
mod robot;
mod table;
mod uav;

use std::path::Path;

use anyhow::{Context, Result};
use host_sim::system::{AnySystem, Files, Settings, Source, Wanted};
use serde_json::Value;
use tempfile::TempDir;

/// Faults that no estimator can see, or ours does not see yet: the beginning of the names of recording and fault, and
/// the reason.
const UNSEEN: &[(&str, &str, &str)] = &[
    ("esp32_los2", "room mirrored", "a mirrored room has the same ranges"),
    ("lias_mid_tag1", "room mirrored", "the same"),
    ("trek_m1l", "room mirrored", "the same"),
    (
        "trek_m1l",
        "anchors counted from another number",
        "turned by a quarter, a square has the same ranges",
    ),
];

/// The longest accepted sentence, in characters: longer ones are not read while something is wrong.
const LONGEST_SENTENCE: usize = 200;

/// One run of a system: its error, m (UAV: mrad), and what was reported to the user.
#[derive(Debug, Clone)]
struct Answer {
    /// The error; `None` if the run was refused.
    error: Option<f64>,
    over_sigma: Option<f64>,
    /// The state and reasons of the health, or the refusal.
    told: String,
    /// The warnings. A fault counts as reported if the run was refused, the health is not good, or there is a warning
    /// that the clean recording lacks.
    warnings: Vec<String>,
    is_good: bool,
}

/// A recording with a fault in it.
struct Case {
    recording: String,
    fault: &'static str,
    clean: Answer,
    faulty: Answer,
}

impl Case {
    fn is_told(&self) -> bool {
        let is_new = |warning: &String| !self.clean.warnings.contains(warning);
        self.faulty.error.is_none()
            || !self.faulty.is_good
            || self.faulty.warnings.iter().any(is_new)
    }

    fn is_harmed(&self) -> bool {
        let errors = self.faulty.error.zip(self.clean.error);
        errors.is_some_and(|(faulty, clean)| faulty > 2.0 * clean)
    }

    fn is_silent_and_wrong(&self) -> bool {
        let errors = self.faulty.error.zip(self.clean.error);
        let is_wrong = errors.is_some_and(|(faulty, clean)| faulty > 3.0 * clean);
        is_wrong && !self.is_told() && self.faulty.over_sigma.is_none_or(|ratio| ratio > 3.0)
    }

    fn row(&self) -> String {
        let number =
            |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |it| format!("{it:.3}"));
        let [clean, faulty] = [&self.clean, &self.faulty].map(|answer| number(answer.error));
        let ratio = number(self.faulty.over_sigma);
        let told = if self.is_told() { self.faulty.told.as_str() } else { "no" };
        let verdict = match (self.is_silent_and_wrong(), self.is_harmed(), self.is_told()) {
            (true, ..) => "SILENT",
            (_, true, true) => "told",
            (_, true, false) => "within σ or 3 ×",
            _ => "unharmed",
        };
        format!(
            "| {} | {} | {clean} | {faulty} | {ratio} | {told} | {verdict} |",
            self.recording, self.fault
        )
    }
}

/// Runs a system on files with these settings.
fn run(
    system: &dyn AnySystem,
    files: &[(&str, &Path)],
    settings: &[(&str, &str)],
    measure: fn(&Value) -> Option<f64>,
) -> Result<Answer> {
    run_writing(system, files, settings, measure, &Wanted::default())
}

/// Runs a system on files with these settings, and writes files.
fn run_writing(
    system: &dyn AnySystem,
    files: &[(&str, &Path)],
    settings: &[(&str, &str)],
    measure: fn(&Value) -> Option<f64>,
    wanted: &Wanted,
) -> Result<Answer> {
    let mut given = Settings::new(system.settings());
    for (name, value) in settings {
        given.set(name, value)?;
    }
    let mut read = Files::default();
    for (field, path) in files {
        read.add(*field, *path);
    }
    let account =
        system.open(Source::Files(read), &given).and_then(|opened| opened.replay(&given, wanted));
    Ok(match account {
        Err(error) => {
            let told =
                format!("refused: {}", error.to_string().rsplit('/').next().unwrap_or_default());
            Answer { error: None, over_sigma: None, told, warnings: Vec::new(), is_good: false }
        }
        Ok(account) => {
            let over_sigma = &account.report["accuracy"]["error_over_sigma"];
            let over_sigma = over_sigma.as_f64().or_else(|| over_sigma[0].as_f64());
            let in_words = account.health.to_string();
            let is_good = in_words == "good";
            let told = if is_good { "a warning".to_owned() } else { in_words };
            let error = measure(&account.report).or(Some(f64::INFINITY));
            Answer { error, over_sigma, told, warnings: account.warnings, is_good }
        }
    })
}

/// Prints the table as the book has it: one row for each fault, two columns for each recording.
fn print(cases: &[Case]) {
    let number = |error: Option<f64>| match error {
        None => "refused".to_owned(),
        Some(error) if error.is_infinite() => "none".to_owned(),
        Some(error) if error < 10.0 => format!("{error:.3}"),
        Some(error) => format!("{error:.0}"),
    };
    let first = cases.first().map_or("", |case| case.fault);
    let cleans = cases.iter().filter(|case| case.fault == first);
    let columns =
        cleans.map(|case| format!("{}: {} | told", case.recording, number(case.clean.error)));
    let columns: Vec<_> = columns.collect();
    println!("| fault | {} |\n|---{}|", columns.join(" | "), "|---|---".repeat(columns.len()));
    let one = cases.iter().take_while(|case| case.recording == cases[0].recording);
    for Case { fault, .. } in one {
        let same = cases.iter().filter(|case| case.fault == *fault);
        let columns = same.map(|case| {
            let told = match (case.is_silent_and_wrong(), case.is_told()) {
                _ if case.faulty.error.is_none() => "",
                (true, _) => "**no**",
                (_, true) => &case.faulty.told,
                _ => "–",
            };
            format!("{} | {told}", number(case.faulty.error))
        });
        println!("| {fault} | {} |", columns.collect::<Vec<_>>().join(" | "));
    }
}

/// Judges all cases of a system at once.
fn judge(cases: &[Case]) {
    print(cases);
    let told = cases.iter().filter(|case| case.is_told()).count();
    let harmed = cases.iter().filter(|case| case.is_harmed());
    println!("{} cases, {} harmed, {told} told", cases.len(), harmed.count());
    for case in cases {
        assert!(case.clean.error.is_some(), "{} is refused without a fault", case.recording);
        assert!(case.clean.is_good, "false alarm for {}: {:?}", case.recording, case.clean);
    }
    let sentences = cases.iter().flat_map(|Case { faulty, .. }| {
        faulty.warnings.iter().chain(faulty.error.is_none().then_some(&faulty.told))
    });
    for sentence in sentences {
        // The length of a path depends on its folder.
        let own = sentence.split_whitespace().filter(|word| !word.contains('/'));
        let length: usize = own.map(|word| word.chars().count() + 1).sum();
        assert!(length <= LONGEST_SENTENCE, "{length} characters: {sentence}");
    }
    for case in cases {
        let is_known = UNSEEN.iter().any(|(recording, fault, _)| {
            (case.recording.as_str(), case.fault) == (*recording, *fault)
        });
        assert_eq!(
            case.is_silent_and_wrong(),
            is_known,
            "silent and wrong, or not any more: {}",
            case.row()
        );
    }
}

/// A folder for faulty files.
fn desk() -> Result<TempDir> {
    tempfile::tempdir().context("a folder")
}
