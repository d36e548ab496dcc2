//! Links every binary without a linker script: it is never run, and would not fit on any board.

fn main() {
    println!("cargo::rustc-link-arg-bins=--entry=main");
    println!("cargo::rerun-if-changed=build.rs");
}
