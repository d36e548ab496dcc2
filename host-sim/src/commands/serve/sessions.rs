//! Recordings that are open.

use std::collections::VecDeque;
use std::fmt;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::system::Opened;

/// As many as a person compares; a day of satellites is large.
const MOST: usize = 8;

/// The last few recordings that were opened.
#[derive(Default)]
pub(super) struct Sessions(Mutex<Open>);

#[derive(Default)]
struct Open {
    next: u64,
    recordings: VecDeque<(u64, Recording)>,
}

/// A recording that is open.
#[derive(Clone)]
pub(super) struct Recording {
    pub(super) opened: Arc<dyn Opened>,
    /// Where its files lay while they were read: no business of the page's.
    pub(super) folder: Option<PathBuf>,
}

impl Sessions {
    /// Keeps a recording, closes the oldest if there are too many, and says by which number to ask for it.
    pub(super) fn add(&self, recording: Recording) -> u64 {
        let mut open = self.lock();
        let number = open.next;
        open.next += 1;
        open.recordings.push_back((number, recording));
        if open.recordings.len() > MOST {
            open.recordings.pop_front();
        }
        number
    }

    /// The recording of that number, if it is still open.
    pub(super) fn get(&self, number: u64) -> Option<Recording> {
        let open = self.lock();
        let found = open.recordings.iter().find(|(known, _)| *known == number);
        found.map(|(_, recording)| recording.clone())
    }

    fn lock(&self) -> MutexGuard<'_, Open> {
        // Nothing is left half done in there.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Sessions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Sessions").field("open", &self.lock().recordings.len()).finish()
    }
}
