//! A stream, as it comes.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::response::Response;
use tokio::time::{MissedTickBehavior, interval};

use super::api::Refusal;
use super::question::{Windows, page};
use super::{Shared, View};

/// Between two pictures at least: a person sees no more, and a page draws no faster.
const BEAT: Duration = Duration::from_millis(200);

/// Opens a socket that shows the stream.
pub(super) async fn open(
    State(shared): State<Arc<Shared>>,
    socket: WebSocketUpgrade,
) -> Result<Response, Refusal> {
    let Some(live) = shared.live.clone() else {
        return Err(Refusal::of("there is no stream: host-sim live shows one"));
    };
    Ok(socket.on_upgrade(|socket| show(socket, live)))
}

/// Sends a picture, waits until the page has drawn it, and sends the next.
async fn show(mut socket: WebSocket, live: View) {
    let mut beat = interval(BEAT);
    beat.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        beat.tick().await;
        let view = Arc::clone(&live);
        let drawn = tokio::task::spawn_blocking(move || {
            let answer = view();
            page(&answer, &answer.figures, &Windows::default()).to_string()
        });
        let Ok(text) = drawn.await else { return };
        if socket.send(Message::Text(text.into())).await.is_err() {
            return;
        }
        match socket.recv().await {
            Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            Some(Ok(_)) => {}
        }
    }
}
