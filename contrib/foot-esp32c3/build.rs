//! Passes linker scripts: the HAL's for images in flash, and the one that collects defmt's format strings.

fn main() {
    println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    println!("cargo::rustc-link-arg-bins=-Tlinkall.x");
    println!("cargo::rustc-env=DEFMT_LOG=info");
    println!("cargo::rerun-if-changed=build.rs");
}
