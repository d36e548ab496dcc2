//! Puts the memory map of the target's board where the linker looks for `memory.x`, and tells the crate which board it
//! is built for: no built-in `cfg` distinguishes one Cortex-M from another.

use std::{env, fs, path::PathBuf};

/// A linker script without log strings: the images' crates could log, as in an application, but what is measured logs
/// nothing and has no section for the strings.
const NO_LOG: &str = "\nSECTIONS { /DISCARD/ : { *(.defmt.*) } }\n";

fn main() {
    let target = env::var("TARGET").expect("cargo sets TARGET");
    let board = match target.as_str() {
        "thumbv6m-none-eabi" => "microbit",
        "thumbv7em-none-eabihf" => "mps2-an386",
        "riscv32imc-unknown-none-elf" => "virt",
        other => panic!("no board for target {other}; see tests/firmware/README.md"),
    };
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let map = format!("memory/{board}.x");
    let text = fs::read_to_string(&map).expect("the memory map can be read");
    fs::write(out.join("memory.x"), text + NO_LOG).expect("it can be copied to OUT_DIR");

    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-check-cfg=cfg(board, values(\"microbit\", \"mps2-an386\", \"virt\"))");
    println!("cargo::rustc-cfg=board=\"{board}\"");
    println!("cargo::rerun-if-changed={map}");
    println!("cargo::rerun-if-changed=build.rs");
}
