//! Puts the memory map of the board where the linker looks for `memory.x`.

use std::{env, fs, path::PathBuf};

const MAP: &str = "memory/lm3s6965.x";

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(MAP, out.join("memory.x")).expect("the memory map can be copied to OUT_DIR");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rerun-if-changed={MAP}");
    println!("cargo::rerun-if-changed=build.rs");
}
