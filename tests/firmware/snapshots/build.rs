//! Links every image with the linker script of its target's run-time crate.

fn main() {
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    // Sections on bare metal need no page alignment; without it the image stays small.
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rerun-if-changed=build.rs");
}
