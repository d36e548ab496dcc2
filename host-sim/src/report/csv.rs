//! The numbers of a report as a table.

use std::path::Path;

use super::{Chapter, Value};
use crate::{Error, output};

const HEADER: [&str; 12] = [
    "system",
    "table",
    "quantity",
    "condition",
    "method",
    "value",
    "unit",
    "standard_error",
    "n",
    "published",
    "limit",
    "command",
];

/// Writes all numbers of all comparisons, one per row; an unknown value is an empty field. A published number stands
/// beside the method that was published, and is repeated where several are compared with it.
///
/// # Errors
/// [`Error::Write`].
pub fn write(path: &Path, chapters: &[Chapter]) -> Result<(), Error> {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(HEADER)?;
        for chapter in chapters {
            for (id, it, command) in chapter.numbers() {
                let Value { quantity, condition, method, unit, .. } = it;
                let n = it.n.map_or_else(String::new, |n| n.to_string());
                let [value, error] = [it.value, it.standard_error].map(number);
                let [published, limit] = [it.published, it.limit].map(number);
                table.write_record([
                    chapter.system,
                    id,
                    quantity,
                    condition,
                    method,
                    &value,
                    unit,
                    &error,
                    &n,
                    &published,
                    &limit,
                    command,
                ])?;
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
    fn every_number_of_every_comparison_is_there() -> Result<(), Box<dyn std::error::Error>> {
        let made =
            Made { command: "host-sim run vehicle".to_owned(), seed: 0, trials: String::new() };
        let table = |id: &str| {
            let value = Value::new("error", "cm").under("at noon").is(1.9).of(7, 0.25);
            Comparison::new(id, "T")
                .row("error, cm", "2.6", "1.9", "")
                .values([value.clone().published(2.6), value.by("published filter").is(None)])
        };
        let chapter = Chapter {
            summary: table("summary"),
            items: vec![made.item(table("vehicle-table-1"))],
            ..Chapter::of("vehicle")
        };
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("comparisons.csv");
        write(&path, &[chapter])?;
        let expected = "system,table,quantity,condition,method,value,unit,standard_error,n,published,limit,command\n\
                        vehicle,vehicle-table-1,error,at noon,default,1.9,cm,0.25,7,2.6,,host-sim run vehicle\n\
                        vehicle,vehicle-table-1,error,at noon,published filter,,cm,0.25,7,,,host-sim run vehicle\n";
        assert_eq!(std::fs::read_to_string(path)?, expected);
        Ok(())
    }
}
