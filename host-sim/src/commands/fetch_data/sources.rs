//! The list of recordings: the origin of each file, its checksum, and the obligations of its users.

use std::path::Path;

use serde::Deserialize;

use crate::Error;
use crate::text::bytes;

/// The built-in list.
const OWN: &str = include_str!("../../../data/sources.csv");

/// A line of the list.
#[derive(Debug, Deserialize)]
struct Line {
    path: String,
    sha256: String,
    how: String,
    source: String,
    note: String,
    licence: String,
}

/// A file, or a folder of files that are not redistributed.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Source {
    /// The path below the folder of recordings.
    pub(super) path: String,
    /// The SHA-256 of the file in lower-case hexadecimal digits; empty if the file is not redistributed.
    pub(super) sha256: String,
    pub(super) origin: Origin,
    /// The licence and the citation.
    pub(super) licence: String,
}

/// How a file is obtained.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// The file as published, or that compressed by `gzip -9n`.
    Published { address: String, packed: bool },
    /// The file is made from a published one.
    Converted { from: String, how: String },
    /// The file may not be redistributed.
    Kept { reason: String },
}

impl Source {
    /// Whether the source is this file or lies in this folder, which may be named by its last component only.
    pub(super) fn is_in(&self, name: &str) -> bool {
        let name = name.trim_end_matches('/');
        let folder = self.folder();
        let last = folder.rsplit('/').next();
        self.path == name || self.path.starts_with(&format!("{name}/")) || last == Some(name)
    }

    /// The folder that the source lies in, or is.
    pub(super) fn folder(&self) -> &str {
        match (&self.origin, self.path.rsplit_once('/')) {
            (Origin::Published { .. } | Origin::Converted { .. }, Some((folder, _))) => folder,
            _ => &self.path,
        }
    }
}

/// Parses the built-in list.
pub(super) fn own() -> Result<Vec<Source>, Error> {
    parse(OWN.as_bytes(), Path::new("sources.csv"))
}

/// Reads a list from a file.
pub(super) fn read(path: &Path) -> Result<Vec<Source>, Error> {
    parse(&bytes(path)?, path)
}

fn parse(text: &[u8], path: &Path) -> Result<Vec<Source>, Error> {
    let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(text);
    let problem = |line: Option<u64>, problem: String| {
        let line = line.and_then(|line| usize::try_from(line).ok()).unwrap_or(1);
        Error::Line { path: path.to_path_buf(), line, problem }
    };
    let mut sources = Vec::new();
    let mut records = table.deserialize::<Line>();
    while let Some(line) = records.next() {
        let number = Some(records.reader().position().line());
        let line = line.map_err(|error| problem(number, error.to_string()))?;
        sources.push(source(line).map_err(|expected| problem(number, expected))?);
    }
    Ok(sources)
}

/// Parses a line of the list; the error says what was expected in it.
fn source(line: Line) -> Result<Source, String> {
    let Line { path, sha256, how, source: from, note, licence } = line;
    let leaves = path.is_empty() || path.split('/').any(|part| ["", ".", ".."].contains(&part));
    if leaves || path.contains('\\') {
        return Err(format!("expected a path below the folder, found {path:?}"));
    }
    let is_address = from.starts_with("https://") || from.starts_with("http://");
    let origin = match how.as_str() {
        "as published" | "gzip" if is_address => {
            Origin::Published { address: from, packed: how == "gzip" }
        }
        "as published" | "gzip" => return Err(format!("expected an address, found {from:?}")),
        "converted" => Origin::Converted { from, how: note },
        "not passed on" => Origin::Kept { reason: format!("not passed on: {note} ({from})") },
        _ => {
            return Err(format!(
                "expected as published, gzip, converted or not passed on, found {how:?}"
            ));
        }
    };
    let is_digit = |digit: u8| digit.is_ascii_digit() || (b'a'..=b'f').contains(&digit);
    let is_sum = sha256.len() == 64 && sha256.bytes().all(is_digit);
    if !is_sum && !matches!(origin, Origin::Kept { .. }) {
        return Err(format!("expected 64 hexadecimal digits, found {sha256:?}"));
    }
    Ok(Source { path, sha256, origin, licence })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_own_list_is_whole() -> Result<(), Error> {
        let sources = own()?;
        let mut paths: Vec<_> = sources.iter().map(|source| &source.path).collect();
        paths.sort_unstable();
        paths.dedup();
        assert_eq!(paths.len(), sources.len());
        assert!(sources.iter().all(|source| !source.licence.is_empty()));
        let is = |of: fn(&Origin) -> bool| sources.iter().any(|source| of(&source.origin));
        assert!(is(|it| matches!(it, Origin::Published { packed: true, .. })));
        assert!(is(|it| matches!(it, Origin::Converted { .. })));
        assert!(is(|it| matches!(it, Origin::Kept { .. })));
        Ok(())
    }

    #[test]
    fn a_list_that_leaves_the_folder_is_refused() {
        let header = "path,bytes,sha256,how,source,note,licence\n";
        let sum = "0".repeat(64);
        for (line, expected) in [
            (format!("../a,1,{sum},as published,https://a.b,,MIT\n"), "below the folder"),
            (format!("/a,1,{sum},as published,https://a.b,,MIT\n"), "below the folder"),
            (format!("a,1,{sum},as published,file:///a,,MIT\n"), "an address"),
            ("a,1,12,as published,https://a.b,,MIT\n".to_owned(), "64 hexadecimal"),
            (format!("a,1,{sum},stolen,https://a.b,,MIT\n"), "not passed on"),
        ] {
            let text = format!("{header}{line}");
            let error = parse(text.as_bytes(), Path::new("list.csv")).expect_err("a bad line");
            assert!(error.to_string().contains(expected), "{error}");
        }
    }
}
