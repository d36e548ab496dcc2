//! What the page asks.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use axum::extract::{Multipart, Path as InPath, State};
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::sessions::Recording;
use super::{Shared, uploads};
use crate::Error;
use crate::figure::{View, plotly};
use crate::system::{Answer, AnySystem, Files, Opened, Reading, Setting, Settings, Source};

/// As many as a figure of the page has columns of pixels, about.
const MOST_POINTS: usize = 700;

/// One plain sentence, as on the command line.
pub(super) struct Refusal(pub(super) StatusCode, pub(super) String);

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
    let source = |system: &&dyn AnySystem| {
        json!({
            "system": system.name(),
            "title": system.title(),
            "files": system.files(),
            "reading": Reading::forms(),
            "bundled": system.synthetic(),
        })
    };
    let sources: Vec<_> = shared.systems.iter().map(source).collect();
    reply(&json!({ "live": shared.live.is_some(), "sources": sources }))
}

/// Opens a synthetic recording.
pub(super) async fn open_bundled(
    State(shared): State<Arc<Shared>>,
    InPath((system, recording)): InPath<(String, String)>,
) -> Result<Response, Refusal> {
    let system = find(&shared, &system)?;
    let settings = Settings::new(system.settings());
    let opened = beside(move || {
        let opened = system.open(Source::Synthetic(recording), &settings)?;
        opened.answer(&Settings::new(opened.settings()))?;
        Ok(opened)
    });
    Ok(keep(&shared, opened.await?, None))
}

/// Opens files that the page uploads.
pub(super) async fn open_files(
    State(shared): State<Arc<Shared>>,
    InPath(name): InPath<String>,
    mut upload: Multipart,
) -> Result<Response, Refusal> {
    let system = find(&shared, &name)?;
    let Some(uploads) = &shared.uploads else {
        return Err(Refusal::of("no files are opened here"));
    };
    let (_turn, folder) = uploads.begin()?;
    let mut files = Files::default();
    while let Some(part) = upload.next_field().await.map_err(Refusal::of)? {
        let field = part.name().unwrap_or_default().to_owned();
        if Reading::texts().any(|name| name == field) {
            let text = part.text().await.map_err(Refusal::of)?;
            files.reading.say(&field, text.trim())?;
            continue;
        }
        if !system.files().iter().any(|known| known.name == field) {
            return Err(Refusal::of(format!("{name} has no file {field:?}")));
        }
        files.add(field, uploads::write(folder.path(), part).await?);
    }
    let place = folder.path().to_path_buf();
    let settings = Settings::new(system.settings());
    let opened = beside(move || {
        let open = || {
            let opened = system.open(Source::Files(files), &settings)?;
            // What cannot be used is refused when it is opened, not when a control is moved; but what a control can say is
            // asked for beside the controls.
            match opened.answer(&Settings::new(opened.settings())) {
                Err(error) if !asks_for_a_setting(&error, &opened.settings()) => Err(error),
                _ => Ok(opened),
            }
        };
        open().map_err(|error: Error| error.naming_files_below(folder.path()))
    });
    Ok(keep(&shared, opened.await?, Some(place)))
}

/// Whether a refusal names the option of a setting.
fn asks_for_a_setting(error: &Error, settings: &[Setting]) -> bool {
    let sentence = error.to_string();
    let is_of_name = |letter: char| letter.is_ascii_lowercase() || letter == '-';
    let mut named = sentence.split("--").skip(1).map(|rest| {
        let end = rest.find(|letter| !is_of_name(letter)).unwrap_or(rest.len());
        rest.get(..end).unwrap_or_default().trim_end_matches('-')
    });
    named.any(|name| settings.iter().any(|setting| setting.name == name))
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
        let Recording { opened, folder } = recording;
        let settings = Settings::sent(opened.settings(), &question.settings)?;
        let mut answer = opened.answer(&settings).map_err(|error| match &folder {
            Some(folder) => error.naming_files_below(folder),
            None => error,
        })?;
        if let Some(folder) = &folder {
            answer.command = naming_files_below(&answer.command, folder);
        }
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
        "disabled": answer.disabled,
        "command": answer.command,
        "firmware": answer.firmware,
        "findings": answer.findings.iter().map(|it| (it.is_fault(), it.about, it.sentence())).collect::<Vec<_>>(),
    })
}

/// A command with uploaded files named as they were on the user's disk.
fn naming_files_below(command: &str, folder: &Path) -> String {
    let folder = format!("{}/", folder.display());
    let mut pieces = command.split(&folder);
    let first = pieces.next().unwrap_or_default().to_owned();
    // Each file lies in a folder that is called like its field.
    let names = pieces.map(|piece| piece.split_once('/').map_or(piece, |(_, name)| name));
    names.fold(first, |command, name| command + name)
}

fn find(shared: &Shared, name: &str) -> Result<&'static dyn AnySystem, Refusal> {
    let found = shared.systems.iter().copied().find(|system| system.name() == name);
    found.ok_or_else(|| Refusal::of(format!("there is no system {name:?}")))
}

fn keep(shared: &Shared, opened: Box<dyn Opened>, folder: Option<PathBuf>) -> Response {
    let controls: Vec<_> = opened.settings().iter().map(Setting::control).collect();
    let session = shared.sessions.add(Recording { opened: Arc::from(opened), folder });
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
