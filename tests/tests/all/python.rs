//! The Python package, built, installed into an environment of its own, and tested there.
//!
//! Without Python, its `venv`, or a way to `PyPI` this test says SKIPPED and passes; with `KESTIRIM_REQUIRE_PYTHON=1` it
//! fails instead, and so it does if other packages, whose speed ours is compared with, cannot be had.

use std::env;
use std::io::{self, Write};
use std::iter;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, Result, ensure};

/// A wheel is no larger, bytes.
const LARGEST_WHEEL: u64 = 8 << 20;

fn skipped(why: &str) -> Result<()> {
    let required = env::var("KESTIRIM_REQUIRE_PYTHON").is_ok_and(|value| value == "1");
    ensure!(!required, "KESTIRIM_REQUIRE_PYTHON=1, but {why}");
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: Python: {why}")?;
    Ok(())
}

/// The folder in which everything is built, beside the tests' own.
fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("python")
}

fn crate_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/python")
}

/// Runs a program of the environment.
fn run(program: &str, arguments: &[&str]) -> io::Result<Output> {
    let (build, programs) = (target().join("target"), target().join("venv/bin"));
    // The builder of wheels calls `maturin` by its name.
    let others = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths(iter::once(programs.clone()).chain(env::split_paths(&others)))
        .map_err(io::Error::other)?;
    Command::new(programs.join(program))
        .env("PATH", path)
        .args(arguments)
        .current_dir(crate_folder())
        .env("CARGO_TARGET_DIR", build)
        // What is tested holds without it, and it takes minutes; in one unit, too, which is less work. The level of
        // optimisation is kept: speed is tested, too.
        .env("CARGO_PROFILE_RELEASE_LTO", "off")
        .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "1")
        .env("KESTIRIM_HOST_SIM", env!("CARGO_BIN_EXE_replay"))
        .env("PIP_DISABLE_PIP_VERSION_CHECK", "1")
        .env_remove("PYTHONPATH")
        .output()
}

fn done(what: &str, output: &Output) -> Result<()> {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    ensure!(output.status.success(), "{what}: {}\n{out}\n{err}", output.status);
    // With --nocapture: what was tested and what was skipped.
    println!("{out}");
    Ok(())
}

#[test]
fn the_package_is_installed_and_tested() -> Result<()> {
    std::fs::create_dir_all(target())?;
    if !target().join("venv/bin/pip").exists() {
        let mut venv = Command::new("python3");
        venv.args(["-m", "venv", "--clear"]).arg(target().join("venv"));
        let made = venv.output();
        if !made.is_ok_and(|made| made.status.success()) {
            return skipped("there is no python3 with venv");
        }
    }
    // What the package and its tests need; peers are compared with where they can be had. Of what is installed a small part
    // is loaded, and compiled then.
    let needed = [
        "install",
        "-q",
        "--no-compile",
        "maturin>=1.9,<2",
        "numpy>=1.22",
        "pytest",
        "mypy",
        "pandas",
    ];
    if !run("pip", &needed)?.status.success() {
        return skipped("PyPI cannot be reached");
    }
    let peers = run("pip", &["install", "-q", "--no-compile", "filterpy", "imufusion"])?;
    if !peers.status.success() {
        skipped("filterpy and imufusion cannot be had")?;
    }
    let wheels = target().join("wheels");
    let folder = wheels.to_str().context("a path of letters")?;
    let _ = std::fs::remove_dir_all(&wheels);
    let wheel = ["wheel", "-q", "--no-deps", "--no-build-isolation", "-w", folder, "."];
    done("pip wheel", &run("pip", &wheel)?)?;
    let wheel = std::fs::read_dir(&wheels)?.next().context("a wheel")??;
    let (size, path) = (wheel.metadata()?.len(), wheel.path());
    println!("{}: {size} bytes", path.display());
    ensure!(size <= LARGEST_WHEEL, "a wheel of {size} bytes");
    let path = path.to_str().context("a path of letters")?.to_owned();
    let install = ["install", "-q", "--no-deps", "--force-reinstall", &path];
    done("pip install", &run("pip", &install)?)?;
    done("pytest", &run("python", &["-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider"])?)
}
