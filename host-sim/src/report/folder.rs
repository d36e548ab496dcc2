//! The report as a folder: a page, and beside it all data in forms that other programs read.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::{Chapter, csv, page};
use crate::figure::svg;
use crate::{Error, figure, mcap, output};

/// Writes the page, `results.csv`, `results.json`, every figure as SVG and CSV, and each system's streams as MCAP, and
/// returns the path of the page.
///
/// # Errors
/// [`Error::Write`].
pub fn write(folder: &Path, chapters: &[Chapter]) -> Result<PathBuf, Error> {
    fs::create_dir_all(folder)
        .map_err(|source| Error::Write { path: folder.to_path_buf(), source })?;
    let text = |name: &str, text: String| {
        output::write_file(&folder.join(name), |file| file.write_all(text.as_bytes()))
    };
    for chapter in chapters {
        for drawn in chapter.figures() {
            text(&format!("{}.svg", drawn.id), svg::draw(drawn))?;
            output::write_file(&folder.join(format!("{}.csv", drawn.id)), |file| {
                figure::csv::write(file, drawn)
            })?;
        }
        mcap::write(&folder.join(format!("{}.mcap", chapter.system)), &chapter.streams)?;
    }
    csv::write(&folder.join("results.csv"), chapters)?;
    text("results.json", results(chapters).to_string())?;
    text("index.html", page::render(chapters))?;
    Ok(folder.join("index.html"))
}

/// All tables, each with how it was made.
fn results(chapters: &[Chapter]) -> serde_json::Value {
    let system = |chapter: &Chapter| {
        let tables = chapter.tables().map(|(table, made)| json!({ "table": table, "made": made }));
        json!({
            "system": chapter.system,
            "paper": chapter.paper,
            "headlines": chapter.headlines,
            "summary": chapter.summary,
            "tables": tables.collect::<Vec<_>>(),
            "recorded": chapter.recorded,
        })
    };
    json!(chapters.iter().map(system).collect::<Vec<_>>())
}
