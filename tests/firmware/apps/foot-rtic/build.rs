//! Links the application with the linker scripts of its run-time and of its log.

fn main() {
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    println!("cargo::rustc-link-arg-bins=-Tdefmt.x");
    // Sections on bare metal need no page alignment; without it the image stays small.
    println!("cargo::rustc-link-arg-bins=--nmagic");
    println!("cargo::rustc-env=DEFMT_LOG=info");
    println!("cargo::rerun-if-changed=build.rs");
}
