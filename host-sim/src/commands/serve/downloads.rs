//! What a session gives away: tracks, streams, figures, and the session itself as a page of its own.

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

/// Names of what can be had of any recording of a system, but for its figures.
pub(super) fn names(system: &dyn AnySystem) -> impl Iterator<Item = String> {
    let tables = system
        .outputs()
        .iter()
        .flat_map(|output| output.endings.iter().map(|ending| format!("{}.{ending}", output.name)));
    tables.chain([STREAMS, SESSION].map(str::to_owned))
}

/// A file as the controls stand: one of the [`names`], or `figure-ID.svg` and `figure-ID.csv`.
pub(super) async fn download(
    State(shared): State<Arc<Shared>>,
    Path((system, recording, file)): Path<(String, String, String)>,
    body: String,
) -> Result<Response, Refusal> {
    let system = find(&shared, &system)?;
    let question: Question = serde_json::from_str(&body).map_err(Refusal::of)?;
    let bytes = beside(move || {
        let asked = Asked::new(&shared, system, &recording, &question.settings)?;
        content(system, &asked, &file, &question)
    });
    Ok(([(CONTENT_TYPE, "application/octet-stream")], bytes.await?).into_response())
}

fn content(
    system: &dyn AnySystem,
    asked: &Asked,
    file: &str,
    question: &Question,
) -> Result<Vec<u8>, Refusal> {
    if file == SESSION {
        let session = report::Session {
            title: system.title(),
            command: &asked.command(),
            answer: &asked.answer,
            window_s: question.window,
        };
        return Ok(session.page().into_bytes());
    }
    let (name, ending) = file.rsplit_once('.').unwrap_or((file, ""));
    let output = system.outputs().iter().find(|output| output.name == name);
    if let Some(output) = output.filter(|output| output.endings.contains(&ending)) {
        return written(file, |path| {
            asked.write(&Wanted { tables: vec![(output.name, path)], mcap: None })
        });
    }
    if file == STREAMS {
        return written(file, |path| asked.write(&Wanted { tables: vec![], mcap: Some(path) }));
    }
    let figure = name
        .strip_prefix("figure-")
        .and_then(|id| asked.answer.figures.iter().find(|figure| figure.id == id));
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

/// What is written to a file of that name.
fn written(
    name: &str,
    write: impl FnOnce(std::path::PathBuf) -> Result<(), Refusal>,
) -> Result<Vec<u8>, Refusal> {
    let folder = tempfile::tempdir().map_err(Refusal::of)?;
    let path = folder.path().join(name);
    write(path.clone())?;
    fs::read(path).map_err(Refusal::of)
}
