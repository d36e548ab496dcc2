//! Links every binary without a linker script: it is not to run, and no board would hold it.

fn main() {
    println!("cargo::rustc-link-arg-bins=--entry=main");
    println!("cargo::rerun-if-changed=build.rs");
}
