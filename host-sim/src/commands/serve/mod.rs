//! `host-sim serve`: the explorer, a page for this machine only.
//!
//! The page sends the state of its controls; the estimators run in this program.

mod api;
mod assets;
mod compare;
mod connections;
mod downloads;
mod dropped;
mod guard;
mod key;
mod question;
mod sessions;
mod socket;
mod uploads;
mod zipped;

use std::net::Ipv4Addr;
use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};
use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::sync::Notify;

#[cfg(feature = "fleet")]
pub(super) use self::connections::serve as answer;
use self::guard::Guard;
use self::key::Key;
use self::sessions::Sessions;
use self::uploads::{LARGEST, Uploads};
use crate::system::{Answer, AnySystem, Settings};
use crate::systems::ALL;
use crate::{Error, output};

/// A live stream that a page can show.
pub trait Show: Send + Sync {
    /// The settings with their present values.
    fn settings(&self) -> Settings;

    /// The number of bytes of the stream so far.
    fn bytes(&self) -> u64;

    /// The answer at a moment of the stream, with these settings.
    ///
    /// # Errors
    /// A one-sentence error if the settings give no result.
    fn answer(&self, settings: &Settings, moment: Moment) -> Result<Answer, Error>;
}

/// A moment of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    /// The present.
    Now,
    /// The moment after this number of bytes.
    After(u64),
}

/// The default port of the page.
pub const PORT: u16 = 8017;

/// Options of the command.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct Serve {
    /// Port on this machine; 0 takes a free one
    #[arg(long, value_name = "P", default_value_t = PORT)]
    port: u16,
}

impl Serve {
    /// Serves the page until the program is interrupted.
    ///
    /// # Errors
    /// [`Error::Usage`] if the port or a folder for uploads is not available.
    pub fn run(self) -> Result<(), Error> {
        let folder = tempfile::tempdir()
            .map_err(|error| Error::Usage(format!("no folder for uploads: {error}")))?;
        let uploads = Some(Uploads::to(folder.path()));
        let shared = Shared { systems: &ALL, sessions: Sessions::default(), live: None, uploads };
        let interrupted = Arc::new(Notify::new());
        let interrupt = Arc::clone(&interrupted);
        // Without a handler a signal ends the program at once and leaves the folder behind.
        let _ = ctrlc::set_handler(move || interrupt.notify_one());
        let runtime = runtime()?;
        let ended = runtime.block_on(async {
            let (listener, guard) = bind(self.port).await?;
            output::print(&format!("{}  (Ctrl-C ends)", guard.address()))?;
            tokio::select! {
                () = connections::serve(listener, router(shared, guard)) => {}
                () = interrupted.notified() => {}
            }
            Ok(())
        });
        // Computations that are still running are not awaited.
        runtime.shutdown_background();
        ended
    }
}

/// The page of a stream, served in the background until this is dropped.
#[derive(Debug)]
pub struct Page {
    runtime: Runtime,
    listener: Option<TcpListener>,
    guard: Guard,
}

impl Page {
    /// Binds the port without answering requests yet.
    ///
    /// # Errors
    /// [`Error::Usage`] if the port is not available.
    pub fn bind(port: u16) -> Result<Self, Error> {
        let runtime = runtime()?;
        let (listener, guard) = runtime.block_on(bind(port))?;
        Ok(Self { runtime, listener: Some(listener), guard })
    }

    /// Starts serving the page with this stream.
    pub fn show(&mut self, live: Arc<dyn Show>) {
        let Some(listener) = self.listener.take() else { return };
        let (systems, sessions) = (&[], Sessions::default());
        let shared = Shared { systems, sessions, live: Some(live), uploads: None };
        self.runtime.spawn(connections::serve(listener, router(shared, self.guard.clone())));
    }

    /// The address of the page, including its key.
    pub fn address(&self) -> String {
        self.guard.address()
    }
}

/// The data shared by all requests.
struct Shared {
    systems: &'static [&'static dyn AnySystem],
    sessions: Sessions,
    /// The stream to show, if there is one.
    live: Option<Arc<dyn Show>>,
    /// The upload folders, if files can be opened.
    uploads: Option<Uploads>,
}

fn runtime() -> Result<Runtime, Error> {
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .thread_stack_size(crate::STACK_BYTES)
        .build()
        .map_err(|error| Error::Usage(format!("no threads: {error}")))
}

/// Binds a port that only this machine reaches, and there only users who have the key.
async fn bind(port: u16) -> Result<(TcpListener, Guard), Error> {
    let bound = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).await;
    let (listener, address) = bound
        .and_then(|listener| listener.local_addr().map(|address| (listener, address)))
        .map_err(|error| Error::Usage(format!("port {port} cannot be had: {error} (--port)")))?;
    let key = Key::random().map_err(|error| Error::Usage(format!("no random numbers: {error}")))?;
    Ok((listener, Guard { address, key }))
}

fn router(shared: Shared, guard: Guard) -> Router {
    Router::new()
        .route("/api/sources", get(api::sources))
        .route("/api/open/{system}", post(api::open_files))
        .route("/api/drop/{system}", post(dropped::open))
        .route("/api/open/{system}/{recording}", post(api::open_named))
        .route("/api/answer/{system}/{recording}", post(api::answer))
        .route("/api/download/{system}/{recording}/{file}", post(downloads::download))
        .route("/live", get(socket::open))
        .layer(DefaultBodyLimit::max(LARGEST))
        .with_state(Arc::new(shared))
        .merge(assets::router())
        .layer(axum::middleware::from_fn_with_state(guard, guard::only_with_key))
}
