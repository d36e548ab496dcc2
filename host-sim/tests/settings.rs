//! Tests that a setting is declared once: the command line, the page and a live stream have the same ones, each has an
//! effect or a reason for none, and the settings can be reproduced as a command and as firmware.

mod program;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use clap::Arg;
use host_sim::commands;
use host_sim::system::{
    Answer, AnySystem, Kind, Number, Opened, Setting, SettingValue, Settings, Source,
};
use host_sim::systems::ALL;

/// Texts in the forms that settings have.
const TEXTS: [&str; 6] = [
    "anchors",
    "-2,-2.5,-3,-3.5",
    "0.01,0.02",
    "0.01,0.02,0.3,0.04",
    "0.5,0.5,4,5",
    "3582104,532590,5232755",
];

/// The arguments of a subcommand, selected by words including the system's name.
fn arguments(words: &[&str]) -> Vec<Arg> {
    let typed: Vec<_> = ["host-sim"].iter().chain(words).map(OsString::from).collect();
    let mut command = commands::command(&typed);
    for word in words.iter().filter(|word| !word.starts_with('-')) {
        if let Some(found) = command.find_subcommand(word) {
            command = found.clone();
        }
    }
    command.get_arguments().cloned().collect()
}

/// A synthetic recording of a system.
fn open(system: &dyn AnySystem, name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(system.settings());
    system.open(Source::Synthetic(name.to_owned()), &settings).expect("it needs no file")
}

/// The synthetic recordings whose every setting is tried: all, and in the short form (`KESTIRIM_SHORT=1`) the first.
fn tried(system: &dyn AnySystem) -> &'static [(&'static str, &'static str)] {
    let all = system.synthetic();
    if program::is_short() { &all[..1] } else { all }
}

