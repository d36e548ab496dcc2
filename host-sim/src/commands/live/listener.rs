//! The receiving thread, which only records what arrives.

use std::sync::Arc;
use std::time::Instant;

use super::Stopper;
use super::recorder::Recorder;
use super::source::Source;
use super::tape::Tape;
use crate::Error;
use crate::commands::datagrams::LONGEST;

/// The listener on a line.
#[derive(Debug)]
pub(super) struct Listener {
    pub(super) source: Source,
    pub(super) recorder: Recorder,
    pub(super) tape: Arc<Tape>,
    pub(super) stop: Stopper,
    pub(super) until: Option<Instant>,
}

impl Listener {
    /// Listens until the line ends or the stream is stopped.
    pub(super) fn run(mut self) -> Result<(), Error> {
        let ended = self.listen();
        // Whether or not an error occurred, nothing more will arrive.
        self.tape.complete();
        ended
    }

    fn listen(&mut self) -> Result<(), Error> {
        let mut buffer = vec![0; LONGEST];
        while !self.is_over() {
            let Some(bytes) = self.source.read(&mut buffer)? else { return Ok(()) };
            if !bytes.is_empty() {
                self.recorder.append(bytes)?;
                self.tape.grow(bytes.len());
            }
        }
        Ok(())
    }

    fn is_over(&self) -> bool {
        self.stop.is_stopped() || self.until.is_some_and(|until| Instant::now() >= until)
    }
}
