//! Runs an image.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use wait_timeout::ChildExt;

use crate::output::Output;
use crate::target::{ICOUNT, Target};

/// An image that runs longer hangs.
const PATIENCE: Duration = Duration::from_secs(120);

/// The names under which image and host meet in the emulator's working directory.
const STREAM: &str = "stream.bin";
const OUTPUT: &str = "output.txt";
const ERRORS: &str = "errors.txt";

/// Runs an image in a directory of its own until it ends.
pub(crate) fn run(target: &Target, image: &Path, stream: &[u8]) -> Result<Output> {
    let directory = tempfile::tempdir()?;
    let file = |name| directory.path().join(name);
    fs::write(file(STREAM), stream)?;
    let mut qemu = Command::new(target.qemu)
        .args(target.machine)
        .args(["-icount", ICOUNT])
        .args(["-display", "none", "-monitor", "none", "-serial", "none"])
        .args(["-chardev", &format!("file,id=host,path={OUTPUT}")])
        .args(["-semihosting-config", "enable=on,target=native,chardev=host"])
        .arg("-kernel")
        .arg(image)
        .current_dir(directory.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(File::create(file(ERRORS))?)
        .spawn()
        .with_context(|| format!("cannot start {}", target.qemu))?;
    let status = qemu.wait_timeout(PATIENCE)?;
    if status.is_none() {
        qemu.kill()?;
        qemu.wait()?;
    }
    let told = fs::read_to_string(file(OUTPUT)).unwrap_or_default();
    if status.is_some_and(|status| status.success()) {
        return Output::parse(&told);
    }
    let why = status.map_or("was still running".into(), |status| format!("ended with {status}"));
    bail!(
        "{} on {} {why}; it told:\n{told}{}",
        image.display(),
        target.triple,
        fs::read_to_string(file(ERRORS)).unwrap_or_default()
    );
}
