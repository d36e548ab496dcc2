//! Connections, each for as long as it asks.

use std::time::Duration;

use axum::Router;
use hyper::server::conn::http1::Builder;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use tokio::net::TcpListener;
use tokio::time::sleep;

/// Whoever has not said within this time what is asked for is not answered.
const PATIENCE: Duration = Duration::from_secs(10);
/// Before the next try if no connection can be had: too many are open.
const PAUSE: Duration = Duration::from_millis(100);

/// Answers whoever asks, until it is dropped.
///
/// `axum::serve` waits for ever for a request that does not end.
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
            // Whoever asked has gone, or asked nothing that can be answered.
            let _ = connection.await;
        });
    }
}
