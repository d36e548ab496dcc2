//! Sets `cfg(armv6m)` if the target is a Cortex-M0 or M0+, for which the language has no condition.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(armv6m)");
    if std::env::var("TARGET").is_ok_and(|target| target.starts_with("thumbv6m-")) {
        println!("cargo::rustc-cfg=armv6m");
    }
}
