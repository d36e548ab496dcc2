//! A change of what is stored must raise the version: `layouts.txt` holds the layouts as they were when it was raised
//! last.
//!
//! `KESTIRIM_RECORD_LAYOUTS=1` rewrites the file, after the versions were raised.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use super::Visit;
use super::shape;
use super::streams::{Kind, visit_all};
use super::systems::{Sample, Sleeper};

const RECORD: &str = "KESTIRIM_RECORD_LAYOUTS";

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/all/snapshots/layouts.txt")
}

/// The version and layout of each estimator, in single precision or in the numbers it has.
#[derive(Default)]
struct Layouts(BTreeMap<String, (u16, String)>);

impl Visit for Layouts {
    fn visit<E: Sleeper>(&mut self, _: &Kind, mut estimator: E, samples: &[Sample]) {
        let number = E::number().to_string();
        if number != "f32" && E::NAME != "ppp" || self.0.contains_key(E::NAME) {
            return;
        }
        // After half of its stream every optional part is present.
        for sample in &samples[..samples.len() / 2] {
            estimator.take(sample);
        }
        let (_, types) = shape::of(&estimator);
        let mut text = String::new();
        for (name, fields) in types {
            writeln!(text, "  {name} {{ {fields} }}").expect("a text");
        }
        self.0.insert(E::NAME.into(), (E::VERSION, text));
    }
}

impl Layouts {
    fn write(&self) -> String {
        let one = |(name, (version, types)): (&String, &(u16, String))| {
            format!("{name} {version}\n{types}")
        };
        self.0.iter().map(one).collect::<Vec<_>>().join("\n")
    }

    fn read(text: &str) -> Self {
        let one = |block: &str| {
            let (head, types) = block.split_once('\n')?;
            let (name, version) = head.split_once(' ')?;
            Some((name.to_owned(), (version.parse().ok()?, format!("{}\n", types.trim_end()))))
        };
        Self(text.split("\n\n").filter_map(one).collect())
    }
}

/// What to do about a layout that differs from the recorded one.
fn advice(name: &str, recorded: Option<&(u16, String)>, now: &(u16, String)) -> Option<String> {
    let again = format!("run this test with {RECORD}=1");
    match recorded {
        Some(recorded) if recorded == now => None,
        Some((version, _)) if *version == now.0 => Some(format!(
            "what {name} stores has changed, but its version is still {version}: snapshots of before would be \
             misread. Raise it in the snapshot.rs of its crate, then {again}"
        )),
        Some(_) => Some(format!("the version of {name} was raised: {again}")),
        None => Some(format!("{name} is new: {again}")),
    }
}

#[test]
fn a_changed_layout_has_another_version() {
    let mut now = Layouts::default();
    visit_all(&mut now);
    let text = fs::read_to_string(file()).unwrap_or_default();
    let recorded = Layouts::read(&text);
    let unraised = |(name, layout): (&String, &(u16, String))| {
        let raised = recorded.0.get(name).is_none_or(|of| of == layout || of.0 != layout.0);
        (!raised).then(|| advice(name, recorded.0.get(name), layout)).flatten()
    };
    if env::var(RECORD).is_ok_and(|value| value == "1") {
        let unraised: Vec<_> = now.0.iter().filter_map(unraised).collect();
        assert!(unraised.is_empty(), "{}", unraised.join("\n"));
        fs::write(file(), now.write()).expect("the file of layouts");
        return;
    }
    let advice: Vec<_> = now
        .0
        .iter()
        .filter_map(|(name, layout)| advice(name, recorded.0.get(name), layout))
        .collect();
    assert!(advice.is_empty(), "{}", advice.join("\n"));
    assert_eq!(recorded.0.len(), now.0.len(), "an estimator is no longer there");
}

#[test]
fn a_change_without_another_version_is_told() {
    let layout = |version, fields: &str| (version, format!("  Mean {{ {fields} }}\n"));
    let before = layout(1, "sum: f32");
    let told = |now| advice("mean", Some(&before), &now).unwrap_or_default();
    assert_eq!(told(layout(1, "sum: f32")), "");
    assert!(told(layout(1, "sum: f32, count: u32")).contains("its version is still 1"));
    assert!(told(layout(2, "sum: f32, count: u32")).contains("was raised"));
}
