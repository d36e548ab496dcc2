//! Comparisons as a table of all their rows.

use std::path::Path;

use super::{Chapter, Row};
use crate::{Error, output};

/// Writes `system,table,quantity,published,ours,limit`: all rows of all comparisons but the summaries, which are
/// among them.
///
/// # Errors
/// [`Error::Write`].
pub fn write(path: &Path, chapters: &[Chapter]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["system", "table", "quantity", "published", "ours", "limit"])?;
        for chapter in chapters {
            for comparison in chapter.comparisons() {
                for Row { quantity, published, ours, limit } in &comparison.rows {
                    let cells = [quantity, published, ours, limit].map(String::as_str);
                    table.write_field(chapter.system)?;
                    table.write_field(&comparison.id)?;
                    table.write_record(cells)?;
                }
            }
        }
        table.flush()
    })
}

#[cfg(test)]
mod tests {
    use super::super::{Comparison, Made};
    use super::*;

    #[test]
    fn every_row_of_every_comparison_is_there() -> Result<(), Box<dyn std::error::Error>> {
        let made = Made { command: String::new(), seed: 0, trials: String::new() };
        let table = |id: &str| Comparison::new(id, "T").row("error, cm", "2.6", "1.9", "");
        let chapter = Chapter {
            system: "vehicle",
            title: "",
            paper: "",
            about: String::new(),
            summary: table("summary"),
            items: vec![made.item(table("vehicle-table-1")), made.item(table("vehicle-table-2"))],
            streams: Vec::new(),
        };
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("comparisons.csv");
        write(&path, &[chapter])?;
        let expected = "system,table,quantity,published,ours,limit\n\
                        vehicle,vehicle-table-1,\"error, cm\",2.6,1.9,\n\
                        vehicle,vehicle-table-2,\"error, cm\",2.6,1.9,\n";
        assert_eq!(std::fs::read_to_string(path)?, expected);
        Ok(())
    }
}
