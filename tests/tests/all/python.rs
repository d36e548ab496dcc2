//! Installs the Python package into an environment of its own and runs its tests there.
//!
//! The module is the one that cargo built with these tests; with `KESTIRIM_WHEEL=1` a wheel is built and installed, as
//! `pip install ./crates/python` does, which takes minutes.
//!
//! Without Python, its `venv`, or access to `PyPI` this test prints SKIPPED and passes; with
//! `KESTIRIM_REQUIRE_PYTHON=1` it fails instead, also if other packages, whose speed ours is compared with, are
//! unavailable.

use std::env::{
    self,
    consts::{DLL_PREFIX, DLL_SUFFIX},
};
use std::fs;
use std::io::{self, Write};
use std::iter;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, Result, ensure};

/// The largest accepted size of a wheel, bytes.
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
    // The wheel builder calls `maturin` by its name.
    let others = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths(iter::once(programs.clone()).chain(env::split_paths(&others)))
        .map_err(io::Error::other)?;
    Command::new(programs.join(program))
        .env("PATH", path)
        .args(arguments)
        .current_dir(crate_folder())
        .env("CARGO_TARGET_DIR", build)
        .env("KESTIRIM_HOST_SIM", env!("CARGO_BIN_EXE_replay"))
        .env("PIP_DISABLE_PIP_VERSION_CHECK", "1")
        .env_remove("PYTHONPATH")
        .output()
}

/// The standard output of a successful program.
fn done(what: &str, output: io::Result<Output>) -> Result<String> {
    let output = output?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    ensure!(output.status.success(), "{what}: {}\n{out}\n{err}", output.status);
    // With `--nocapture`: what was tested and what was skipped.
    println!("{out}");
    Ok(out)
}

/// Builds a wheel and installs it.
fn install_wheel() -> Result<()> {
    let wheels = target().join("wheels");
    let folder = wheels.to_str().context("a path of letters")?;
    let _ = fs::remove_dir_all(&wheels);
    let wheel = ["wheel", "-q", "--no-deps", "--no-build-isolation", "-w", folder, "."];
    done("pip wheel", run("pip", &wheel))?;
    let wheel = fs::read_dir(&wheels)?.next().context("a wheel")??;
    let (size, path) = (wheel.metadata()?.len(), wheel.path());
    println!("{}: {size} bytes", path.display());
    ensure!(size <= LARGEST_WHEEL, "a wheel of {size} bytes");
    let path = path.to_str().context("a path of letters")?.to_owned();
    done("pip install", run("pip", &["install", "-q", "--no-deps", "--force-reinstall", &path]))?;
    Ok(())
}

/// Puts the package where pip would, with the module that was built with these tests.
fn install_built() -> Result<()> {
    let folder = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let packages = done("where packages are", run("python", &["-c", folder]))?;
    let package = Path::new(packages.trim()).join("kestirim");
    let _ = fs::remove_dir_all(&package);
    fs::create_dir(&package)?;
    for file in fs::read_dir(crate_folder().join("python/kestirim"))? {
        let file = file?;
        if file.file_type()?.is_file() {
            fs::copy(file.path(), package.join(file.file_name()))?;
        }
    }
    let programs = Path::new(env!("CARGO_BIN_EXE_replay")).parent().context("a folder")?;
    let module = programs.join("deps").join(format!("{DLL_PREFIX}_kestirim{DLL_SUFFIX}"));
    fs::copy(&module, package.join("_kestirim.abi3.so"))
        .with_context(|| module.display().to_string())?;
    Ok(())
}

#[test]
fn the_package_is_installed_and_tested() -> Result<()> {
    let as_wheel = env::var("KESTIRIM_WHEEL").is_ok_and(|value| value == "1");
    fs::create_dir_all(target())?;
    if !target().join("venv/bin/pip").exists() {
        let mut venv = Command::new("python3");
        venv.args(["-m", "venv", "--clear"]).arg(target().join("venv"));
        let made = venv.output();
        if !made.is_ok_and(|made| made.status.success()) {
            return skipped("there is no python3 with venv");
        }
    }
    // The requirements of the package and its tests; peers are compared with where available. Only a small part of what
    // is installed is loaded, and compiled at that time.
    let mut needed =
        vec!["install", "-q", "--no-compile", "numpy>=1.22", "pytest", "mypy", "pandas"];
    needed.extend(as_wheel.then_some("maturin>=1.9,<2"));
    if !run("pip", &needed)?.status.success() {
        return skipped("PyPI cannot be reached");
    }
    let peers = run("pip", &["install", "-q", "--no-compile", "filterpy", "imufusion"])?;
    if !peers.status.success() {
        skipped("filterpy and imufusion cannot be had")?;
    }
    if as_wheel { install_wheel() } else { install_built() }?;
    let tests = ["-m", "pytest", "-q", "-rs", "-p", "no:cacheprovider"];
    done("pytest", run("python", &tests)).map(drop)
}
