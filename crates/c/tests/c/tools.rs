//! Runs compilers and emulators, where available.

use std::env;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, Result, bail, ensure};

/// The folder of the crate.
pub(crate) fn crate_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The folder of this test's files, beside what cargo builds.
pub(crate) fn output_folder() -> PathBuf {
    let own = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    own.parent().map_or(own.clone(), |target| target.join("c-library"))
}

/// Whether all of these programs are available; if not, prints a notice, or fails where they are required.
pub(crate) fn have(test: &str, programs: &[&str]) -> Result<bool> {
    let path = env::var_os("PATH").unwrap_or_default();
    let is_missing =
        |program: &&&str| !env::split_paths(&path).any(|folder| folder.join(program).is_file());
    let Some(missing) = programs.iter().find(is_missing) else { return Ok(true) };
    skip(test, &format!("{missing} is not installed"), "KESTIRIM_REQUIRE_C")?;
    Ok(false)
}

/// Reports why a test is skipped; an error where it must not be.
pub(crate) fn skip(test: &str, why: &str, unless: &str) -> Result<()> {
    if env::var(unless).is_ok_and(|value| value == "1") {
        bail!("{unless}=1, but {why}");
    }
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: {test}: {why}")?;
    Ok(())
}

/// Runs a program that must succeed.
pub(crate) fn run(command: &mut Command) -> Result<Output> {
    let output = command.output().with_context(|| format!("cannot start {command:?}"))?;
    ensure!(
        output.status.success(),
        "{command:?}:\n{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    Ok(output)
}

/// Arguments of text and paths.
pub(crate) fn arguments<'a>(all: &[&'a dyn AsRef<OsStr>]) -> Vec<&'a OsStr> {
    all.iter().map(|argument| (*argument).as_ref()).collect()
}

/// The programs in C.
pub(crate) fn program(file: &str) -> PathBuf {
    crate_folder().join("tests/programs").join(file)
}

/// The folder of the header.
pub(crate) fn include() -> PathBuf {
    crate_folder().join("include")
}

/// Builds `libkestirim.a` with the given cargo, for this computer or for a target; returns its path.
pub(crate) fn library(cargo: &mut Command, target: Option<&str>, fixed: bool) -> Result<PathBuf> {
    let folder = output_folder().join(if fixed { "fixed" } else { "f32" });
    cargo.current_dir(crate_folder().join("staticlib")).env("CARGO_TARGET_DIR", &folder).args([
        "build",
        "--locked",
        "--profile",
        "release-s",
    ]);
    if let Some(target) = target {
        cargo.args(["--target", target]);
    } else {
        quickly(cargo);
    }
    if fixed {
        cargo.args(["--features", "fixed"]);
    }
    run(cargo)?;
    let built = target.map_or_else(|| folder.clone(), |target| folder.join(target));
    Ok(built.join("release-s/libkestirim.a"))
}

/// Turns off optimisation of a library for this computer, whose size and speed are not measured.
pub(crate) fn quickly(command: &mut Command) -> &mut Command {
    command
        .env("CARGO_PROFILE_RELEASE_S_LTO", "off")
        .env("CARGO_PROFILE_RELEASE_S_OPT_LEVEL", "0")
        .env("CARGO_PROFILE_RELEASE_S_CODEGEN_UNITS", "4")
}

/// The folder of the recordings, if it is there.
pub(crate) fn recordings(test: &str) -> Result<Option<PathBuf>> {
    let folder = crate_folder().join("../../../shared/data");
    if Path::new(&folder).is_dir() {
        return Ok(Some(folder));
    }
    skip(test, "../shared/data is absent", "KESTIRIM_REQUIRE_DATA")?;
    Ok(None)
}
