//! Puts the memory map of the board where the linker looks for `memory.x`.

use std::{env, fs, path::PathBuf};

/// The memory maps of the machine with the most peripherals, and of that with the most memory.
const MAPS: [&str; 2] = ["memory/lm3s6965.x", "memory/mps2-an386.x"];

fn main() {
    let [usual, large] = MAPS;
    let map = if env::var_os("CARGO_FEATURE_MPS2_AN386").is_some() { large } else { usual };
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(map, out.join("memory.x")).expect("the memory map can be copied to OUT_DIR");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rerun-if-changed={map}");
    println!("cargo::rerun-if-changed=build.rs");
}
