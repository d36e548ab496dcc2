//! The stream as it was at another moment, or as other settings see it: decoded anew from the recording.

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

/// Where the answer to a question goes.
type Reply = Sender<Result<Answer, Error>>;

/// What is asked: settings, how many bytes, whether nothing follows them, and where the answer goes.
type Question = (Settings, u64, bool, Reply);

/// A thread that decodes a recording anew: an estimator stays with its thread.
pub(super) struct Rewinder(Sender<Question>);

impl Rewinder {
    /// It ends when this is dropped. After the `most` frames no more is decoded.
    pub(super) fn begin(path: PathBuf, following: Following, most: Option<u32>) -> Self {
        let (questions, asked) = channel::<Question>();
        let work = move || {
            // From the last moment that was looked at it may not be far to the next.
            let mut last: Option<Rewound> = None;
            for (settings, bytes, is_end, reply) in asked {
                let near = last.take().filter(|it| it.leads_to(bytes, &settings));
                let near = near.map_or_else(|| Rewound::new(&path, &following, settings, most), Ok);
                let answer = near.and_then(|mut near| {
                    let answer = near.answer(bytes, is_end, &path);
                    // What failed, or came to an end, leads nowhere.
                    last = (answer.is_ok() && !is_end).then_some(near);
                    answer
                });
                // Whoever asked may be gone.
                let _ = reply.send(answer);
            }
        };
        // Without a thread nobody takes the questions, and that is told.
        drop(thread::Builder::new().stack_size(crate::STACK_BYTES).spawn(work));
        Self(questions)
    }

    /// What these settings make of so many bytes of the recording, which may be its end.
    ///
    /// # Errors
    /// Whatever is wrong with the settings or the recording.
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

/// A decoder with a place in the recording.
#[derive(Debug)]
struct Rewound {
    settings: Settings,
    decoder: Decoder,
    file: File,
    /// Bytes that were decoded.
    read: u64,
}

impl Rewound {
    /// At the recording's beginning.
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

    /// Whether it need not begin anew to be so many bytes on, with these settings.
    fn leads_to(&self, bytes: u64, settings: &Settings) -> bool {
        self.read <= bytes && self.settings == *settings
    }

    /// What there is to see after so many bytes.
    ///
    /// # Errors
    /// [`Error::Read`] if the recording, `path`, cannot be read; as [`Decoder::take`].
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
            // What takes long is looked at, too.
            self.decoder.pause()?;
        }
        Ok(self.decoder.answer())
    }
}
