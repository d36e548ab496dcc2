//! Passes the linker arguments for macOS, where all functions must be known at link time although the interpreter
//! provides Python's.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
