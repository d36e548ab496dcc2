//! Downloads of single files by an external program that every machine has, so that this program needs no encryption of
//! its own.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use sha2::{Digest, Sha256};

use crate::text::bytes;
use crate::{Error, output};

/// The timeout in seconds for connecting to a server, and for a transfer without progress.
const PATIENCE_S: &str = "30";

/// Downloads a file, verifies its checksum and moves it to its path; on any error the existing file is kept.
pub(super) fn fetch(from: &str, packed: bool, path: &Path, sha256: &str) -> Result<(), Error> {
    let failed = |problem: String| Error::File { path: path.to_path_buf(), problem };
    let written = |source| Error::Write { path: path.to_path_buf(), source };
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(written)?;
    // The draft is in the same folder, so that it is on the target disk from the start.
    let draft = tempfile::NamedTempFile::new_in(folder).map_err(written)?;
    download(from, draft.path()).map_err(|problem| failed(format!("{from}: {problem}")))?;
    let contents = if packed { pack(draft.path()).map_err(failed)? } else { bytes(draft.path())? };
    let found = hexadecimal(&contents);
    if found != sha256 {
        return Err(failed(format!("{from}: expected SHA-256 {sha256}, found {found}")));
    }
    output::write_file(path, |file| file.write_all(&contents))
}

/// The SHA-256 of a file.
pub(super) fn sum(path: &Path) -> Result<String, Error> {
    Ok(hexadecimal(&bytes(path)?))
}

fn hexadecimal(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Downloads with curl, or with wget if there is no curl. Redirects are followed to web addresses only.
fn download(from: &str, to: &Path) -> Result<(), String> {
    let mut curl = Command::new("curl");
    curl.args(["--fail", "--silent", "--show-error", "--location", "--proto", "=http,https"]);
    curl.args(["--connect-timeout", PATIENCE_S, "--speed-limit", "1", "--speed-time", PATIENCE_S]);
    curl.arg("--output").arg(to).args(["--url", from]);
    let mut wget = Command::new("wget");
    wget.args(["--no-verbose", "--tries", "1", "--timeout", PATIENCE_S, "--output-document"]);
    wget.arg(to).args(["--", from]);
    for mut program in [curl, wget] {
        // A program that is not installed does not start.
        if let Ok(output) = program.output() {
            return said(&output).map(drop);
        }
    }
    Err("expected curl or wget, found neither".to_owned())
}

/// Compresses like `gzip -9n`: without time and name, so that the same contents give the same bytes.
fn pack(path: &Path) -> Result<Vec<u8>, String> {
    let output = Command::new("gzip").args(["-9", "-n", "-c"]).arg(path).output();
    let output = output.map_err(|error| format!("gzip does not start: {error}"))?;
    said(&output)?;
    Ok(output.stdout)
}

/// The last line of a program's error output if it failed.
fn said(output: &Output) -> Result<(), String> {
    if output.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&output.stderr);
    let last = text.lines().rev().find(|line| !line.trim().is_empty());
    Err(last.map_or_else(|| output.status.to_string(), |line| line.trim().to_owned()))
}
