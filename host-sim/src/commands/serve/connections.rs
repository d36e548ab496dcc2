//! HTTP connections.

use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1::Builder;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::time::sleep;

/// The timeout for receiving the header of a request.
const PATIENCE: Duration = Duration::from_secs(10);
/// The pause before the next attempt if no connection can be accepted because too many are open.
const PAUSE: Duration = Duration::from_millis(100);

/// Serves requests until it is dropped.
///
/// In contrast, `axum::serve` waits for ever for a request that does not end.
pub(in crate::commands) async fn serve(listener: TcpListener, router: Router) {
    let mut builder = Builder::new();
    builder.timer(TokioTimer::new()).header_read_timeout(PATIENCE);
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            sleep(PAUSE).await;
            continue;
        };
        let service = TowerToHyperService::new(router.clone());
        let connection = builder.serve_connection(TokioIo::new(stream), service).with_upgrades();
        tokio::spawn(async move {
            // The client has disconnected, or its request could not be answered.
            let _ = connection.await;
        });
    }
}
