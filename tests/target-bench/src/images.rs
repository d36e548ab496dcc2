//! The images of one target and profile, built once.

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

/// Set to 1, a missing tool is a failure instead of a reason to skip: CI cannot skip unseen.
const REQUIRE: &str = "KESTIRIM_REQUIRE_TARGETS";

/// The target and profile of the short form, those with which estimators are measured. A target without a floating-point unit is covered by
/// the applications for the M0.
const SHORT_FORM: (&Target, Profile) = (&CORTEX_M4F, Profile::Speed);

/// The packages of images with our workloads and with the peers', built in one go.
const WORKLOADS: Packages = &["images", "peers"];

/// The same without the peers, which change with no change of ours, and bring crates that nothing else stands on.
const OURS: Packages = &["images"];

/// The package of the programs that call everything; apart, because it takes long and one test needs it.
const SURFACE: Packages = &["surface"];

/// The package of the image in which estimators wake; apart, because its crates have another feature.
const SNAPSHOTS: Packages = &["snapshots"];

/// Packages that one call of cargo builds together.
pub(crate) type Packages = &'static [&'static str];

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
    packages: Packages,
    directory: PathBuf,
}

impl Images {
    /// Builds the images, or finds them built: a second call in this process costs nothing, one in
    /// another process as much as cargo needs to see that nothing changed.
    ///
    /// `None` on a machine without the tools, and for what the short form leaves out (`KESTIRIM_SHORT=1`);
    /// both are said once on the standard error stream.
    ///
    /// # Errors
    /// The images do not build, or a tool is missing and `KESTIRIM_REQUIRE_TARGETS` is 1.
    pub fn of(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        let packages = if is_short() { OURS } else { WORKLOADS };
        Self::of_form(packages, target, profile)
    }

    /// The same with the peers' images: nothing in the short form.
    ///
    /// # Errors
    /// As [`Images::of`].
    pub fn of_peers(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        if is_short() {
            return left_out("the peers' images");
        }
        Self::of(target, profile)
    }

    /// The same for the programs that call everything the crates offer: to be looked at, not to be run.
    ///
    /// # Errors
    /// As [`Images::of`].
    pub fn of_surface(target: &'static Target, profile: Profile) -> Result<Option<Self>> {
        Self::of_form(SURFACE, target, profile)
    }

    /// The same for the image in which estimators wake that slept on the host.
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

    /// The same as [`Images::of`] for who cannot do without.
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
        // Whoever comes second waits for these images, and for no others.
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

/// Says that the short form leaves something out.
pub(crate) fn left_out<T>(what: &str) -> Result<Option<T>> {
    // Not `eprintln!`, which the test runner swallows when the test passes.
    writeln!(io::stderr(), "SKIPPED: {what}: {SHORT}=1")?;
    Ok(None)
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
