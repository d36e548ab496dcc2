//! Files dropped on the page, whose system is recognised.

use std::path::PathBuf;
use std::sync::Arc;

use axum::extract::{Multipart, Path as InPath, State};
use axum::response::Response;
use serde_json::json;
use tempfile::TempDir;

use super::api::{Refusal, beside, open_kept, reply};
use super::uploads::{self, Content};
use super::{Shared, zipped};
use crate::system::{AnySystem, Files, Recognised};
use crate::text::file_name;

/// The maximum number of files: a folder with more is not one of recordings.
const MOST_FILES: usize = 500;

/// Opens the recording that the files form, as one of the `preferred` system if several could read them.
pub(super) async fn open(
    State(shared): State<Arc<Shared>>,
    InPath(preferred): InPath<String>,
    mut upload: Multipart,
) -> Result<Response, Refusal> {
    let Some(uploads) = &shared.uploads else {
        return Err(Refusal::of("no files are opened here"));
    };
    let (_turn, folder) = uploads.begin()?;
    let (mut paths, mut content) = (Vec::new(), Content::default());
    while let Some(part) = upload.next_field().await.map_err(Refusal::of)? {
        if paths.len() == MOST_FILES {
            return Err(Refusal::of(format!("expected at most {MOST_FILES} files, found more")));
        }
        let within = paths.len().to_string();
        paths.push(uploads::write(folder.path(), &within, part, &mut content).await?);
    }
    let systems = shared.systems;
    let (recognised, folder) =
        beside(move || Ok((recognised(systems, &preferred, paths, &folder)?, folder))).await?;
    let Recognised { system, files, taken, left, others } = recognised;
    let mut opened = open_kept(&shared, system, files, folder, content).await?;
    let taken = taken.iter().map(|(path, field)| (file_name(path), field.name));
    opened["taken"] = json!(taken.collect::<Vec<_>>());
    opened["left"] = json!(left.iter().map(|path| file_name(path)).collect::<Vec<_>>());
    opened["others"] = json!(others);
    Ok(reply(&opened))
}

/// Recognises the system of the files. The contents of a zip file count as dropped, unless the zip file is a log
/// itself.
fn recognised(
    systems: &[&'static dyn AnySystem],
    preferred: &str,
    paths: Vec<PathBuf>,
    folder: &TempDir,
) -> Result<Recognised, Refusal> {
    let of = |paths: &[PathBuf]| {
        let found = Recognised::of(systems, preferred, paths, &Files::default());
        found.map_err(|error| error.naming_files_below(folder.path()))
    };
    if !paths.iter().any(|path| zipped::is_zip(path)) {
        return Ok(of(&paths)?);
    }
    if let Ok(found) = of(&paths)
        && !found.left.iter().any(|path| zipped::is_zip(path))
    {
        return Ok(found);
    }
    let mut all = Vec::new();
    for path in paths {
        if zipped::is_zip(&path) {
            all.extend(zipped::unpack(&path, folder.path()).map_err(Refusal::of)?);
        } else {
            all.push(path);
        }
    }
    Ok(of(&all)?)
}
