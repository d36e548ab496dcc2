//! `host-sim live`: receives telemetry from a running sender and follows it.
//!
//! `source` → `recorder` → file → `tape` → `follower` → `decoder` → `device` (`order` → `feed`) → [`Online`](crate::system::Online) → `state` →
//! `picture`.
//!
//! One thread waits for bytes and does nothing but write them to the recording; the other reads them from there,
//! decodes them and feeds the estimator. So whatever counts as received is in the file, the receiver never waits, and
//! an estimator that is slower than the stream falls behind without losing anything. A request for an
//! [answer](Live::answer) delays the second thread at most.

mod clock;
mod decoder;
mod device;
mod devices;
mod feed;
mod follower;
mod hearing;
mod listener;
pub mod options;
mod order;
mod own_health;
mod picture;
mod recorder;
mod report;
mod rewound;
mod senders;
mod source;
mod state;
mod tape;
mod thinned;
mod viewed;
mod window;

use std::net::SocketAddr;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use clap::ArgMatches;

pub use self::device::Row;
use self::follower::Follower;
use self::listener::Listener;
use self::options::{Following, Stream};
pub(super) use self::options::{command, complaint};
pub use self::own_health::OwnHealth;
use self::recorder::Recorder;
pub use self::report::{Counts, DeviceRow, Report};
use self::source::Source;
use self::state::State;
use self::tape::{Reel, Tape};
use self::viewed::Viewed;
use super::serve::{Page, Show};
use crate::system::{Answer, Plan};
use crate::text::printable_path;
use crate::{Error, output};

/// The interval at which the end of the stream is polled.
const PATIENCE: Duration = Duration::from_millis(20);

/// Listens until the stream ends or Ctrl-C is pressed, and prints a report.
pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (stream, following) = options::read(matches)?;
    let mut page = (!stream.headless).then(|| Page::bind(stream.port)).transpose()?;
    let live = Live::start(&stream, &following)?;
    output::warn(&live.announcement());
    if let Some(page) = &mut page {
        page.show(live.view());
        output::warn(&format!("page: {}  (Ctrl-C ends)", page.address()));
    }
    let (stop, ended) = (live.stopper(), Stopper::default());
    let end = ended.clone();
    // Without a handler Ctrl-C ends the program at once: even so the recording is complete.
    let _ = ctrlc::set_handler(move || {
        stop.stop();
        end.stop();
    });
    while !live.is_finished() {
        thread::sleep(PATIENCE);
    }
    let report = live.finish()?;
    for warning in &report.warnings {
        output::warn(&format!("warning: {warning}"));
    }
    if let Some(path) = &stream.file
        && report.counts.received == 0
        && report.counts.taken == 0
    {
        let problem = "expected a recorded stream, found no frame".to_owned();
        return Err(Error::File { path: path.clone(), problem });
    }
    output::show(&report, stream.json)?;
    // A recording that is played back ends before anyone can look at the page.
    while page.is_some() && stream.file.is_some() && !ended.is_stopped() {
        thread::sleep(PATIENCE);
    }
    Ok(())
}

/// A stream that is being recorded and followed.
#[derive(Debug)]
pub struct Live {
    state: Arc<Mutex<State>>,
    following: Following,
    /// The number of frames after which to stop.
    most: Option<u32>,
    stop: Stopper,
    listener: Option<JoinHandle<Result<(), Error>>>,
    follower: Option<JoinHandle<Result<(), Error>>>,
    address: Option<SocketAddr>,
    source: String,
    recording: PathBuf,
}

/// A handle that ends a stream from any thread.
#[derive(Debug, Clone, Default)]
pub struct Stopper(Arc<AtomicBool>);

