//! What a linker is told on macOS, where it wants to know every function already: the interpreter brings Python's.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
