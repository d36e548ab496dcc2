//! The files that one call of a sweep makes, one after the other.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::table::ENDINGS;
use crate::{Error, Shard, Work};

/// The number of shards of a plan that does not set it.
const SHARDS: u64 = 100;

/// The files of the shards that are to be made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Job {
    files: Vec<(Range<u64>, PathBuf)>,
}

impl Job {
    /// The given shard, or all shards if none is given. A path with an extension is the file, which holds all rows if
    /// no shard is given; a path without one is a folder, which is created.
    ///
    /// # Errors
    /// [`Error::Write`] if the folder cannot be made.
    pub fn new(work: &Work, shard: Option<Shard>, out: &Path) -> Result<Self, Error> {
        let is_file = out.extension().is_some();
        let count = shards(work);
        let all = match shard {
            Some(shard) => vec![shard],
            None if is_file => Shard::new(0, 1).into_iter().collect(),
            None => (0..count).filter_map(|index| Shard::new(index, count)).collect(),
        };
        if !is_file {
            fs::create_dir_all(out).map_err(Error::write(out))?;
        }
        let path = |Shard { index, count }: Shard| {
            let name = format!("shard-{index:05}-of-{count:05}.{}", ENDINGS[0]);
            if is_file { out.to_owned() } else { out.join(name) }
        };
        let files = all.into_iter().map(|shard| (shard.range(work.rows()), path(shard)));
        Ok(Self { files: files.collect() })
    }

    /// The number of rows in all the files.
    pub fn rows(&self) -> u64 {
        self.files.iter().map(|(range, _)| range.end - range.start).sum()
    }

    /// Makes the files that do not exist yet, and calls `done` with the number of rows each time rows are done.
    ///
    /// # Errors
    /// Those of [`Work::is_done`] and [`Work::write`]. Files made before the error remain.
    pub fn run(&self, work: &Work, done: &(dyn Fn(u64) + Sync)) -> Result<(), Error> {
        for (range, path) in &self.files {
            if work.is_done(range, path)? {
                done(range.end - range.start);
            } else {
                work.write(range.clone(), path, &|| done(1))?;
            }
        }
        Ok(())
    }

    /// The number of shards and their approximate computing time, in words.
    ///
    /// # Errors
    /// Those of [`Work::estimate`].
    pub fn costs(work: &Work) -> Result<String, Error> {
        let (all, count) = (work.estimate()?, shards(work));
        let each = Duration::from_secs_f64(all.as_secs_f64() / count as f64);
        let (rows, each, all) = (work.rows(), words(each), words(all));
        Ok(format!(
            "{count} shards of {rows} rows in all; on one core of this machine about {each} a shard, {all} in all, by a few rows \
             of some kinds"
        ))
    }
}

fn shards(work: &Work) -> u64 {
    work.plan().shards.unwrap_or(SHARDS).min(work.rows()).max(1)
}

fn words(duration: Duration) -> String {
    match duration.as_secs_f64() {
        s if s < 60.0 => format!("{s:.2} s"),
        s if s < 3600.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
