//! Links every image with the linker script of its target's run-time crate.

fn main() {
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    // Sections need no page alignment on a bare machine; without it the image stays small.
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rerun-if-changed=build.rs");
}
