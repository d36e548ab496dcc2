//! Metrics in the text format of Prometheus.

use std::fmt::Write;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};

use axum::Router;
use axum::http::header::CONTENT_TYPE;
use axum::routing::get;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

use super::engine::Engine;
use crate::Error;

/// The content type of the text format.
const FORMAT: &str = "text/plain; version=0.0.4";

/// A metrics page; it is served until this is dropped.
#[derive(Debug)]
pub(super) struct Metrics {
    text: Arc<Mutex<String>>,
    address: SocketAddr,
    _runtime: Runtime,
}

impl Metrics {
    /// Serves the page at this address.
    ///
    /// # Errors
    /// [`Error::Usage`] if the address is not available.
    pub(super) fn serve(address: SocketAddr) -> Result<Self, Error> {
        let failed = |error: std::io::Error| Error::Usage(format!("--metrics {address}: {error}"));
        let mut builder = tokio::runtime::Builder::new_multi_thread();
        let runtime = builder.worker_threads(1).enable_all().build().map_err(failed)?;
        let listener = runtime.block_on(TcpListener::bind(address)).map_err(failed)?;
        let address = listener.local_addr().map_err(failed)?;
        let text = Arc::<Mutex<String>>::default();
        let shown = Arc::clone(&text);
        let answer = move || {
            let text = shown.lock().unwrap_or_else(PoisonError::into_inner).clone();
            async move { ([(CONTENT_TYPE, FORMAT)], text) }
        };
        let router = Router::new().route("/metrics", get(answer));
        runtime.spawn(crate::commands::serve::answer(listener, router));
        Ok(Self { text, address, _runtime: runtime })
    }

    /// The URL of the page.
    pub(super) fn address(&self) -> String {
        format!("http://{}/metrics", self.address)
    }

    /// Updates the page to the present state.
    pub(super) fn show(&self, engine: &Engine) {
        *self.text.lock().unwrap_or_else(PoisonError::into_inner) = text(engine);
    }
}

/// All metrics, each with its description.
fn text(engine: &Engine) -> String {
    let fleet = &engine.fleet;
    let (counts, keyed) = (fleet.counts(), &fleet.keyed);
    let mut text = String::new();
    let mut say = |name: &str, help: &str, kind: &str, value: f64| {
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "# HELP kestirim_fleet_{name} {help}.\n# TYPE kestirim_fleet_{name} {kind}\nkestirim_fleet_{name} {value}"
        );
    };
    for (name, help, count) in counts.named() {
        say(&format!("{name}_total"), help, "counter", count as f64);
    }
    let unreadable = "Messages that were not whole frames of devices";
    say("unreadable_total", unreadable, "counter", keyed.unreadable as f64);
    say("devices", "Devices that were heard", "gauge", keyed.devices.len() as f64);
    say("state_bytes", "Bytes of all states", "gauge", fleet.bytes() as f64);
    say("position", "Last message that was followed", "gauge", keyed.position as f64);
    let acknowledged = "Last message whose effects are on the disk";
    say("acknowledged_position", acknowledged, "gauge", engine.acknowledged as f64);
    say("writing_seconds", "Time to write all states, the last time", "gauge", engine.writing_s);
    if let Some(lag) = engine.transport.lag() {
        say("lag_messages", "Messages that wait at the broker", "gauge", lag as f64);
    }
    text
}
