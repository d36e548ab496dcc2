//! Writes figures of the report as files for the book.

use std::io;
use std::path::Path;

use host_sim::figure::{Figure, svg};
use host_sim::report::Chapter;

/// Draws figures of a chapter into the book's folder; `files` pairs their ids in the chapter with file names.
///
/// # Errors
/// If the chapter has no such figure, or a file cannot be written.
pub fn draw(chapter: &Chapter, files: &[(&str, &str)]) -> io::Result<()> {
    for (id, file) in files {
        let figure = chapter
            .figures()
            .find(|figure| figure.id == *id)
            .ok_or_else(|| io::Error::other(format!("the chapter has no figure {id}")))?;
        draw_as(file, figure)?;
    }
    Ok(())
}

/// Draws a figure into the book's folder, in a file named after its `id`.
///
/// # Errors
/// If the file cannot be written.
pub fn draw_figure(figure: &Figure) -> io::Result<()> {
    draw_as(&format!("{}.svg", figure.id), figure)
}

fn draw_as(file: &str, figure: &Figure) -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/figures");
    std::fs::write(folder.join(file), svg::draw(figure))
}