fn with(opened: &dyn Opened, given: &[(&'static str, SettingValue)]) -> Settings {
    let mut settings = Settings::new(opened.settings());
    settings.give(given.to_vec());
    settings
}

/// The answer of a recording with these values, or `None` if it refuses them; computed once, whichever test asks first.
fn answer(
    system: &dyn AnySystem,
    recording: &str,
    opened: &dyn Opened,
    given: &[(&'static str, SettingValue)],
) -> Option<Arc<Answer>> {
    type Answered = Arc<OnceLock<Option<Arc<Answer>>>>;
    static ANSWERED: Mutex<BTreeMap<String, Answered>> = Mutex::new(BTreeMap::new());
    // A second caller waits for this answer only.
    let key = format!("{} {recording} {given:?}", system.name());
    let answered =
        ANSWERED.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_default().clone();
    answered.get_or_init(|| opened.answer(&with(opened, given)).ok()).clone()
}

/// Values of a setting that differ from the default.
fn others(setting: &Setting) -> Vec<SettingValue> {
    let text = |text: &str| SettingValue::Text(text.to_owned());
    match &setting.kind {
        Kind::Switch { default } => vec![SettingValue::Switch(!default)],
        Kind::Choice { of, default } => {
            let names = of.iter().map(|named| named.name.as_str());
            names.filter(|name| name != default).map(text).collect()
        }
        Kind::Set { of } => {
            of.iter().map(|named| SettingValue::Set(vec![named.name.clone()])).collect()
        }
        Kind::Number(Number { min, max, step, logarithmic, initially, .. }) => {
            let (up, down) = if *logarithmic {
                ((initially * 4.0).min(*max), (initially / 4.0).max(*min))
            } else {
                let far = (8.0 * step).max((max - min) / 4.0 / step * step);
                ((initially + far).min(*max), (initially - far).max(*min))
            };
            let whole = |value: f64| if *step >= 1.0 { value.round() } else { value };
            let values = [whole(up), whole(down)].into_iter().filter(|value| value != initially);
            values.map(SettingValue::Number).collect()
        }
        Kind::Text { .. } => {
            let texts = TEXTS.iter().map(|known| text(known));
            texts.filter(|value| setting.takes(value)).take(1).collect()
        }
    }
}

/// Everything visible in an answer except the command and the firmware.
fn seen(answer: &Answer) -> (Vec<(String, String)>, Vec<String>, String) {
    (answer.facts.clone(), answer.warnings.clone(), format!("{:?}", answer.figures))
}

fn is_idle(answer: &Answer, name: &str) -> bool {
    answer.disabled.iter().any(|(idle, reason)| *idle == name && !reason.is_empty())
}

/// Given values to test in: none at first, then each single choice or switch.
fn contexts(opened: &dyn Opened) -> Vec<Vec<(&'static str, SettingValue)>> {
    let settings = opened.settings();
    let choices = settings
        .iter()
        .filter(|setting| matches!(setting.kind, Kind::Choice { .. } | Kind::Switch { .. }));
    let single = choices
        .flat_map(|setting| others(setting).into_iter().map(|value| vec![(setting.name, value)]));
    std::iter::once(Vec::new()).chain(single).collect()
}

#[test]
fn the_command_line_the_page_and_a_stream_have_the_same_settings() {
    for system in ALL {
        let replay = arguments(&["replay", system.name()]);
        let live = arguments(&["live", "--system", system.name()]);
        let find = |all: &[Arg], setting: &Setting| {
            let option = setting.option();
            let is = |arg: &&Arg| arg.get_long() == Some(option.as_str());
            all.iter().find(is).cloned()
        };
        for setting in system.settings() {
            let name = format!("{} --{}", system.name(), setting.name);
            let on_line = find(&replay, &setting).unwrap_or_else(|| panic!("{name}: no command"));
            let help = on_line.get_help().map(ToString::to_string).unwrap_or_default();
            let control = setting.control();
            let label = control["label"].as_str().unwrap_or_default();
            // A switch that is on is described as turned off: "Do not use …" for "Use …".
            let is_in = |help: &str| help.to_lowercase().contains(&label.to_lowercase());
            assert!(is_in(&help) && !label.is_empty(), "{name}: {help:?}, {label:?}");
            if let Kind::Choice { of, .. } | Kind::Set { of } = &setting.kind {
                let names: Vec<_> = of.iter().map(|named| named.name.clone()).collect();
                let options = control["options"].as_array().expect("options");
                let shown: Vec<_> =
                    options.iter().map(|it| it[0].as_str().unwrap().to_owned()).collect();
                assert_eq!(names, shown, "{name}");
                for value in &names {
                    assert!(setting.read(value).is_ok(), "{name} {value}");
                }
            }
            if let Kind::Number(number) = &setting.kind {
                assert_eq!(control["unit"], number.unit, "{name}");
                for bound in [number.min, number.max] {
                    assert!(setting.takes(&SettingValue::Number(bound)), "{name} {bound}");
                    assert!(setting.read(&bound.to_string()).is_ok(), "{name} {bound}");
                }
            }
            match find(&live, &setting) {
                // A replay may describe a file of the same name as well, which a stream does not have.
                Some(arg) if setting.in_live => {
                    let in_live = arg.get_help().map(ToString::to_string).unwrap_or_default();
                    assert!(is_in(&help) && is_in(&in_live), "{name}: {in_live:?}");
                    let form = setting.form();
                    let names = arg.get_value_names().unwrap_or_default();
                    let takes = matches!(setting.kind, Kind::Number(_) | Kind::Text { .. });
                    let is_shown = names.iter().any(|known| known.starts_with(form.as_str()));
                    assert!(!takes || is_shown, "{name}: {names:?}");
                }
                None if !setting.in_live || system.panels().is_empty() => {}
                // `live` itself has an option of that name.
                Some(arg) => assert_ne!(arg.get_help(), on_line.get_help(), "{name}"),
                None => panic!("{name}: missing in live"),
            }
        }
    }
}

#[test]
fn every_setting_changes_the_page_or_says_why_not() {
    for system in ALL {
        let mut waiting: Vec<_> = system.settings().iter().map(|setting| setting.name).collect();
        // Settings without effect that give no reason, and where: in another context they may have one.
        let mut silent = Vec::new();
        for (recording, _) in system.synthetic() {
            let opened = open(system, recording);
            for context in contexts(&*opened) {
                let answer = |given: &[_]| answer(system, recording, &*opened, given);
                let Some(before) = answer(&context) else { continue };
                for setting in opened.settings() {
                    let unfound = waiting.contains(&setting.name);
                    if !unfound || context.iter().any(|(name, _)| *name == setting.name) {
                        continue;
                    }
                    if is_idle(&before, setting.name) {
                        continue;
                    }
                    let changes = |value: SettingValue| {
                        let given = [&context[..], &[(setting.name, value)]].concat();
                        answer(&given).is_some_and(|after| seen(&after) != seen(&before))
                    };
                    if others(&setting).into_iter().any(changes) {
                        waiting.retain(|name| *name != setting.name);
                    } else {
                        silent.push((setting.name, *recording, format!("{context:?}")));
                    }
                }
                if waiting.is_empty() {
                    break;
                }
            }
        }
        // A setting for files only gives that reason for every synthetic recording.
        for name in waiting {
            let never = silent.iter().find(|(silent, ..)| *silent == name);
            assert!(
                never.is_none(),
                "{} changes nothing and does not say so: {never:?}",
                system.name()
            );
            for (recording, _) in system.synthetic() {
                let opened = open(system, recording);
                let answer = answer(system, recording, &*opened, &[]).expect("an answer");
                let is_there = opened.settings().iter().any(|setting| setting.name == name);
                let says = !is_there || is_idle(&answer, name);
                assert!(says, "{} {recording}: {name} was never tried", system.name());
            }
        }
    }
}

#[test]
fn the_command_gives_the_same_result_again() {
    for system in ALL {
        for (recording, _) in tried(system) {
            let opened = open(system, recording);
            for setting in std::iter::once(None).chain(opened.settings().into_iter().map(Some)) {
                let given =
                    setting.and_then(|setting| Some((setting.name, others(&setting).pop()?)));
                let given: Vec<_> = given.into_iter().collect();
                let Some(answer) = answer(system, recording, &*opened, &given) else { continue };
                if given.iter().any(|(name, _)| is_idle(&answer, name)) {
                    continue;
                }
                let words = words(&answer.command);
                let typed: Vec<OsString> = words.iter().map(OsString::from).collect();
                let matches = commands::command(&typed)
                    .try_get_matches_from(&words)
                    .unwrap_or_else(|error| panic!("{}: {error}", answer.command));
                let account = commands::replayed(&matches)
                    .unwrap_or_else(|error| panic!("{}: {error}", answer.command));
                let shown = &answer.facts[..account.facts.len().min(answer.facts.len())];
                assert_eq!(account.facts, shown, "{}", answer.command);
            }
        }
    }
}

/// Splits a command as a shell does.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for letter in command.chars() {
        match letter {
            '\'' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            letter => words.last_mut().expect("there is one").push(letter),
        }
    }
    words
}

#[test]
fn the_firmware_literal_compiles() {
    let mut source = "#![allow(unused)]\n".to_owned();
    let mut count = 0;
    for system in ALL {
        for (recording, _) in tried(system) {
            let opened = open(system, recording);
            let each = opened.settings().into_iter().flat_map(|setting| {
                others(&setting).into_iter().map(move |value| vec![(setting.name, value)])
            });
            let mut literals: Vec<_> = std::iter::once(Vec::new())
                .chain(each)
                .filter_map(|given| {
                    Some(answer(system, recording, &*opened, &given)?.firmware.clone())
                })
                .collect();
            literals.sort();
            literals.dedup();
            for literal in literals {
                writeln!(source, "fn literal_{count}() {{\n{literal}\n}}").expect("a string");
                count += 1;
            }
        }
    }
    assert!(count > 2 * ALL.len(), "{count} literals");
    check(&source);
}

/// Checks a crate with this source that depends on every crate of this workspace.
fn check(source: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the root");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("firmware-literals");
    fs::create_dir_all(folder.join("src")).expect("a folder");
    let mut manifest = "[package]\nname = \"firmware-literals\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n\
                        nalgebra = { version = \"*\", default-features = false }\n"
        .to_owned();
    for entry in fs::read_dir(root.join("crates")).expect("crates") {
        let path = entry.expect("an entry").path();
        let name =
            path.file_name().and_then(|name| name.to_str()).expect("a plain name").to_owned();
        if fs::read_to_string(path.join("src/lib.rs")).is_ok_and(|text| text.contains("#![no_std]"))
        {
            writeln!(manifest, "kestirim-{name} = {{ path = \"{}\" }}", path.display())
                .expect("a string");
        }
    }
    fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
    fs::write(folder.join("src/lib.rs"), source).expect("a source");
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))
        .expect("the versions of this workspace");
    let output = Command::new(env!("CARGO"))
        .args(["check", "--quiet", "--offline"])
        .current_dir(&folder)
        // A folder of its own: in that of the tests it would wait for whatever cargo does there.
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A zoom and a comparison request the same answer again, for which no estimator runs.
#[test]
fn what_was_answered_last_is_not_computed_again() {
    for system in ALL {
        let opened = open(system, system.synthetic()[0].0);
        let first = opened.answer(&with(&*opened, &[])).expect("an answer");
        let again = opened.answer(&with(&*opened, &[])).expect("an answer");
        assert!(Arc::ptr_eq(&first, &again), "{}", system.name());
    }
}
