//! The memory use and the linked symbols of an image, from its file.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use object::elf::{SHF_ALLOC, SHF_WRITE};
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags};

/// Sections with which linker scripts reserve the rest of the RAM; they hold no variables.
const RESERVED: [&str; 2] = [".heap", ".stack"];

/// Memory and symbols of an image.
#[derive(Clone, Debug)]
pub struct Elf {
    /// The size of code, constants and initial values of variables, bytes.
    pub flash_bytes: u64,
    /// The size of static variables, bytes.
    pub ram_bytes: u64,
    symbols: Vec<String>,
}

impl Elf {
    /// Reads the file of an image.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let file = object::File::parse(&*bytes)?;
        let mut elf = Self { flash_bytes: 0, ram_bytes: 0, symbols: Vec::new() };
        for section in file.sections() {
            let SectionFlags::Elf { sh_flags, .. } = section.flags() else { continue };
            let allocated = sh_flags.contains(SHF_ALLOC);
            let writable = sh_flags.contains(SHF_WRITE);
            if allocated && section.file_range().is_some() {
                elf.flash_bytes += section.size();
            }
            if allocated && writable && !RESERVED.contains(&section.name()?) {
                elf.ram_bytes += section.size();
            }
        }
        for symbol in file.symbols() {
            elf.symbols.push(symbol.name()?.to_owned());
        }
        Ok(elf)
    }

    /// The linked parts of the panic machinery (mangled names): empty if nothing in the image can panic.
    pub fn panic_symbols(&self) -> Vec<&str> {
        self.symbols_that(is_of_panics)
    }

    /// The linked routines of double-precision arithmetic: empty if nothing in the image computes with `f64`.
    pub fn double_symbols(&self) -> Vec<&str> {
        self.symbols_that(is_of_doubles)
    }

    /// The linked parts of a memory allocator: empty if nothing in the image uses a heap.
    pub fn heap_symbols(&self) -> Vec<&str> {
        self.symbols_that(is_of_heap)
    }

    fn symbols_that(&self, are_meant: fn(&str) -> bool) -> Vec<&str> {
        self.symbols.iter().map(String::as_str).filter(|name| are_meant(name)).collect()
    }
}

fn is_of_panics(name: &str) -> bool {
    ["panicking", "unwrap_failed", "expect_failed"].iter().any(|part| name.contains(part))
        || name.split_once("slice_").is_some_and(|(_, rest)| rest.contains("fail"))
}

/// Whether a symbol is `__rust_alloc` or similar, `alloc::alloc::GlobalAlloc`, or the C library's allocator.
fn is_of_heap(name: &str) -> bool {
    ["__rust_", "__rg_", "__rdl_"]
        .iter()
        .any(|prefix| name.split_once(prefix).is_some_and(|(_, rest)| rest.contains("alloc")))
        || name.contains("GlobalAlloc")
        || ["malloc", "calloc", "realloc", "free"].contains(&name)
}

/// Whether a symbol is `__aeabi_dadd`, `__aeabi_f2d` and so on of the Arm run-time ABI, or `__adddf3`, `__truncdfsf2`
/// and so on of the compilers.
fn is_of_doubles(name: &str) -> bool {
    let Some(name) = name.strip_prefix("__") else { return false };
    match name.strip_prefix("aeabi_") {
        Some(name) => name.starts_with('d') || name.ends_with("2d"),
        None => name.contains("df") && name.chars().all(|c| c.is_ascii_alphanumeric()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_are_told_apart() {
        for name in [
            "_RNvNtCs5yb_4core9panicking18panic_bounds_check",
            "_ZN4core6option13unwrap_failed17h0123E",
            "_RNvNtNtCs5yb_4core5slice5index16slice_index_fail",
        ] {
            assert!(is_of_panics(name), "{name}");
        }
        for name in ["memcpy", "_RNvNtCs5yb_4core5slice4iter"] {
            assert!(!is_of_panics(name), "{name}");
        }
        for name in ["__aeabi_dmul", "__aeabi_f2d", "__muldf3", "__extendsfdf2", "__floatunsidf"] {
            assert!(is_of_doubles(name), "{name}");
        }
        for name in ["__aeabi_fmul", "__aeabi_uldivmod", "__mulsf3", "__udivdi3", "main"] {
            assert!(!is_of_doubles(name), "{name}");
        }
        for name in
            ["_RNvCs5yb_7___rustc12___rust_alloc", "__rg_dealloc", "__rust_realloc", "malloc"]
        {
            assert!(is_of_heap(name), "{name}");
        }
        for name in ["__rust_start_panic", "main", "_RNvCs5yb_5alloc_free"] {
            assert!(!is_of_heap(name), "{name}");
        }
    }
}
