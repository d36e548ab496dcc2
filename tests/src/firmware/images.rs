//! The images of one target and profile, built once.

use std::collections::BTreeMap;
use std::env;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, bail};

use super::elf::Elf;
use super::output::Output;
use super::qemu;
use super::target::Target;
use super::toolchain::{Toolchain, is_installed};

/// Set to 1, a missing tool is a failure instead of a reason to skip: CI cannot skip unseen.
const REQUIRE: &str = "KESTIRIM_REQUIRE_TARGETS";

/// What the compiler optimises for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Profile {
    /// Few instructions: opt-level 3.
    Speed,
    /// Small code: opt-level "s".
    Size,
}

impl Profile {
    /// The optimisation level as tables name it.
    pub fn opt(self) -> &'static str {
        match self {
            Self::Speed => "3",
            Self::Size => "s",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Speed => "release",
            Self::Size => "release-s",
        }
    }
}

/// The images of one target and profile.
#[derive(Clone, Debug)]
pub struct Images {
    /// What they run on.
    pub target: &'static Target,
    /// How they are optimised.
    pub profile: Profile,
    directory: PathBuf,
}

impl Images {
    /// Builds the images, or finds them built: a second call in this process costs nothing, one in
    /// another process as much as cargo needs to see that nothing changed.
    ///
    /// `None` on a machine without the tools, which is said once on the standard error stream.
    ///
    /// # Errors
    /// The images do not build, or a tool is missing and `KESTIRIM_REQUIRE_TARGETS` is 1.
    pub fn of(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        static BUILT: Mutex<BTreeMap<(&str, Profile), Option<Images>>> =
            Mutex::new(BTreeMap::new());
        // Locked while building: whoever comes second waits for the images instead of building, too.
        let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(images) = built.get(&(target.triple, profile)) {
            return Ok(images.clone());
        }
        let images = Self::build(target, profile)?;
        built.insert((target.triple, profile), images.clone());
        Ok(images)
    }

    fn build(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        let Some(directory) = build(target, None, profile)? else { return Ok(None) };
        Ok(Some(Self { target, profile, directory }))
    }

    /// Runs an image, with a stream of samples (see [`super::encode`]) for it to read, until it ends.
    ///
    /// # Errors
    /// There is no such image, it tells a failure (a panic, a fault, a step that could not be
    /// measured), or it does not end.
    pub fn run(&self, image: &str, stream: &[u8]) -> Result<Output> {
        qemu::run(self.target, &self.directory.join(image), stream)
    }

    /// Opens the file of an image.
    ///
    /// # Errors
    /// There is no such image.
    pub fn elf(&self, image: &str) -> Result<Elf> {
        Elf::read(&self.directory.join(image))
    }
}

/// Builds all images, or an application, and answers with the directory they are in; `None` on a machine
/// without the tools, which is said.
pub(crate) fn build(
    target: &'static Target,
    package: Option<&str>,
    profile: Profile,
) -> Result<Option<PathBuf>> {
    if is_installed(target.qemu) {
        return with_toolchain(target, |toolchain| toolchain.build(package, profile.name()));
    }
    skip(target, &format!("{} is not installed: run .ci/install-target-tools", target.qemu))
}

/// Builds an application that is a workspace of its own, likewise; it needs no emulator.
pub(crate) fn build_apart(
    target: &'static Target,
    package: &str,
    profile: Profile,
) -> Result<Option<PathBuf>> {
    with_toolchain(target, |toolchain| toolchain.build_apart(package, profile.name()))
}

fn with_toolchain(
    target: &'static Target,
    build: impl Fn(&Toolchain) -> Result<PathBuf>,
) -> Result<Option<PathBuf>> {
    match Toolchain::find(target) {
        Ok(toolchain) => build(&toolchain).map(Some),
        Err(why) => skip(target, &why),
    }
}

fn skip(target: &'static Target, why: &str) -> Result<Option<PathBuf>> {
    if env::var(REQUIRE).is_ok_and(|value| value == "1") {
        bail!("{REQUIRE}=1, but {why}")
    }
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: tests on {}: {why}", target.triple)?;
    Ok(None)
}