impl Stopper {
    /// Stops receiving; what has arrived is still processed.
    pub fn stop(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Live {
    /// Starts the stream that a command line of `live` asks for.
    ///
    /// # Errors
    /// Those of [`Live::start`], and errors in options and files.
    pub fn of(matches: &ArgMatches) -> Result<Self, Error> {
        let (stream, following) = options::read(matches)?;
        Self::start(&stream, &following)
    }

    /// Starts listening, recording and following; or plays a recording back.
    ///
    /// # Errors
    /// Errors in options, files, address and device; no recording has then been begun.
    pub fn start(options: &Stream, following: &Following) -> Result<Self, Error> {
        let stop = Stopper::default();
        let state = State::new(following);
        let ignored = Arc::clone(&state.ignored);
        let mut live = Self {
            state: Arc::new(Mutex::new(state)),
            following: following.clone(),
            most: options.frames,
            stop: stop.clone(),
            listener: None,
            follower: None,
            address: None,
            source: String::new(),
            recording: PathBuf::new(),
        };
        // Building an estimator now reports unsuitable settings before anything is recorded.
        following.plan.as_deref().map(Plan::build).transpose()?;
        let (reel, disk) = match &options.file {
            Some(path) => {
                live.source = printable_path(path);
                live.recording.clone_from(path);
                let reel = Reel::complete(path);
                (reel.map_err(|source| Error::Read { path: path.clone(), source })?, None)
            }
            None => live.listen(options, ignored)?,
        };
        let (state, most) = (Arc::clone(&live.state), options.frames);
        let (path, following) = (live.recording.clone(), following.clone());
        let follower = Follower { reel, disk, following, state, most, stop, path };
        live.follower = Some(thread(|| follower.run())?);
        Ok(live)
    }

    /// Starts listening and recording; returns the reader of the recording, and the file to sync to the disk.
    fn listen(
        &mut self,
        options: &Stream,
        ignored: Arc<AtomicU64>,
    ) -> Result<(Reel, Option<std::fs::File>), Error> {
        let source = match &options.serial {
            Some(device) => Source::serial(device, options.baud)?,
            None => Source::udp(options.address(), ignored)?,
        };
        let recorder = Recorder::create(options.record.as_deref())?;
        self.address = source.address();
        self.source = source.name();
        self.recording = recorder.path().to_path_buf();
        let tape = Arc::new(Tape::default());
        let reel = Reel::growing(&self.recording, Arc::clone(&tape))
            .map_err(|source| Error::Read { path: self.recording.clone(), source })?;
        let disk = recorder.file()?;
        let seconds = options.seconds.map(Duration::from_secs);
        let until = seconds.and_then(|seconds| Instant::now().checked_add(seconds));
        let listener = Listener { source, recorder, tape, stop: self.stop.clone(), until };
        self.listener = Some(thread(|| listener.run())?);
        Ok((reel, Some(disk)))
    }

    /// The address on which datagrams are received, if any.
    pub fn address(&self) -> Option<SocketAddr> {
        self.address
    }

    /// The path of the recording.
    pub fn recording(&self) -> &Path {
        &self.recording
    }

    /// One line that names the source and the recording.
    pub fn announcement(&self) -> String {
        if self.listener.is_none() {
            return format!("playing {} back", self.source);
        }
        let (source, recording) = (&self.source, printable_path(&self.recording));
        let open = self.address.filter(|address| !address.ip().is_loopback());
        let warning = if open.is_some() { "; anybody in the network can send to it" } else { "" };
        format!("listening on {source}, recording to {recording}{warning}")
    }

    /// A handle that ends the stream from any thread.
    pub fn stopper(&self) -> Stopper {
        self.stop.clone()
    }

    /// The present answer for the page.
    pub fn answer(&self) -> Answer {
        self.viewed().now()
    }

    /// The view that a page shows, usable from any thread and even after the stream is finished.
    pub fn view(&self) -> Arc<dyn Show> {
        Arc::new(self.viewed())
    }

    fn viewed(&self) -> Viewed {
        Viewed {
            state: Arc::clone(&self.state),
            following: self.following.clone(),
            source: self.source.clone(),
            recording: self.recording.clone(),
            most: self.most,
            stop: self.stop.clone(),
            rewinder: OnceLock::new(),
        }
    }

    /// The counters so far.
    pub fn counts(&self) -> Counts {
        self.state().counts
    }

    /// Whether the stream has ended and all of it has been followed.
    pub fn is_finished(&self) -> bool {
        self.follower.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Stops listening and returns the report.
    ///
    /// # Errors
    /// If the line failed or the recording could not be continued.
    pub fn finish(mut self) -> Result<Report, Error> {
        self.stop.stop();
        // The listener's error comes first: without the listener there is nothing to follow.
        for thread in [self.listener.take(), self.follower.take()].into_iter().flatten() {
            thread.join().unwrap_or_else(|panic| resume_unwind(panic))?;
        }
        let (source, recording) = (self.source.clone(), self.recording.clone());
        Ok(self.state().report(source, recording))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.stop.stop();
    }
}

fn thread<T: Send + 'static>(
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<JoinHandle<T>, Error> {
    let spawned = thread::Builder::new().stack_size(crate::STACK_BYTES).spawn(work);
    spawned.map_err(|error| Error::Usage(format!("no thread: {error}")))
}
