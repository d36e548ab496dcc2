//! The images of one target and profile, built once.

use std::collections::BTreeMap;
use std::env;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use anyhow::{Error, Result, bail};

use crate::elf::Elf;
use crate::output::Output;
use crate::qemu;
use crate::target::Target;
use crate::toolchain::{Toolchain, is_installed};

/// Set to 1, a missing tool is a failure instead of a reason to skip: CI cannot skip unseen.
const REQUIRE: &str = "KESTIRIM_REQUIRE_TARGETS";

/// The packages of images with our workloads and with the peers', built in one go.
const DEFAULT: [&str; 2] = ["images", "peers"];

/// What the compiler optimises for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Profile {
    /// Few instructions: opt-level 3.
    Speed,
    /// Small code: opt-level "s".
    Size,
}

impl Profile {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Speed, Self::Size];

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
    /// What compiled them: counts of different compilers do not compare.
    pub compiler: String,
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
        Self::of_packages(&DEFAULT, target, profile)
    }

    /// The same for one package of the workspace of images.
    ///
    /// # Errors
    /// As [`Images::of`].
    pub fn of_package(
        package: &'static str,
        target: &'static Target,
        profile: Profile,
    ) -> Result<Option<Self>> {
        Self::of_packages(&[package], target, profile)
    }

    /// The same as [`Images::of`] for who cannot do without.
    ///
    /// # Errors
    /// The images do not build, or a tool is missing.
    pub fn needed(target: &'static Target, profile: Profile) -> Result<Self> {
        Self::build(&toolchain(target).map_err(Error::msg)?, &DEFAULT, profile)
    }

    fn of_packages(
        packages: &[&'static str],
        target: &'static Target,
        profile: Profile,
    ) -> Result<Option<Self>> {
        type Key = (Vec<&'static str>, &'static str, Profile);
        static BUILT: Mutex<BTreeMap<Key, Option<Images>>> = Mutex::new(BTreeMap::new());
        // Locked while building: whoever comes second waits for the images instead of building, too.
        let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (packages.to_vec(), target.triple, profile);
        if let Some(images) = built.get(&key) {
            return Ok(images.clone());
        }
        let images = match toolchain(target) {
            Ok(toolchain) => Some(Self::build(&toolchain, packages, profile)?),
            Err(why) => skip(target, &why)?,
        };
        built.insert(key, images.clone());
        Ok(images)
    }

    fn build(toolchain: &Toolchain, packages: &[&str], profile: Profile) -> Result<Self> {
        Ok(Self {
            target: toolchain.target,
            profile,
            compiler: toolchain.version()?,
            directory: toolchain.build(packages, profile.name())?,
        })
    }

    /// Runs an image, with a stream of samples (see [`crate::streams::Encode`]) for it to read, until it ends.
    ///
    /// # Errors
    /// There is no such image, it tells a failure (a panic, a fault, a step that could not be
    /// measured), or it does not end.
    pub fn run(&self, image: &str, stream: &[u8]) -> Result<Output> {
        qemu::run(self.target, &self.file(image), stream)
    }

    /// Opens the file of an image.
    ///
    /// # Errors
    /// There is no such image.
    pub fn elf(&self, image: &str) -> Result<Elf> {
        Elf::read(&self.file(image))
    }

    pub(crate) fn file(&self, image: &str) -> PathBuf {
        self.directory.join(image)
    }
}

/// A toolchain for the target, or what is missing.
fn toolchain(target: &'static Target) -> Result<Toolchain, String> {
    if is_installed(target.qemu) {
        Toolchain::find(target)
    } else {
        Err(format!("{} is not installed: run .ci/install-target-tools", target.qemu))
    }
}

/// Builds an application that is a workspace of its own, for which nobody needs an emulator, and answers with
/// the directory it is in; `None` on a machine without the tools, which is said.
pub(crate) fn build_apart(
    target: &'static Target,
    package: &str,
    profile: Profile,
) -> Result<Option<PathBuf>> {
    match Toolchain::find(target) {
        Ok(toolchain) => toolchain.build_apart(package, profile.name()).map(Some),
        Err(why) => skip(target, &why),
    }
}

/// Says that there are no tools; an error where there must be.
fn skip<T>(target: &Target, why: &str) -> Result<Option<T>> {
    if env::var(REQUIRE).is_ok_and(|value| value == "1") {
        bail!("{REQUIRE}=1, but {why}");
    }
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: tests on {}: {why}", target.triple)?;
    Ok(None)
}
