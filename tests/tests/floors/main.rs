//! Every crate belongs to one floor and depends on lower floors only, according to `cargo metadata`. Every package that
//! can be published has the metadata that a registry shows.
//!
//! A crate declares its floor in its `Cargo.toml`: `[package.metadata.kestirim]`, `floor = "estimator"`. Packages
//! outside `crates/` are programs, which may depend on anything and on which no crate may depend.

mod licences;
mod readmes;
mod recipes;

use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use cargo_metadata::{DependencyKind, Metadata, MetadataCommand, Package};

/// The floors of crates, and the floors on which each may depend.
const FLOORS: [(&str, &[&str]); 9] = [
    ("numbers", &["numbers"]),
    // Estimators know no sensor: no model.
    ("estimator", &["numbers", "estimator"]),
    // Models know no estimator.
    ("model", &["numbers", "model"]),
    ("frames", &["numbers", "frames"]),
    // These need the standard library, so nothing that runs on a target may depend on them.
    ("files", &["numbers", "frames", "files"]),
    ("system", &["numbers", "estimator", "model", "frames"]),
    // For PCs: whole recordings, simulated or measured, with which every program feeds systems.
    ("recordings", &["numbers", "estimator", "model", "frames", "files", "system", "recordings"]),
    // Interfaces to another language: they feed systems, as programs do, and no crate depends on them.
    ("interface", &["numbers", "estimator", "model", "frames", "system"]),
    // Interfaces to another language on a PC, with whole recordings; they go to that language's registry.
    ("module", &["numbers", "estimator", "model", "frames", "files", "system", "recordings"]),
];

const LICENCES: [&str; 2] = ["LICENSE-APACHE", "LICENSE-MIT"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn metadata() -> Result<Metadata> {
    Ok(MetadataCommand::new().manifest_path(root().join("Cargo.toml")).no_deps().exec()?)
}

fn folder(package: &Package) -> Result<&Path> {
    Ok(package.manifest_path.parent().context("a manifest is in a folder")?.as_std_path())
}

/// The packages in `crates/`.
fn crates(metadata: &Metadata) -> Vec<&Package> {
    let folder = metadata.workspace_root.join("crates");
    metadata.packages.iter().filter(|package| package.manifest_path.starts_with(&folder)).collect()
}

/// The packages that are published in Cargo's registry.
fn published(metadata: &Metadata) -> Result<Vec<&Package>> {
    let mut published = Vec::new();
    for package in crates(metadata) {
        if floor(package)? != "module" {
            published.push(package);
        }
    }
    Ok(published)
}

/// The floor that a crate declares.
fn floor(package: &Package) -> Result<&str> {
    let floor = package.metadata["kestirim"]["floor"].as_str();
    let known: Vec<_> = FLOORS.iter().map(|(name, _)| *name).collect();
    floor.filter(|floor| known.contains(floor)).with_context(|| {
        format!(
            "{}/Cargo.toml must say where {} stands: [package.metadata.kestirim] with floor = one of {known:?}, \
             but there is {floor:?}",
            package.manifest_path.parent().map_or("", |folder| folder.file_name().unwrap_or("")),
            package.name
        )
    })
}

fn floors<'a>(crates: &[&'a Package]) -> Result<BTreeMap<&'a str, &'a str>> {
    crates.iter().map(|package| Ok((package.name.as_str(), floor(package)?))).collect()
}

/// The height of a floor.
fn height(floor: &str) -> u32 {
    match floor {
        "numbers" => 1,
        "system" => 3,
        "recordings" | "interface" | "module" => 4,
        _ => 2,
    }
}

