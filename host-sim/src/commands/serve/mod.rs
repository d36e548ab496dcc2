//! `host-sim serve`: the explorer, a page on this machine alone.
//!
//! The page sends how its controls stand; the estimators run here.

mod api;
mod assets;
mod guard;
mod sessions;
mod socket;

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::routing::{get, post};
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

use crate::system::{Answer, AnySystem};
use crate::systems::ALL;
use crate::{Error, output};
use sessions::Sessions;

/// What gives an answer whenever it is asked.
pub type View = Arc<dyn Fn() -> Answer + Send + Sync>;

/// The page's port unless told otherwise.
pub const PORT: u16 = 8017;
/// A day of satellites is some tens of megabytes.
const LARGEST_UPLOAD: usize = 512 << 20;

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
    /// [`Error::Usage`] if the port cannot be had.
    pub fn run(self) -> Result<(), Error> {
        let shared = Arc::new(Shared { systems: &ALL, sessions: Sessions::default(), live: None });
        let runtime = runtime()?;
        let ended = runtime.block_on(async {
            let (listener, address) = bind(self.port).await?;
            output::print(&format!("http://{address}/  (Ctrl-C ends)"))?;
            let serving = axum::serve(listener, router(shared, address));
            let interrupted = async {
                // Without a signal handler the signal ends the program by itself.
                let _ = tokio::signal::ctrl_c().await;
            };
            tokio::select! {
                result = serving => result
                    .map_err(|error| Error::Usage(format!("the page cannot be served any longer: {error}"))),
                () = interrupted => Ok(()),
            }
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
    address: SocketAddr,
}

impl Page {
    /// Takes the port; nobody is answered yet.
    ///
    /// # Errors
    /// [`Error::Usage`] if it cannot be had.
    pub fn bind(port: u16) -> Result<Self, Error> {
        let runtime = runtime()?;
        let (listener, address) = runtime.block_on(bind(port))?;
        Ok(Self { runtime, listener: Some(listener), address })
    }

    /// Shows what `live` says.
    pub fn show(&mut self, live: View) {
        let Some(listener) = self.listener.take() else { return };
        let shared = Shared { systems: &[], sessions: Sessions::default(), live: Some(live) };
        let router = router(Arc::new(shared), self.address);
        self.runtime.spawn(axum::serve(listener, router).into_future());
    }

    /// Where it is.
    pub fn address(&self) -> String {
        format!("http://{}/", self.address)
    }
}

/// What all requests have in common.
struct Shared {
    systems: &'static [&'static dyn AnySystem],
    sessions: Sessions,
    /// Where there is a stream to show.
    live: Option<View>,
}

fn runtime() -> Result<Runtime, Error> {
    tokio::runtime::Builder::new_multi_thread()
        .enable_all()
        .thread_stack_size(crate::STACK_BYTES)
        .build()
        .map_err(|error| Error::Usage(format!("no threads: {error}")))
}

/// Listens where nobody but this machine can ask.
async fn bind(port: u16) -> Result<(TcpListener, SocketAddr), Error> {
    let bound = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).await;
    bound
        .and_then(|listener| listener.local_addr().map(|address| (listener, address)))
        .map_err(|error| Error::Usage(format!("port {port} cannot be had: {error} (--port)")))
}

fn router(shared: Arc<Shared>, address: SocketAddr) -> Router {
    Router::new()
        .route("/api/sources", get(api::sources))
        .route("/api/open/{system}", post(api::open_files))
        .route("/api/open/{system}/{recording}", post(api::open_bundled))
        .route("/api/answer/{session}", post(api::answer))
        .route("/live", get(socket::open))
        .layer(DefaultBodyLimit::max(LARGEST_UPLOAD))
        .with_state(shared)
        .merge(assets::router())
        .layer(axum::middleware::from_fn_with_state(address, guard::only_this_machine))
}
