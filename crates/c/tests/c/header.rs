//! Tests of the header `kestirim.h`.

use std::env;
use std::fs;
use std::process::Command;

use anyhow::Result;

use crate::tools::{arguments, crate_folder, have, include, output_folder, program, run};

/// The environment variable that, if it is 1, makes the test write the header instead of comparing it.
const WRITE: &str = "KESTIRIM_WRITE_HEADER";

#[test]
fn the_header_is_what_cbindgen_makes() -> Result<()> {
    let mut made = Vec::new();
    cbindgen::generate(crate_folder())?.write(&mut made);
    let file = include().join("kestirim.h");
    if env::var(WRITE).is_ok_and(|value| value == "1") {
        return Ok(fs::write(file, made)?);
    }
    let same = made == fs::read(file)?;
    assert!(same, "the header is not that of the sources: {WRITE}=1 and this test writes it anew");
    Ok(())
}

/// The flags that turn every warning into an error.
const STRICT: [&str; 5] = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"];

fn compiles(compiler: &str, standard: &str, language: &str) -> Result<()> {
    if !have("the header compiles", &[compiler])? {
        return Ok(());
    }
    let folder = output_folder();
    fs::create_dir_all(&folder)?;
    let source = folder.join(format!("header-{standard}.c"));
    let main = "int main(void) { return kestirim_status_name(KESTIRIM_STATUS_OK) == NULL; }\n";
    fs::write(&source, format!("#include \"kestirim.h\"\n#include \"kestirim.h\"\n{main}"))?;
    let standard = format!("-std={standard}");
    let mut command = Command::new(compiler);
    command.args(STRICT).args(arguments(&[&standard, &"-x", &language, &"-I", &include()]));
    run(command.arg("-fsyntax-only").arg(source))?;
    Ok(())
}

#[test]
fn the_header_is_c99() -> Result<()> {
    compiles("cc", "c99", "c")
}

#[test]
fn the_header_is_c11() -> Result<()> {
    compiles("cc", "c11", "c")
}

#[test]
fn the_header_is_cpp17() -> Result<()> {
    compiles("c++", "c++17", "c++")
}

#[test]
fn the_programs_are_c99_without_a_warning() -> Result<()> {
    if !have("the programs are C99", &["cc"])? {
        return Ok(());
    }
    for file in super::programs::PROGRAMS {
        let source = program(&format!("{file}.c"));
        let mut command = Command::new("cc");
        command.args(STRICT).args(arguments(&[&"-std=c99", &"-I", &include()]));
        run(command.arg("-fsyntax-only").arg(source))?;
    }
    Ok(())
}
