//! Links the program with the map of QEMU's machine, which the images have, too, and with the scripts of its
//! run-time and of its log.

use std::{env, fs, path::PathBuf};

const MAP: &str = "../../support/memory/virt.x";

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::copy(MAP, out.join("memory.x")).expect("the memory map can be copied to OUT_DIR");
    println!("cargo::rustc-link-search={}", out.display());
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    // Sections on bare metal need no page alignment; without it the image stays small.
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rustc-env=DEFMT_LOG=info");
    println!("cargo::rerun-if-changed={MAP}");
    println!("cargo::rerun-if-changed=build.rs");
}
