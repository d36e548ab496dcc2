//! The images of one target and profile, which are built once.

use std::collections::BTreeMap;
use std::env;
use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use anyhow::{Error, Result, bail};

use crate::elf::Elf;
use crate::form::{SHORT, is_short};
use crate::output::Output;
use crate::qemu;
use crate::target::{CORTEX_M4F, Target};
use crate::toolchain::{Apart, Toolchain, is_installed};

/// The environment variable that, if it is 1, makes a missing tool a failure instead of a reason to skip: CI must not
/// skip unnoticed.
const REQUIRE: &str = "KESTIRIM_REQUIRE_TARGETS";

/// The target and profile of the short form, with which estimators are measured. Targets without a floating-point unit
/// are covered by the applications for the M0.
const SHORT_FORM: (&Target, Profile) = (&CORTEX_M4F, Profile::Speed);

/// The packages of images with our workloads and with the peers', which are built together.
const WORKLOADS: Packages = &["images", "peers"];

/// The packages without the peers, which do not depend on our changes, and need crates that nothing else uses.
const OURS: Packages = &["images"];

/// The package of the programs that call everything; separate, because it is slow to build and only one test needs it.
const SURFACE: Packages = &["surface"];

/// The package of the image that restores estimators from snapshots; separate, because its crates have another feature.
const SNAPSHOTS: Packages = &["snapshots"];

/// Packages that are built together by one call of cargo.
pub(crate) type Packages = &'static [&'static str];

/// The goal of the compiler's optimisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Profile {
    /// Few instructions: opt-level 3.
    Speed,
    /// Small code: opt-level "s".
    Size,
}

impl Profile {
    /// Both profiles.
    pub const ALL: [Self; 2] = [Self::Speed, Self::Size];

    /// The optimisation level under its name in tables.
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
    /// The target on which they run.
    pub target: &'static Target,
    /// The optimisation with which they were built.
    pub profile: Profile,
    /// The compiler: counts from different compilers are not comparable.
    pub compiler: String,
    packages: Packages,
    directory: PathBuf,
}

impl Images {
    /// Builds the images, or finds them built: a second call in this process costs nothing; one in another process
    /// takes as long as cargo needs to see that nothing changed.
    ///
    /// `None` on a machine without the tools, and for what the short form leaves out (`KESTIRIM_SHORT=1`); both are
    /// reported once on the standard error stream.
    ///
    /// # Errors
    /// The images do not build, or a tool is missing and `KESTIRIM_REQUIRE_TARGETS` is 1.
    pub fn of(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        let packages = if is_short() { OURS } else { WORKLOADS };
        Self::of_form(packages, target, profile)
    }

    /// Builds the images including the peers', as [`Images::of`] does; `None` in the short form.
    ///
    /// # Errors
    /// As [`Images::of`].
    pub fn of_peers(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        if is_short() {
            return left_out("the peers' images");
        }
        Self::of(target, profile)
    }

    /// Builds the programs that call everything the crates offer; they are inspected, not run.
    ///
    /// # Errors
    /// As [`Images::of`].
    pub fn of_surface(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        Self::of_form(SURFACE, target, profile)
    }

    /// Builds the image that restores estimators from snapshots taken on the host.
    ///
    /// # Errors
    /// As [`Images::of`].
    pub fn of_snapshots(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        Self::of_form(SNAPSHOTS, target, profile)
    }

    fn of_form(
        packages: Packages,
        target: &'static Target,
        profile: Profile,
    ) -> Result<Option<Self>> {
        let (of, at) = SHORT_FORM;
        let is_left_out = packages == SNAPSHOTS || target.triple != of.triple || profile != at;
        if is_short() && is_left_out {
            let (triple, opt) = (target.triple, profile.opt());
            return left_out(&format!("{} for {triple} at {opt}", packages.join(", ")));
        }
        Self::of_packages(packages, target, profile)
    }

    /// Builds the images for a caller that cannot do without them: nothing is skipped, unlike with [`Images::of`].
    ///
    /// # Errors
    /// The images do not build, or a tool is missing.
    pub fn needed(target: &'static Target, profile: Profile) -> Result<Self> {
        Self::build(&toolchain(target).map_err(Error::msg)?, WORKLOADS, profile)
    }

    pub(crate) fn of_packages(
        packages: Packages,
        target: &'static Target,
        profile: Profile,
    ) -> Result<Option<Self>> {
        type Key = (Packages, &'static str, Profile);
        type Built = OnceLock<Result<Option<Images>, String>>;
        static BUILT: Mutex<BTreeMap<Key, Arc<Built>>> = Mutex::new(BTreeMap::new());
        // A second caller waits for these images only, not for others.
        let key = (packages, target.triple, profile);
        let built =
            BUILT.lock().unwrap_or_else(PoisonError::into_inner).entry(key).or_default().clone();
        let build = || match toolchain(target) {
            Ok(toolchain) => Self::build(&toolchain, packages, profile).map(Some),
            Err(why) => skip(target, &why),
        };
        let images = built.get_or_init(|| build().map_err(|error| format!("{error:?}")));
        images.clone().map_err(Error::msg)
    }

    fn build(toolchain: &Toolchain, packages: Packages, profile: Profile) -> Result<Self> {
        Ok(Self {
            target: toolchain.target,
            profile,
            compiler: toolchain.version()?,
            packages,
            directory: toolchain.build(packages, profile.name())?,
        })
    }

    pub(crate) fn has_peers(&self) -> bool {
        self.packages == WORKLOADS
    }

    /// Runs an image until it ends, with a stream of samples (see [`crate::streams::Encode`]) for it to read.
    ///
    /// # Errors
    /// There is no such image, it reports a failure (a panic, a fault, a step that could not be measured), or it does
    /// not end.
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

/// A toolchain for the target, or a sentence on what is missing.
fn toolchain(target: &'static Target) -> Result<Toolchain, String> {
    if is_installed(target.qemu) {
        Toolchain::find(target)
    } else {
        Err(format!("{} is not installed: run .ci/install-target-tools", target.qemu))
    }
}

/// Builds an application with its own workspace, for which no emulator is needed, and returns its directory; prints a
/// notice and returns `None` on a machine without the tools.
pub(crate) fn build_apart(
    target: &'static Target,
    package: Apart,
    profile: Profile,
) -> Result<Option<PathBuf>> {
    if is_short() {
        return left_out(package.name);
    }
    match Toolchain::find(target) {
        Ok(toolchain) => toolchain.build_apart(package, profile.name()).map(Some),
        Err(why) => skip(target, &why),
    }
}

/// Reports that the short form leaves something out.
pub(crate) fn left_out<T>(what: &str) -> Result<Option<T>> {
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: {what}: {SHORT}=1")?;
    Ok(None)
}

/// Reports that the tools are missing; an error where they are required.
fn skip<T>(target: &Target, why: &str) -> Result<Option<T>> {
    if env::var(REQUIRE).is_ok_and(|value| value == "1") {
        bail!("{REQUIRE}=1, but {why}");
    }
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: tests on {}: {why}", target.triple)?;
    Ok(None)
}
