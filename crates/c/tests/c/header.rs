//! `kestirim.h`.

use std::fs;
use std::process::Command;

use anyhow::Result;

use crate::tools::{arguments, crate_folder, have, include, output_folder, program, run};

/// The oldest cbindgen that writes this header.
const CBINDGEN: &str = "0.29";

#[test]
fn the_header_is_what_cbindgen_makes() -> Result<()> {
    if !have("the header is cbindgen's", &["cbindgen"])? {
        return Ok(());
    }
    let version = run(Command::new("cbindgen").arg("--version"))?.stdout;
    let version = String::from_utf8(version)?;
    if !version.trim().starts_with(&format!("cbindgen {CBINDGEN}")) {
        return crate::tools::skip(
            "the header is cbindgen's",
            &format!("{} is not {CBINDGEN}", version.trim()),
            "KESTIRIM_REQUIRE_C",
        );
    }
    let made = run(Command::new("cbindgen").arg("--quiet").current_dir(crate_folder()))?.stdout;
    let committed = fs::read(include().join("kestirim.h"))?;
    assert!(
        made == committed,
        "run `cbindgen --quiet --output include/kestirim.h` in crates/c: the header is not that of the sources"
    );
    Ok(())
}

/// Every warning there is, as an error.
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
