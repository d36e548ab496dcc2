//! A `WebSocket` for a live stream.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::State;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::response::Response;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use tokio::time::{MissedTickBehavior, interval};

use super::api::Refusal;
use super::question::{Windows, page};
use super::{Moment, Shared, Show};
use crate::system::Settings;

/// The minimum interval between two pictures: a person sees no more, and a page draws no faster.
const BEAT: Duration = Duration::from_millis(200);

/// Opens a `WebSocket` that shows the stream.
pub(super) async fn open(
    State(shared): State<Arc<Shared>>,
    socket: WebSocketUpgrade,
) -> Result<Response, Refusal> {
    let Some(live) = shared.live.clone() else {
        return Err(Refusal::of("there is no stream: host-sim live shows one"));
    };
    Ok(socket.on_upgrade(|socket| show(socket, live)))
}

/// A request of the page.
#[derive(Debug, Default, Deserialize)]
struct Wanted {
    settings: Map<String, Value>,
    /// The number of bytes of the stream to show; `None` for the present.
    after: Option<u64>,
}

/// Waits for requests of the page and answers each with a picture.
async fn show(mut socket: WebSocket, live: Arc<dyn Show>) {
    let mut beat = interval(BEAT);
    beat.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        let wanted = match socket.recv().await {
            Some(Ok(Message::Text(text))) => text,
            Some(Ok(Message::Close(_)) | Err(_)) | None => return,
            Some(Ok(_)) => continue,
        };
        beat.tick().await;
        let live = Arc::clone(&live);
        let drawn = tokio::task::spawn_blocking(move || {
            let drawn = draw(live.as_ref(), &wanted);
            drawn.unwrap_or_else(|Refusal(_, refused)| json!({ "refused": refused }))
        });
        let Ok(drawn) = drawn.await else { return };
        if socket.send(Message::Text(drawn.to_string().into())).await.is_err() {
            return;
        }
    }
}

fn draw(live: &dyn Show, wanted: &str) -> Result<Value, Refusal> {
    let wanted: Wanted = serde_json::from_str(wanted).map_err(Refusal::of)?;
    let settings = Settings::sent(live.settings().table(), &wanted.settings)?;
    let answer = live.answer(&settings, wanted.after.map_or(Moment::Now, Moment::After))?;
    let mut page = page(&answer, &answer.figures, &Windows::default());
    page["bytes"] = json!(live.bytes());
    Ok(page)
}
