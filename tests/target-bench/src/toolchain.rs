//! Finds a Rust toolchain that can build for a target, and builds with it.
//!
//! There are two suitable kinds: one with the target installed (`rustup target add …`), or one with the sources of the
//! standard library, from which `core` is built (`rustup component add rust-src`, or Debian's packages as in
//! `.ci/install-target-tools`). A linker is needed, too: rustup brings `rust-lld`, Debian `ld.lld`.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use crate::form::{SHORT, is_short};
use crate::target::Target;

/// The environment variables that a build inherits. All others, above all those that cargo and rustup set for this very
/// process, would make the images depend on how the tests were started.
const ENVIRONMENT: [&str; 8] = [
    "PATH",
    "HOME",
    "CARGO_HOME",
    "CARGO_NET_OFFLINE",
    "HTTPS_PROXY",
    "https_proxy",
    "SSL_CERT_FILE",
    "SSL_CERT_DIR",
];

/// A package with its own workspace.
#[derive(Clone, Copy, Debug)]
pub struct Apart {
    /// The parent of the package's folder, relative to the repository.
    pub folder: &'static str,
    /// The name of the package and of its folder.
    pub name: &'static str,
}

/// A toolchain that can build for one target.
#[derive(Debug)]
pub(crate) struct Toolchain {
    pub(crate) target: &'static Target,
    sysroot: PathBuf,
    builds_core: bool,
    linker: Option<&'static str>,
}

impl Toolchain {
    /// The first suitable toolchain: the one that runs these tests, or the system's. Otherwise a sentence on what is
    /// missing.
    pub(crate) fn find(target: &'static Target) -> Result<Self, String> {
        let own = own_sysroot();
        own.into_iter().chain([PathBuf::from("/usr")]).find_map(|sysroot| Self::at(sysroot, target)).ok_or_else(|| {
            format!(
                "no Rust toolchain for {0}: run .ci/install-target-tools or rustup target add {0}",
                target.triple
            )
        })
    }

    fn at(sysroot: PathBuf, target: &'static Target) -> Option<Self> {
        let rustlib = sysroot.join("lib/rustlib");
        let installed = rustlib.join(target.triple).join("lib").is_dir();
        let sources = rustlib.join("src/rust/library/Cargo.lock").is_file();
        let cargo = sysroot.join("bin/cargo").is_file();
        let linker = if has_rust_lld(&rustlib) {
            None
        } else if is_installed("ld.lld") {
            Some("ld.lld")
        } else {
            return None;
        };
        (cargo && (installed || sources)).then_some(Self {
            target,
            sysroot,
            builds_core: !installed,
            linker,
        })
    }

    /// The version of the compiler: counts from two compilers, or with another optimisation of `core`, are not
    /// comparable.
    pub(crate) fn version(&self) -> Result<String> {
        let answer = Command::new(self.sysroot.join("bin/rustc")).arg("--version").output()?;
        let version = String::from_utf8(answer.stdout)?;
        let core = if self.builds_core { "core built from source" } else { "core as shipped" };
        Ok(format!("{}, {core}", version.trim_end()))
    }

    /// Builds the images of these packages together and returns their directory.
    pub(crate) fn build(&self, packages: &[&str], profile: &str) -> Result<PathBuf> {
        self.build_in(&workspace(), packages, profile)
    }

    /// Builds an application with its own workspace.
    pub(crate) fn build_apart(&self, package: Apart, profile: &str) -> Result<PathBuf> {
        let folder = workspace().join("../..").join(package.folder).join(package.name);
        self.build_in(&folder, &[package.name], profile)
    }

    fn build_in(&self, workspace: &Path, packages: &[&str], profile: &str) -> Result<PathBuf> {
        let triple = self.target.triple;
        let output = target_directory();
        let mut cargo = Command::new(self.sysroot.join("bin/cargo"));
        cargo
            .env_clear()
            .envs(ENVIRONMENT.iter().filter_map(|&name| Some((name, env::var_os(name)?))))
            .env("RUSTC", self.sysroot.join("bin/rustc"))
            .env("CARGO_TARGET_DIR", &output)
            .current_dir(workspace)
            .args(["build", "--locked", "--bins", "--profile", profile, "--target", triple])
            .args(packages.iter().flat_map(|package| ["-p", package]));
        if is_short() {
            // The surface is built for fewer numbers then.
            cargo.env(SHORT, "1");
        }
        if self.builds_core {
            cargo
                .env("RUSTC_BOOTSTRAP", "1")
                .args(["-Zbuild-std=core", "-Zbuild-std-features=compiler-builtins-mem"]);
        }
        if let Some(linker) = self.linker {
            let triple = triple.to_uppercase().replace('-', "_");
            cargo.env(format!("CARGO_TARGET_{triple}_LINKER"), linker);
        }
        let result = cargo.output().context("cannot start the cargo of the target")?;
        ensure!(
            result.status.success(),
            "the images for {triple} do not build:\n{}",
            String::from_utf8_lossy(&result.stderr)
        );
        Ok(output.join(triple).join(profile))
    }
}

/// Whether a program is in the search path.
pub(crate) fn is_installed(program: &str) -> bool {
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path).any(|directory| directory.join(program).is_file())
}

/// The toolchain of the `rustc` in the search path.
fn own_sysroot() -> Option<PathBuf> {
    let answer = Command::new("rustc").args(["--print", "sysroot"]).output().ok()?;
    Some(PathBuf::from(String::from_utf8(answer.stdout).ok()?.trim_end()))
}

/// Whether a toolchain includes the linker that rustc calls for bare-metal targets.
fn has_rust_lld(rustlib: &Path) -> bool {
    let hosts = rustlib.read_dir().into_iter().flatten().flatten();
    hosts.map(|host| host.path().join("bin/rust-lld")).any(|linker| linker.is_file())
}

/// The workspace of the images.
fn workspace() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware")
}

/// The directory in which the images are built: beside that of this process, which cargo marks with a tag.
fn target_directory() -> PathBuf {
    let program = env::current_exe().unwrap_or_default();
    program
        .ancestors()
        .find(|directory| directory.join("CACHEDIR.TAG").is_file())
        .map_or_else(|| workspace().join("target"), |directory| directory.join("firmware"))
}
