//! Downloads of a session: tracks, streams, figures, and the session itself as a self-contained page.

use std::fs;
use std::sync::Arc;

use axum::extract::{Path, State};
use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Response};

use super::Shared;
use super::api::{Refusal, beside, find};
use super::question::{Asked, Question};
use crate::figure::{csv, svg};
use crate::report;
use crate::system::{AnySystem, Wanted};

const STREAMS: &str = "streams.mcap";
const SESSION: &str = "session.html";

/// The names of the downloads available for any recording of a system, except for figures.
pub(super) fn names(system: &dyn AnySystem) -> impl Iterator<Item = String> {
    let tables = system
        .outputs()
        .iter()
        .flat_map(|output| output.endings.iter().map(|ending| format!("{}.{ending}", output.name)));
    tables.chain([STREAMS, SESSION].map(str::to_owned))
}

/// Serves a file for the present controls: one of the [`names`], or `figure-ID.svg` and `figure-ID.csv`.
pub(super) async fn download(
    State(shared): State<Arc<Shared>>,
    Path((system, recording, file)): Path<(String, String, String)>,
    body: String,
) -> Result<Response, Refusal> {
    let system = find(&shared, &system)?;
    let question: Question = serde_json::from_str(&body).map_err(Refusal::of)?;
    let bytes = beside(move || content(&shared, system, &recording, &file, &question));
    Ok(([(CONTENT_TYPE, "application/octet-stream")], bytes.await?).into_response())
}

fn content(
    shared: &Shared,
    system: &'static dyn AnySystem,
    recording: &str,
    file: &str,
    question: &Question,
) -> Result<Vec<u8>, Refusal> {
    let asked = Asked::new(shared, system, recording, &question.settings)?;
    let (name, ending) = file.rsplit_once('.').unwrap_or((file, ""));
    let output = system.outputs().iter().find(|output| output.name == name);
    let output = output.filter(|output| output.endings.contains(&ending));
    if output.is_some() || file == STREAMS {
        let Some(uploads) = &shared.uploads else {
            return Err(Refusal::of("no files are made here"));
        };
        let folder = uploads.folder()?;
        let path = folder.path().join(file);
        let mcap = output.is_none().then(|| path.clone());
        let tables = output.map(|output| (output.name, path.clone())).into_iter().collect();
        asked.write(&Wanted { tables, mcap })?;
        return fs::read(path).map_err(Refusal::of);
    }
    let figures = question.figures(shared, system, &asked)?;
    if file == SESSION {
        let session = report::Session {
            title: system.title(),
            command: &asked.command(),
            answer: &asked.answer,
            figures: &figures,
            window_s: question.window,
        };
        return Ok(session.page().into_bytes());
    }
    let figure = name.strip_prefix("figure-");
    let figure = figure.and_then(|id| figures.iter().find(|figure| figure.id == id));
    match (figure, ending) {
        (Some(figure), "svg") => Ok(svg::draw(figure).into_bytes()),
        (Some(figure), "csv") => {
            let mut table = Vec::new();
            csv::write(&mut table, figure).map_err(Refusal::of)?;
            Ok(table)
        }
        _ => Err(Refusal::of(format!("there is no {file:?} of this recording"))),
    }
}
