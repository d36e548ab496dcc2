//! The stream as it was at another moment, or with other settings: decoded again from the recording.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex};
use std::thread;

use super::decoder::Decoder;
use super::follower::BATCH;
use super::options::Following;
use super::state::State;
use crate::Error;
use crate::system::{Answer, Settings};

/// The channel for the answer to a question.
type Reply = Sender<Result<Answer, Error>>;

/// A question: the settings, the number of bytes, whether the stream ends there, and the channel for the answer.
type Question = (Settings, u64, bool, Reply);

/// A thread that decodes a recording again: an estimator is used only in the thread that created it.
pub(super) struct Rewinder(Sender<Question>);

impl Rewinder {
    /// Starts the thread, which ends when this is dropped. Decoding stops after `most` frames.
    pub(super) fn begin(path: PathBuf, following: Following, most: Option<u32>) -> Self {
        let (questions, asked) = channel::<Question>();
        let work = move || {
            // The next moment may be shortly after the last one that was shown.
            let mut last: Option<Rewound> = None;
            for (settings, bytes, is_end, reply) in asked {
                let near = last.take().filter(|it| it.leads_to(bytes, &settings));
                let near = near.map_or_else(|| Rewound::new(&path, &following, settings, most), Ok);
                let answer = near.and_then(|mut near| {
                    let answer = near.answer(bytes, is_end, &path);
                    // A decoder that failed or was ended cannot continue.
                    last = (answer.is_ok() && !is_end).then_some(near);
                    answer
                });
                // The receiver of the answer may have been dropped.
                let _ = reply.send(answer);
            }
        };
        // If the thread cannot be spawned, asking a question reports that.
        drop(thread::Builder::new().stack_size(crate::STACK_BYTES).spawn(work));
        Self(questions)
    }

    /// The answer for these settings after a number of bytes of the recording, which may be its end.
    ///
    /// # Errors
    /// Errors in the settings or the recording.
    pub(super) fn answer(
        &self,
        settings: &Settings,
        bytes: u64,
        is_end: bool,
    ) -> Result<Answer, Error> {
        let (reply, answer) = channel();
        let gone = || Error::Usage("no thread looks back".to_owned());
        self.0.send((settings.clone(), bytes, is_end, reply)).map_err(|_| gone())?;
        answer.recv().map_err(|_| gone())?
    }
}

/// A decoder with its position in the recording.
#[derive(Debug)]
struct Rewound {
    settings: Settings,
    decoder: Decoder,
    file: File,
    /// The number of bytes decoded.
    read: u64,
}

impl Rewound {
    /// A decoder at the beginning of the recording.
    fn new(
        path: &Path,
        following: &Following,
        settings: Settings,
        most: Option<u32>,
    ) -> Result<Self, Error> {
        let following = following.with(&settings)?;
        let state = Arc::new(Mutex::new(State::new(&following)));
        let file = File::open(path);
        Ok(Self {
            settings,
            decoder: Decoder::new(&following, state, most)?,
            file: file.map_err(|source| Error::Read { path: path.to_path_buf(), source })?,
            read: 0,
        })
    }

    /// Whether the decoder can continue to this number of bytes with these settings.
    fn leads_to(&self, bytes: u64, settings: &Settings) -> bool {
        self.read <= bytes && self.settings == *settings
    }

    /// The answer after a number of bytes.
    ///
    /// # Errors
    /// [`Error::Read`] if the recording, `path`, cannot be read; otherwise those of [`Decoder::take`].
    fn answer(&mut self, bytes: u64, is_end: bool, path: &Path) -> Result<Answer, Error> {
        let mut buffer = [0; BATCH];
        while self.read < bytes {
            let most = usize::try_from(bytes - self.read).map_or(BATCH, |left| left.min(BATCH));
            let piece = buffer.get_mut(..most).unwrap_or_default();
            let count = self
                .file
                .read(piece)
                .map_err(|source| Error::Read { path: path.to_path_buf(), source })?;
            if count == 0 {
                break;
            }
            self.read += count as u64;
            if !self.decoder.take(piece.get(..count).unwrap_or_default())? {
                break;
            }
        }
        if is_end {
            self.decoder.finish()?;
        } else {
            // The pause gives the estimator time for lengthy work, whose result is shown as well.
            self.decoder.pause()?;
        }
        Ok(self.decoder.answer())
    }
}