#[test]
fn no_arrow_points_up() -> Result<()> {
    let metadata = metadata()?;
    let crates = crates(&metadata);
    ensure!(!crates.is_empty(), "there are crates");
    let floors = floors(&crates)?;
    let members: BTreeSet<_> =
        metadata.packages.iter().map(|package| package.name.as_str()).collect();
    let mut wrong = Vec::new();
    for package in crates {
        let (name, floor) = (package.name.as_str(), floors[package.name.as_str()]);
        let (_, allowed) = FLOORS.into_iter().find(|(of, _)| *of == floor).context("a floor")?;
        for dependency in &package.dependencies {
            let on = dependency.name.as_str();
            if !members.contains(on) {
                continue;
            }
            let Some(of) = floors.get(on) else {
                wrong.push(format!("{name} ({floor}) depends on the program {on}"));
                continue;
            };
            // A test may take its numbers from a model.
            let only_tests = dependency.kind == DependencyKind::Development;
            if !(allowed.contains(of) || only_tests && height(of) <= height(floor)) {
                wrong.push(format!("{name} ({floor}) depends on {on} ({of})"));
            }
        }
    }
    assert_eq!(wrong, Vec::<String>::new());
    Ok(())
}

/// Cargo allows cycles through dev-dependencies, but no registry accepts the first package of a cycle.
#[test]
fn there_is_no_circle() -> Result<()> {
    let metadata = metadata()?;
    let mut left: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for package in crates(&metadata) {
        let on = package.dependencies.iter().map(|dependency| dependency.name.as_str());
        left.insert(package.name.as_str(), on.collect());
    }
    while !left.is_empty() {
        let free: Vec<_> = left
            .iter()
            .filter(|(_, on)| !on.iter().any(|on| left.contains_key(on)))
            .map(|(&name, _)| name)
            .collect();
        ensure!(!free.is_empty(), "a circle among {:?}", left.keys());
        left.retain(|name, _| !free.contains(name));
    }
    Ok(())
}

#[test]
fn what_runs_on_a_target_has_no_standard_library() -> Result<()> {
    let metadata = metadata()?;
    for package in crates(&metadata) {
        let library = fs::read_to_string(folder(package)?.join("src/lib.rs"))?;
        let without = library.lines().any(|line| line == "#![no_std]");
        let with = ["files", "recordings", "module"].contains(&floor(package)?);
        assert_ne!(
            without, with,
            "{}: `#![no_std]` in lib.rs, unless it is for a PC alone",
            package.name
        );
    }
    Ok(())
}

#[test]
fn only_crates_are_published() -> Result<()> {
    let metadata = metadata()?;
    let published: BTreeSet<_> = published(&metadata)?.iter().map(|package| &package.id).collect();
    for package in &metadata.packages {
        let private = package.publish.as_ref().is_some_and(Vec::is_empty);
        assert_ne!(private, published.contains(&package.id), "{}: publish = false?", package.name);
    }
    Ok(())
}

#[test]
fn packages_say_what_a_registry_shows() -> Result<()> {
    let metadata = metadata()?;
    let mut keywords: BTreeMap<Vec<String>, &str> = BTreeMap::new();
    for package in published(&metadata)? {
        let name = package.name.as_str();
        for (field, given) in [
            ("description", &package.description),
            ("license", &package.license),
            ("repository", &package.repository),
            ("documentation", &package.documentation),
        ] {
            assert!(given.as_ref().is_some_and(|text| !text.is_empty()), "{name} has no {field}");
        }
        assert_eq!(package.documentation, Some(format!("https://docs.rs/{name}")));
        assert!(package.rust_version.is_some(), "{name} has no rust-version");
        assert!((1..=5).contains(&package.categories.len()), "{name}: {:?}", package.categories);
        assert!((1..=5).contains(&package.keywords.len()), "{name}: {:?}", package.keywords);
        // Keywords that several crates share do not tell them apart.
        let other = keywords.insert(package.keywords.clone(), name);
        assert_eq!(other, None, "{name} has keywords of its own");
    }
    Ok(())
}

