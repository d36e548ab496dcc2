//! Puts the memory map of the board where the linker looks for `memory.x`.

use std::{env, fs, path::PathBuf};

/// What a SAMD21G18 would have, and all that there is.
const MAPS: [&str; 2] = ["memory/lm3s6965.x", "memory/lm3s6965-whole.x"];

fn main() {
    let [small, whole] = MAPS;
    let map = if env::var_os("CARGO_FEATURE_WHOLE_RAM").is_some() { whole } else { small };
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(map, out.join("memory.x")).expect("the memory map can be copied to OUT_DIR");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rerun-if-changed={map}");
    println!("cargo::rerun-if-changed=build.rs");
}
