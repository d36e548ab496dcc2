//! The requests of the page.

use std::fmt::Display;
use std::sync::Arc;

use axum::extract::{Multipart, Path as InPath, State};
use axum::http::StatusCode;
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};
use tempfile::TempDir;

use super::question::{Asked, Question, page};
use super::sessions::{Recording, Upload};
use super::uploads::{self, Content, LARGEST};
use super::{Shared, compare, downloads, question};
use crate::Error;
use crate::system::{AnySystem, Files, Reading, Setting, Settings, Source};

/// An error response: one plain sentence, as on the command line.
pub(super) struct Refusal(pub(super) StatusCode, pub(super) String);

impl Refusal {
    pub(super) fn of(problem: impl Display) -> Self {
        Self(StatusCode::UNPROCESSABLE_ENTITY, format!("{problem}"))
    }

    /// The response for an address whose files have been deleted.
    pub(super) fn gone() -> Self {
        let sentence = "these files are no longer kept here: open them again";
        Self(StatusCode::GONE, sentence.to_owned())
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

pub(super) fn reply(value: &Value) -> Response {
    ([(CONTENT_TYPE, "application/json")], value.to_string()).into_response()
}

/// Lists everything that can be opened.
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
    let live = shared.live.as_ref().map(|live| {
        let settings = live.settings();
        let controls: Vec<_> = settings.table().iter().map(Setting::control).collect();
        json!({ "controls": controls, "settings": settings.to_json() })
    });
    reply(&json!({ "live": live, "sources": sources, "largest": LARGEST }))
}

/// Opens a synthetic recording by name.
pub(super) async fn open_named(
    State(shared): State<Arc<Shared>>,
    InPath((system, recording)): InPath<(String, String)>,
) -> Result<Response, Refusal> {
    let system = find(&shared, &system)?;
    let name = recording.clone();
    let opened = beside(move || shared.sessions.get(system, &recording)).await?;
    Ok(reply(&controls(system, &name, &opened)))
}

/// Opens files uploaded by the page.
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
    let (mut files, mut content) = (Files::default(), Content::default());
    while let Some(part) = upload.next_field().await.map_err(Refusal::of)? {
        let field = part.name().unwrap_or_default().to_owned();
        if Reading::texts().any(|name| name == field) {
            let text = part.text().await.map_err(Refusal::of)?;
            content.say(&field);
            content.say(text.trim());
            files.reading.say(&field, text.trim())?;
            continue;
        }
        if !system.files().iter().any(|known| known.name == field) {
            return Err(Refusal::of(format!("{name} has no file {field:?}")));
        }
        let path = uploads::write(folder.path(), &field, part, &mut content).await?;
        files.add(field, path);
    }
    Ok(reply(&open_kept(&shared, system, files, folder, content).await?))
}

/// Opens files in a folder and keeps them.
///
/// # Errors
/// Unusable files are refused when they are opened, not when a control is moved; but a missing setting that a control
/// can supply is asked for beside the controls.
pub(super) async fn open_kept(
    shared: &Shared,
    system: &'static dyn AnySystem,
    files: Files,
    folder: TempDir,
    content: Content,
) -> Result<Value, Refusal> {
    let folder = Arc::new(folder);
    let upload = Upload { files: files.without_what_was_read(), folder: Arc::clone(&folder) };
    let settings = Settings::new(system.settings());
    let opened = beside(move || {
        let open = || {
            let opened = system.open(Source::Files(files), &settings)?;
            match opened.answer(&Settings::new(opened.settings())) {
                Err(error) if !asks_for_a_setting(&error, &opened.settings()) => Err(error),
                _ => Ok(opened),
            }
        };
        open().map_err(|error: Error| error.naming_files_below(folder.path()).into())
    });
    let (opened, name) = (upload.opened(opened.await?), content.name());
    shared.sessions.keep((system.name(), name.clone()), upload);
    shared.sessions.add((system.name(), name.clone()), opened.clone());
    Ok(controls(system, &name, &opened))
}

/// The name of an open recording, its controls and its downloads.
fn controls(system: &dyn AnySystem, recording: &str, open: &Recording) -> Value {
    let Recording { opened, files, .. } = open;
    let controls: Vec<_> = opened.settings().iter().map(Setting::control).collect();
    // Errors in the settings are reported by the answer.
    let findings = opened.check(&Settings::new(opened.settings())).unwrap_or_default();
    json!({
        "system": system.name(),
        "recording": recording,
        "files": files,
        "controls": controls,
        "findings": question::findings(&findings),
        "downloads": downloads::names(system).collect::<Vec<_>>(),
    })
}

/// Whether an error names the option of a setting.
fn asks_for_a_setting(error: &Error, settings: &[Setting]) -> bool {
    let sentence = error.to_string();
    let is_of_name = |letter: char| letter.is_ascii_lowercase() || letter == '-';
    let mut named = sentence.split("--").skip(1).map(|rest| {
        let end = rest.find(|letter| !is_of_name(letter)).unwrap_or(rest.len());
        rest.get(..end).unwrap_or_default().trim_end_matches('-')
    });
    named.any(|name| settings.iter().any(|setting| setting.name == name))
}

/// Computes the answer for the present controls.
pub(super) async fn answer(
    State(shared): State<Arc<Shared>>,
    InPath((system, recording)): InPath<(String, String)>,
    body: String,
) -> Result<Response, Refusal> {
    let system = find(&shared, &system)?;
    let question: Question = serde_json::from_str(&body).map_err(Refusal::of)?;
    let answer = beside(move || {
        let windows = question.windows();
        let asked = Asked::new(&shared, system, &recording, &question.settings)?;
        let mut page = match question.other(&shared, system)? {
            None => page(&asked.answer, &asked.answer.figures, &windows),
            Some((other, how)) => {
                let figures = compare::figures(&other.answer, &asked.answer, how);
                let mut page = page(&asked.answer, &figures, &windows);
                page["changed"] = json!(compare::changed(&other, &asked));
                page
            }
        };
        page["command"] = json!(asked.command());
        Ok(page)
    });
    Ok(reply(&answer.await?))
}

pub(super) fn find(shared: &Shared, name: &str) -> Result<&'static dyn AnySystem, Refusal> {
    let found = shared.systems.iter().copied().find(|system| system.name() == name);
    found.ok_or_else(|| Refusal::of(format!("there is no system {name:?}")))
}

/// Runs work on a blocking thread, so that the server stays responsive.
pub(super) async fn beside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Refusal> + Send + 'static,
) -> Result<T, Refusal> {
    let failed = |failure: tokio::task::JoinError| {
        Refusal(StatusCode::INTERNAL_SERVER_ERROR, failure.to_string())
    };
    tokio::task::spawn_blocking(work).await.map_err(failed)?
}
