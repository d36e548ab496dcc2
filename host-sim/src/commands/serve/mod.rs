//! `host-sim serve`: the explorer, a page on this machine alone.
//!
//! The page sends how its controls stand; the estimators run here.

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

/// A stream that is shown while it comes.
pub trait Show: Send + Sync {
    /// What can be set, and what is.
    fn settings(&self) -> Settings;

    /// How much of it there is.
    fn bytes(&self) -> u64;

    /// What there is to see of it at a moment, with these settings.
    ///
    /// # Errors
    /// One sentence, if the settings give nothing.
    fn answer(&self, settings: &Settings, moment: Moment) -> Result<Answer, Error>;
}

/// When a stream is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moment {
    /// As it is.
    Now,
    /// As it was after so many bytes.
    After(u64),
}

/// The page's port unless told otherwise.
pub const PORT: u16 = 8017;

/// Options of the command.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct Serve {
    /// Port on this machine; 0 takes a free one
    #[arg(long, value_name = "P", default_value_t = PORT)]
    port: u16,
}

impl Serve {
    /// Serves the page until it is interrupted.
    ///
    /// # Errors
    /// [`Error::Usage`] if the port or a folder for uploads cannot be had.
    pub fn run(self) -> Result<(), Error> {
        let folder = tempfile::tempdir()
            .map_err(|error| Error::Usage(format!("no folder for uploads: {error}")))?;
        let uploads = Some(Uploads::to(folder.path()));
        let shared = Shared { systems: &ALL, sessions: Sessions::default(), live: None, uploads };
        let interrupted = Arc::new(Notify::new());
        let interrupt = Arc::clone(&interrupted);
        // Without it a signal ends the program at once, and the folder stays.
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
        // Nobody waits for what is still being computed.
        runtime.shutdown_background();
        ended
    }
}

/// The page of a stream, beside whatever else the program does; it ends with this.
#[derive(Debug)]
pub struct Page {
    runtime: Runtime,
    listener: Option<TcpListener>,
    guard: Guard,
}

impl Page {
    /// Takes the port; nobody is answered yet.
    ///
    /// # Errors
    /// [`Error::Usage`] if it cannot be had.
    pub fn bind(port: u16) -> Result<Self, Error> {
        let runtime = runtime()?;
        let (listener, guard) = runtime.block_on(bind(port))?;
        Ok(Self { runtime, listener: Some(listener), guard })
    }

    /// Shows what `live` says.
    pub fn show(&mut self, live: Arc<dyn Show>) {
        let Some(listener) = self.listener.take() else { return };
        let (systems, sessions) = (&[], Sessions::default());
        let shared = Shared { systems, sessions, live: Some(live), uploads: None };
        self.runtime.spawn(connections::serve(listener, router(shared, self.guard.clone())));
    }

    /// Where it is, with the key to it.
    pub fn address(&self) -> String {
        self.guard.address()
    }
}

/// What all requests have in common.
struct Shared {
    systems: &'static [&'static dyn AnySystem],
    sessions: Sessions,
    /// Where there is a stream to show.
    live: Option<Arc<dyn Show>>,
    /// Where files can be opened.
    uploads: Option<Uploads>,
}

fn runtime() -> Result<Runtime, Error> {
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .thread_stack_size(crate::STACK_BYTES)
        .build()
        .map_err(|error| Error::Usage(format!("no threads: {error}")))
}

/// Listens where nobody but this machine can ask, and nobody there who was not told the key.
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
