//! The thread that decodes the recording.

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::Stopper;
use super::decoder::Decoder;
use super::options::Following;
use super::state::State;
use super::tape::{Piece, Reel};
use crate::Error;

/// The number of bytes read at once: about a millisecond's work.
pub(super) const BATCH: usize = 1 << 14;
/// The approximate limit on the time until received bytes are on the disk itself.
const ON_DISK_WITHIN: Duration = Duration::from_secs(1);

/// The follower of a recording.
#[derive(Debug)]
pub(super) struct Follower {
    pub(super) reel: Reel,
    /// The file that is being recorded, to be synced to the disk.
    pub(super) disk: Option<File>,
    pub(super) following: Following,
    pub(super) state: Arc<Mutex<State>>,
    /// The number of frames after which to stop.
    pub(super) most: Option<u32>,
    pub(super) stop: Stopper,
    /// The path of the recording.
    pub(super) path: PathBuf,
}

impl Follower {
    /// Follows the recording to its end.
    pub(super) fn run(mut self) -> Result<(), Error> {
        let followed = self.follow();
        // Nothing more is processed: the listener can stop.
        self.stop.stop();
        followed
    }

    fn follow(&mut self) -> Result<(), Error> {
        // The estimator is created in the thread that uses it.
        let mut decoder = Decoder::new(&self.following, Arc::clone(&self.state), self.most)?;
        let mut buffer = vec![0; BATCH];
        let mut synced = Instant::now();
        let mut is_dirty = false;
        loop {
            let read = self.reel.next(&mut buffer);
            let piece = read.map_err(|source| self.failed(source))?;
            let more = match piece {
                Piece::Some(bytes) => decoder.take(bytes)?,
                Piece::Pause => decoder.pause().map(|()| true)?,
                Piece::End => false,
            };
            is_dirty |= piece != Piece::Pause;
            if is_dirty && (!more || synced.elapsed() >= ON_DISK_WITHIN) {
                self.disk.as_ref().map_or(Ok(()), File::sync_data).map_err(|e| self.failed(e))?;
                (synced, is_dirty) = (Instant::now(), false);
            }
            if !more {
                return decoder.finish();
            }
        }
    }

    fn failed(&self, source: io::Error) -> Error {
        Error::Read { path: self.path.clone(), source }
    }
}
