//! Runs images and applications under QEMU.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use wait_timeout::ChildExt;

use crate::output::Output;
use crate::target::{ICOUNT, Target};

/// The run time after which an image is considered to hang.
const PATIENCE: Duration = Duration::from_secs(120);

/// The names of the files that image and host share in the emulator's working directory.
pub(crate) const STREAM: &str = "stream.bin";
pub(crate) const OUTPUT: &str = "output.txt";
pub(crate) const ERRORS: &str = "errors.txt";

/// Runs an image in this directory until it ends, on the machine that `configure` selects; `None` if it hangs.
pub(crate) fn emulate(
    target: &Target,
    image: &Path,
    directory: &Path,
    configure: impl FnOnce(&mut Command),
) -> Result<Option<ExitStatus>> {
    let mut qemu = Command::new(target.qemu);
    configure(&mut qemu);
    let mut qemu = qemu
        .args(["-display", "none", "-monitor", "none"])
        .args(["-chardev", &format!("file,id=host,path={OUTPUT}")])
        .args(["-semihosting-config", "enable=on,target=native,chardev=host"])
        .arg("-kernel")
        .arg(image)
        .current_dir(directory)
        .stdin(Stdio::null())
        .stderr(File::create(directory.join(ERRORS))?)
        .spawn()
        .with_context(|| format!("cannot start {}", target.qemu))?;
    let status = qemu.wait_timeout(PATIENCE)?;
    if status.is_none() {
        qemu.kill()?;
        qemu.wait()?;
    }
    Ok(status)
}

/// Runs an image in a directory of its own until it ends.
pub(crate) fn run(target: &Target, image: &Path, stream: &[u8]) -> Result<Output> {
    let directory = tempfile::tempdir()?;
    let file = |name| directory.path().join(name);
    fs::write(file(STREAM), stream)?;
    let status = emulate(target, image, directory.path(), |qemu| {
        qemu.args(target.machine)
            .args(["-icount", ICOUNT, "-serial", "none"])
            .stdout(Stdio::null());
    })?;
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
