//! `host-sim fetch-data`: downloads the recordings that may be redistributed, from their publishers.

mod download;
mod sources;

use std::path::PathBuf;

use self::download::fetch;
use self::sources::{Origin, Source};
use crate::text::printable_path;
use crate::{Error, output};

/// Options of `host-sim fetch-data`.
#[derive(Debug, clap::Args)]
pub(super) struct FetchData {
    /// Where the recordings are laid out
    #[arg(long, value_name = "FOLDER", default_value = "data")]
    to: PathBuf,
    /// Only what lies in this folder of the recordings, or this file of them; may be given again
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// From a copy of the recordings that is laid out in the same way, instead of their publishers
    #[arg(long, value_name = "BASE-URL")]
    from: Option<String>,
    /// Another list of files than the program's own, with the same columns
    #[arg(long, value_name = "LIST.csv")]
    sources: Option<PathBuf>,
}

/// The outcome for a file.
enum Fate {
    Fetched,
    /// The file was already present and correct.
    There,
    /// The file is not requested, for this reason.
    NotAsked(String),
}

impl FetchData {
    pub(super) fn run(&self) -> Result<(), Error> {
        let all = match &self.sources {
            Some(path) => sources::read(path)?,
            None => sources::own()?,
        };
        let chosen: Vec<_> = all.iter().filter(|source| self.wants(source)).collect();
        if let Some(unknown) = self.only.iter().find(|name| !all.iter().any(|it| it.is_in(name))) {
            let parts = all.iter().filter_map(|source| source.path.split('/').next());
            let mut parts: Vec<_> = parts.collect();
            parts.dedup();
            let known = parts.join(", ");
            let problem = format!("expected one of {known}, or a folder or file in them");
            return Err(Error::Usage(format!("--only {unknown}: {problem}")));
        }
        let (mut counts, mut failed) = ([0_usize; 3], 0);
        let mut reasons: Vec<String> = Vec::new();
        for source in &chosen {
            match self.file(source) {
                Ok(Fate::Fetched) => counts[0] += 1,
                Ok(Fate::There) => counts[1] += 1,
                Ok(Fate::NotAsked(reason)) => {
                    counts[2] += 1;
                    if !reasons.contains(&reason) {
                        reasons.push(reason);
                    }
                }
                Err(error) => {
                    failed += 1;
                    output::warn(&error.to_string());
                }
            }
        }
        let [fetched, there, left] = counts;
        let sum = format!("{fetched} fetched, {there} there already, {left} left");
        let told: Vec<_> = std::iter::once(sum).chain(reasons).collect();
        output::print(&told.join("\n  "))?;
        let problem = match failed {
            0 if fetched + there > 0 => return Ok(()),
            0 => "nothing of what was asked for can be fetched".to_owned(),
            _ => format!("{failed} of {} files could not be fetched", chosen.len() - left),
        };
        Err(Error::File { path: self.to.clone(), problem })
    }

    fn wants(&self, source: &Source) -> bool {
        self.only.is_empty() || self.only.iter().any(|name| source.is_in(name))
    }

    fn file(&self, source: &Source) -> Result<Fate, Error> {
        let (from, packed) = match (&source.origin, &self.from) {
            (Origin::Kept { reason }, _) => {
                return Ok(Fate::NotAsked(format!("{}: {reason}", source.path)));
            }
            (_, Some(base)) => (format!("{}/{}", base.trim_end_matches('/'), source.path), false),
            (Origin::Converted { from, how }, None) => {
                let folder = source.folder();
                let reason = format!("{folder}: converted from {from}: {how}; fetched with --from");
                return Ok(Fate::NotAsked(reason));
            }
            (Origin::Published { address, packed }, None) => (address.clone(), *packed),
        };
        let path = self.to.join(&source.path);
        if path.is_file() && download::sum(&path)? == source.sha256 {
            return Ok(Fate::There);
        }
        fetch(&from, packed, &path, &source.sha256)?;
        output::warn(&format!("{}: {}", printable_path(&path), source.licence));
        Ok(Fate::Fetched)
    }
}
