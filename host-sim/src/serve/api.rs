//! What the page asks.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use axum::extract::{Multipart, Path as InPath, State};
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::Shared;
use super::sessions::Recording;
use crate::Error;
use crate::explore::{Answer, Explorer, Files, Settings, Source};
use crate::figure::{View, plotly};

/// As many as a figure of the page has columns of pixels, about.
const MOST_POINTS: usize = 700;

/// One plain sentence, as on the command line.
pub(super) struct Refusal(StatusCode, String);

impl Refusal {
    pub(super) fn of(problem: impl Display) -> Self {
        Self(StatusCode::UNPROCESSABLE_ENTITY, format!("{problem}"))
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.0, self.1).into_response()
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::of(error)
    }
}

fn reply(value: &Value) -> Response {
    ([(CONTENT_TYPE, "application/json")], value.to_string()).into_response()
}

/// Everything that can be opened.
pub(super) async fn sources(State(shared): State<Arc<Shared>>) -> Response {
    let source = |source: &Source| {
        json!({
            "system": source.system,
            "title": source.title,
            "files": source.files,
            "bundled": source.bundled,
        })
    };
    let sources: Vec<_> = shared.sources.iter().map(source).collect();
    reply(&json!({ "live": shared.live.is_some(), "sources": sources }))
}

/// Opens a synthetic recording.
pub(super) async fn open_bundled(
    State(shared): State<Arc<Shared>>,
    InPath((system, recording)): InPath<(String, String)>,
) -> Result<Response, Refusal> {
    let source = find(&shared, &system)?;
    let opened = beside(move || (source.open_bundled)(&recording)).await?;
    Ok(keep(&shared, opened, None))
}

/// Opens files that the page uploads.
pub(super) async fn open_files(
    State(shared): State<Arc<Shared>>,
    InPath(system): InPath<String>,
    mut upload: Multipart,
) -> Result<Response, Refusal> {
    let source = find(&shared, &system)?;
    let folder = tempfile::tempdir().map_err(Refusal::of)?;
    let mut files = Files::default();
    while let Some(part) = upload.next_field().await.map_err(Refusal::of)? {
        let field = part.name().unwrap_or_default().to_owned();
        if !source.files.iter().any(|known| known.name == field) {
            return Err(Refusal::of(format!("{system} has no file {field:?}")));
        }
        // The name alone: what a browser sends may hold a path, and it is told apart from others by its field.
        let name = Path::new(part.file_name().unwrap_or_default()).file_name();
        let name = name.map_or_else(|| field.clone().into(), ToOwned::to_owned);
        let within = folder.path().join(&field);
        fs::create_dir_all(&within).map_err(Refusal::of)?;
        let path = within.join(name);
        let bytes = part.bytes().await.map_err(Refusal::of)?;
        fs::write(&path, bytes).map_err(Refusal::of)?;
        files.add(field, path);
    }
    let place = folder.path().to_path_buf();
    let opened = beside(move || {
        (source.open)(&files).map_err(|error| error.naming_files_below(folder.path()))
    });
    Ok(keep(&shared, opened.await?, Some(place)))
}

/// How the page stands.
#[derive(Debug, Deserialize)]
struct Question {
    settings: Map<String, Value>,
    /// Stretches of the horizontal axes of figures that are zoomed in.
    #[serde(default)]
    windows: BTreeMap<String, [f64; 2]>,
}

/// What comes out as the controls stand.
pub(super) async fn answer(
    State(shared): State<Arc<Shared>>,
    InPath(session): InPath<u64>,
    body: String,
) -> Result<Response, Refusal> {
    let Some(recording) = shared.sessions.get(session) else {
        let sentence = "this recording is no longer open: open it again".to_owned();
        return Err(Refusal(StatusCode::GONE, sentence));
    };
    let question: Question = serde_json::from_str(&body).map_err(Refusal::of)?;
    let answer = beside(move || {
        let Recording { explorer, folder } = recording;
        let settings = Settings::sent(&explorer.controls(), &question.settings)?;
        let answer = explorer.answer(&settings).map_err(|error| match &folder {
            Some(folder) => error.naming_files_below(folder),
            None => error,
        })?;
        Ok(page(&answer, &question.windows))
    });
    Ok(reply(&answer.await?))
}

/// An answer as the page takes it.
pub(super) fn page(answer: &Answer, windows: &BTreeMap<String, [f64; 2]>) -> Value {
    let drawn = answer.figures.iter().map(|figure| {
        let view = View { most_points: MOST_POINTS, window: windows.get(&figure.id).copied() };
        plotly::figure(figure, view)
    });
    json!({
        "facts": answer.facts,
        "warnings": answer.warnings,
        "figures": drawn.collect::<Vec<_>>(),
    })
}

fn find(shared: &Shared, system: &str) -> Result<&'static Source, Refusal> {
    let found = shared.sources.iter().find(|source| source.system == system);
    found.ok_or_else(|| Refusal::of(format!("there is no system {system:?}")))
}

fn keep(shared: &Shared, opened: Box<dyn Explorer>, folder: Option<PathBuf>) -> Response {
    let controls = opened.controls();
    let session = shared.sessions.add(Recording { explorer: Arc::from(opened), folder });
    reply(&json!({ "session": session, "controls": controls }))
}

/// Computes on a thread of its own, so that the page stays answered.
async fn beside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Error> + Send + 'static,
) -> Result<T, Refusal> {
    match tokio::task::spawn_blocking(work).await {
        Ok(result) => result.map_err(Refusal::from),
        Err(failure) => Err(Refusal(StatusCode::INTERNAL_SERVER_ERROR, failure.to_string())),
    }
}
