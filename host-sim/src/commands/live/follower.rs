//! The thread that decodes what was recorded.

use std::fs::File;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use kestirim_telemetry::Receiver;

use super::Stopper;
use super::feed::Feed;
use super::order::Sorter;
use super::state::State;
use super::tape::{Piece, Reel};
use crate::Error;
use crate::system::Plan;

/// Bytes that are read at once: about a millisecond's work.
const BATCH: usize = 1 << 14;
/// What has arrived is on the disk itself after about this time at most.
const ON_DISK_WITHIN: Duration = Duration::from_secs(1);

/// Who follows.
#[derive(Debug)]
pub(super) struct Follower {
    pub(super) reel: Reel,
    /// The file that is being recorded.
    pub(super) disk: Option<File>,
    pub(super) plan: Option<Arc<dyn Plan>>,
    pub(super) state: Arc<Mutex<State>>,
    /// Frames that are enough.
    pub(super) most: Option<u32>,
    pub(super) stop: Stopper,
    /// Which recording it is.
    pub(super) path: PathBuf,
}

impl Follower {
    /// Follows the recording to its end.
    pub(super) fn run(mut self) -> Result<(), Error> {
        let followed = self.follow();
        // Nobody hears what goes on: whoever listens can stop.
        self.stop.stop();
        followed
    }

    fn follow(&mut self) -> Result<(), Error> {
        // An estimator stays with its thread.
        let mut decoder = Decoder {
            receiver: Receiver::new(),
            sorter: Sorter::default(),
            feed: Feed::new(self.plan.clone())?,
            state: Arc::clone(&self.state),
            most: self.most.unwrap_or(u32::MAX),
        };
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

/// Makes messages of bytes, and tells how many.
#[derive(Debug)]
struct Decoder {
    receiver: Receiver,
    sorter: Sorter,
    feed: Feed,
    state: Arc<Mutex<State>>,
    most: u32,
}

impl Decoder {
    /// Takes in what was read; whether more is wanted.
    fn take(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        let more = self.decode(bytes)?;
        // Nobody who looks on waits for what takes long.
        self.feed.settle();
        self.show(bytes.len());
        Ok(more)
    }

    /// Nothing more will come.
    fn finish(&mut self) -> Result<(), Error> {
        // A frame that only lacks its end is whole; any other piece of one is torn.
        self.decode(&[0])?;
        {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            self.sorter.finish(|message| self.feed.take(message, &mut state))?;
        }
        let finished = self.feed.finish();
        self.show(0);
        finished
    }

    /// Nothing comes for now.
    fn pause(&mut self) -> Result<(), Error> {
        {
            let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
            self.sorter.release_all(|message| self.feed.take(message, &mut state))?;
        }
        self.feed.settle();
        self.show(0);
        Ok(())
    }

    fn decode(&mut self, bytes: &[u8]) -> Result<bool, Error> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        // Those beyond are not even asked for.
        let wanted = self.most.saturating_sub(self.receiver.counts().received);
        for frame in self.receiver.frames(bytes).take(wanted as usize) {
            self.sorter.take(frame, |message| self.feed.take(message, &mut state))?;
        }
        Ok(self.receiver.counts().received < self.most)
    }

    fn show(&mut self, bytes: usize) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.count(bytes, self.receiver.counts(), self.sorter.left_out());
        self.feed.show(&mut state);
    }
}