#[test]
fn packages_hold_what_they_need() -> Result<()> {
    let metadata = metadata()?;
    for package in crates(&metadata) {
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = Command::new(cargo)
            .args(["package", "--list", "--allow-dirty", "--offline", "-p", package.name.as_str()])
            .current_dir(&metadata.workspace_root)
            .output()?;
        let complaint = String::from_utf8_lossy(&output.stderr);
        ensure!(output.status.success(), "cargo package of {}: {complaint}", package.name);
        let files = String::from_utf8(output.stdout)?;
        for needed in ["Cargo.toml", "README.md", "src/lib.rs"].iter().chain(&LICENCES) {
            assert!(files.lines().any(|file| file == *needed), "{} without {needed}", package.name);
        }
        for licence in LICENCES {
            let [ours, theirs] =
                [folder(package)?.to_owned(), root()].map(|at| fs::read(at.join(licence)));
            assert_eq!(ours?, theirs?, "{}: {licence}", package.name);
        }
    }
    Ok(())
}

/// A library is compiled a second time for unit tests only if its sources contain some.
#[test]
fn libraries_are_built_for_tests_of_their_own_where_they_have_some() -> Result<()> {
    for package in &metadata()?.packages {
        for library in package.targets.iter().filter(|target| target.is_lib()) {
            let folder = library.src_path.parent().context("a library's sources")?;
            let (mut files, mut has_tests) = (Vec::new(), false);
            sources(folder.as_std_path(), &mut files)?;
            for path in files {
                has_tests |= fs::read_to_string(path)?.contains("#[test]");
            }
            let said = if has_tests { "no `test = false`" } else { "`test = false`" };
            ensure!(library.test == has_tests, "[lib] of {} needs {said}", package.name);
        }
    }
    Ok(())
}

/// The folders of `host-sim/src/systems`: the names of the systems.
fn systems() -> Result<BTreeSet<String>> {
    let entries = fs::read_dir(root().join("host-sim/src/systems"))?;
    let folders = entries.filter_map(|entry| entry.ok().filter(|entry| entry.path().is_dir()));
    Ok(folders.filter_map(|folder| folder.file_name().into_string().ok()).collect())
}

/// Collects the Rust sources below a folder, except those of `systems`.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() && !path.ends_with("host-sim/src/systems") {
            sources(&path, found)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    Ok(())
}

#[test]
fn the_program_knows_no_system_by_name() -> Result<()> {
    let names = systems()?;
    ensure!(names.len() >= 5, "the systems stand in host-sim/src/systems: {names:?}");
    let mut all = Vec::new();
    sources(&root().join("host-sim/src"), &mut all)?;
    for path in all {
        for (number, line) in fs::read_to_string(&path)?.lines().enumerate() {
            let words = line.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
            let named = words.map(str::to_lowercase).find(|word| names.contains(word));
            ensure!(
                named.is_none(),
                "{}:{}: names {named:?}; only host-sim/src/systems knows a system",
                path.display(),
                number + 1
            );
        }
    }
    Ok(())
}

#[test]
fn there_is_one_list_of_the_systems() -> Result<()> {
    let names = systems()?;
    let list = fs::read_to_string(root().join("host-sim/src/systems/mod.rs"))?;
    let listed = list.lines().find(|line| line.contains("pub static ALL")).context("the list")?;
    ensure!(listed.contains(&format!("; {}]", names.len())), "{listed} is not of {names:?}");
    for name in &names {
        ensure!(list.contains(&format!("pub mod {name};")), "{name} is no module");
    }
    // No system knows another one.
    for name in &names {
        let mut files = Vec::new();
        sources(&root().join("host-sim/src/systems").join(name), &mut files)?;
        for path in files {
            let text = fs::read_to_string(&path)?;
            let other = names
                .iter()
                .find(|other| *other != name && text.contains(&format!("systems::{other}::")));
            ensure!(other.is_none(), "{} uses {other:?}", path.display());
        }
    }
    Ok(())
}
