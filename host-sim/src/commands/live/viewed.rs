//! The view of a stream on a page: as it is now, as it was, or with other settings.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::Stopper;
use super::options::Following;
use super::rewound::Rewinder;
use super::state::State;
use crate::Error;
use crate::commands::serve::{Moment, Show};
use crate::system::{Answer, Settings};
use crate::text::printable_path;

/// The view of a stream.
pub(super) struct Viewed {
    pub(super) state: Arc<Mutex<State>>,
    pub(super) following: Following,
    pub(super) source: String,
    pub(super) recording: PathBuf,
    /// The number of frames after which decoding stops.
    pub(super) most: Option<u32>,
    /// Stopped when nothing more arrives.
    pub(super) stop: Stopper,
    /// The thread that decodes the recording again, once it is needed.
    pub(super) rewinder: OnceLock<Rewinder>,
}

impl Viewed {
    /// The present answer.
    pub(super) fn now(&self) -> Answer {
        self.with_names(self.state.lock().unwrap_or_else(PoisonError::into_inner).answer())
    }

    fn with_names(&self, mut answer: Answer) -> Answer {
        answer.fact("source", &*self.source);
        answer.fact("recording", printable_path(&self.recording));
        answer
    }
}

impl Show for Viewed {
    fn settings(&self) -> Settings {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        self.following.settings(!state.devices.is_empty())
    }

    fn bytes(&self) -> u64 {
        self.state.lock().unwrap_or_else(PoisonError::into_inner).counts.bytes
    }

    fn answer(&self, settings: &Settings, moment: Moment) -> Result<Answer, Error> {
        let bytes = match moment {
            Moment::Now if *settings == self.settings() => return Ok(self.now()),
            Moment::Now => self.bytes(),
            Moment::After(bytes) => bytes.min(self.bytes()),
        };
        let begin = || Rewinder::begin(self.recording.clone(), self.following.clone(), self.most);
        let is_end = self.stop.is_stopped() && bytes == self.bytes();
        let answer = self.rewinder.get_or_init(begin).answer(settings, bytes, is_end)?;
        Ok(self.with_names(answer))
    }
}
