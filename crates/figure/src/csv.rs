//! Figures as CSV tables of their points.

use std::io::{self, Write};

use crate::Figure;

/// Writes the columns `series,x,y,error`: one row per point, in drawing order. An empty cell means no value.
///
/// # Errors
/// Errors of the writer.
pub fn write(to: impl Write, figure: &Figure) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(to);
    table.write_record(["series", "x", "y", "error"])?;
    for series in &figure.series {
        for (index, (&x, &y)) in series.x.iter().zip(&series.y).enumerate() {
            let error = series.error.as_ref().and_then(|error| error.get(index));
            let cells = [x, y, error.copied().unwrap_or(f64::NAN)].map(cell);
            table.write_field(&series.name)?;
            table.write_record(cells)?;
        }
    }
    table.flush()
}

/// The shortest text that is read back as the same number; empty for `NaN`.
fn cell(number: f64) -> String {
    if number.is_nan() { String::new() } else { number.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Series;

    #[test]
    fn every_point_has_a_row_and_gaps_are_empty() -> io::Result<()> {
        let ours = Series::line("ours, f64", vec![0.0, 1.0], vec![f64::NAN, 1.0 / 3.0]);
        let marks = Series::points("anchors", [[2.5, -1e-9]]).with_error(vec![0.5]);
        let mut table = Vec::new();
        write(&mut table, &Figure::new("f", "F").with(ours).with(marks))?;
        let expected = "series,x,y,error\n\"ours, f64\",0,,\n\"ours, f64\",1,0.3333333333333333,\n\
                        anchors,2.5,-0.000000001,0.5\n";
        assert_eq!(String::from_utf8_lossy(&table), expected);
        Ok(())
    }
}
