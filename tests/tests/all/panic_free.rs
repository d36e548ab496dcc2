//! No crate can panic: programs that call everything a crate offers (`tests/firmware/surface`) link nothing of the
//! panic machinery on any target, at either optimisation; nor an allocator, nor double precision where there should be
//! none. That they call everything is shown by `surface_is_complete.rs`. In the short form (`KESTIRIM_SHORT=1`) what takes
//! any numbers is called in fixed point alone, and what has any size with one, on the Cortex-M4F.
//!
//! On a machine without the tools these tests print SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use target_bench::{CORTEX_M0, CORTEX_M4F, Images, Profile, RV32IMC, Target};

/// A program that panics and computes in double precision, to show that such symbols are detected.
const CONTROL: &str = "control";

/// Crates whose only scalar is `f64`, or that design in it.
const IN_DOUBLES: [&str; 7] = [
    "gnss-message",
    "gnss-ppp",
    "integer-ambiguity",
    "observer-design",
    "ppp-filter",
    "uav-estimator",
    "uav-longitudinal",
];

/// The names of the programs, from their source files.
fn programs() -> Result<Vec<String>> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("firmware/surface/src/bin");
    let stem = |path: PathBuf| Some(path.file_stem()?.to_str()?.to_owned());
    let mut names = Vec::new();
    for entry in fs::read_dir(sources)? {
        names.push(stem(entry?.path()).context("a program with a name")?);
    }
    Ok(names)
}

fn may_use_doubles(program: &str) -> bool {
    let of = program.trim_start_matches("surface-");
    of.ends_with("-f64") || IN_DOUBLES.contains(&of)
}

fn check(target: &'static Target, profile: Profile) -> Result<()> {
    let Some(images) = Images::of_surface(target, profile)? else { return Ok(()) };
    let mut faults = Vec::new();
    for program in programs()? {
        let elf = images.elf(&program)?;
        let (panics, doubles) = (elf.panic_symbols(), elf.double_symbols());
        if program == CONTROL {
            assert!(!panics.is_empty() && !doubles.is_empty(), "symbols are not seen");
            continue;
        }
        let mut fault = |what: &str, symbols: Vec<&str>| {
            if !symbols.is_empty() {
                faults.push(format!("{program} {what}: {symbols:?}"));
            }
        };
        fault("can panic", panics);
        fault("has a heap", elf.heap_symbols());
        if !may_use_doubles(&program) {
            fault("computes in double precision", doubles);
        }
    }
    assert!(faults.is_empty(), "on {} at {}:\n{}", target.triple, profile.opt(), faults.join("\n"));
    Ok(())
}

#[test]
fn cortex_m0() -> Result<()> {
    check(&CORTEX_M0, Profile::Speed)
}

#[test]
fn cortex_m0_for_size() -> Result<()> {
    check(&CORTEX_M0, Profile::Size)
}

#[test]
fn cortex_m4f() -> Result<()> {
    check(&CORTEX_M4F, Profile::Speed)
}

#[test]
fn cortex_m4f_for_size() -> Result<()> {
    check(&CORTEX_M4F, Profile::Size)
}

#[test]
fn rv32imc() -> Result<()> {
    check(&RV32IMC, Profile::Speed)
}

#[test]
fn rv32imc_for_size() -> Result<()> {
    check(&RV32IMC, Profile::Size)
}
