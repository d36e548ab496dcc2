//! The recording as a queue: written at one end and read at the other.
//!
//! So nothing is decoded that is not in the file, memory does not grow however far the estimator is behind, and the
//! receiver never waits.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::text::regular;

/// The interval at which a waiting reader returns if nothing arrives.
const PATIENCE: Duration = Duration::from_millis(500);

/// The length of a growing recording.
#[derive(Debug, Default)]
pub(super) struct Tape {
    extent: Mutex<Extent>,
    news: Condvar,
}

#[derive(Debug, Default)]
struct Extent {
    bytes: u64,
    /// Whether nothing more will be written.
    complete: bool,
}

impl Tape {
    /// Announces more bytes in the file.
    pub(super) fn grow(&self, bytes: usize) {
        self.extent().bytes += bytes as u64;
        self.news.notify_all();
    }

    /// Announces that nothing more will be written.
    pub(super) fn complete(&self) {
        self.extent().complete = true;
        self.news.notify_all();
    }

    fn extent(&self) -> MutexGuard<'_, Extent> {
        self.extent.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until the recording extends beyond `read`; returns its length, or a pause if nothing arrives.
    fn beyond(&self, read: u64) -> Piece<u64> {
        let waiting = |extent: &mut Extent| extent.bytes <= read && !extent.complete;
        let extent = self
            .news
            .wait_timeout_while(self.extent(), PATIENCE, waiting)
            .unwrap_or_else(PoisonError::into_inner)
            .0;
        match extent.bytes.saturating_sub(read) {
            0 if extent.complete => Piece::End,
            0 => Piece::Pause,
            more => Piece::Some(more),
        }
    }
}

/// The result of reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Piece<T> {
    /// Data is available.
    Some(T),
    /// Nothing has arrived for half a second.
    Pause,
    /// The recording has ended.
    End,
}

/// Reads a recording from its beginning, possibly while it is being written.
#[derive(Debug)]
pub(super) struct Reel {
    file: File,
    /// The queue; `None` if the recording is complete.
    tape: Option<Arc<Tape>>,
    read: u64,
}

impl Reel {
    /// Opens a recording that is being written.
    pub(super) fn growing(path: &Path, tape: Arc<Tape>) -> io::Result<Self> {
        Ok(Self { file: File::open(path)?, tape: Some(tape), read: 0 })
    }

    /// Opens a complete recording.
    pub(super) fn complete(path: &Path) -> io::Result<Self> {
        regular(path)?;
        Ok(Self { file: File::open(path)?, tape: None, read: 0 })
    }

    /// Reads the next bytes.
    pub(super) fn next<'a>(&mut self, buffer: &'a mut [u8]) -> io::Result<Piece<&'a [u8]>> {
        let available = match self.tape.as_ref().map(|tape| tape.beyond(self.read)) {
            Some(Piece::End) => return Ok(Piece::End),
            Some(Piece::Pause) => return Ok(Piece::Pause),
            Some(Piece::Some(available)) => available,
            None => u64::MAX,
        };
        let most = usize::try_from(available).map_or(buffer.len(), |all| all.min(buffer.len()));
        let piece = buffer.get_mut(..most).unwrap_or_default();
        let count = loop {
            match self.file.read(piece) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                other => break other?,
            }
        };
        self.read += count as u64;
        // A file that is truncated while it is read has ended as well.
        Ok(if count == 0 { Piece::End } else { Piece::Some(&piece[..count]) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn what_is_written_is_read_as_soon_as_it_is_told() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("a.frames");
        let mut file = File::create_new(&path)?;
        let tape = Arc::new(Tape::default());
        let mut reel = Reel::growing(&path, Arc::clone(&tape))?;
        let mut buffer = [0; 4];
        file.write_all(b"abcdef")?;
        tape.grow(5);
        assert_eq!(reel.next(&mut buffer)?, Piece::Some(&b"abcd"[..]));
        // The sixth byte is in the file but has not been announced.
        assert_eq!(reel.next(&mut buffer)?, Piece::Some(&b"e"[..]));
        assert_eq!(reel.next(&mut buffer)?, Piece::Pause);
        tape.grow(1);
        tape.complete();
        assert_eq!(reel.next(&mut buffer)?, Piece::Some(&b"f"[..]));
        assert_eq!(reel.next(&mut buffer)?, Piece::End);
        Ok(())
    }
}
