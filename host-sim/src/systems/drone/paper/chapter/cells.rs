//! Cells of the report as points of figures and as text.

use crate::figure::{Colour, Mark, Series};
use crate::systems::drone::paper::report::{Report, Row};

/// A selection of rows of the report: of one table and one filter, whose cell names contain all of the given words.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells<'a> {
    /// The table or figure.
    pub(super) table: &'a str,
    /// The filter: `published` or `best`.
    pub(super) filter: &'a str,
    /// The words that the cell names contain.
    pub(super) named: &'a [&'a str],
    /// The text that precedes the abscissa in the cell names.
    pub(super) key: &'a str,
}

impl Cells<'_> {
    /// Values of the rows over the number that follows the key.
    pub(super) fn points(
        &self,
        report: &Report,
        value: impl Fn(&Row) -> Option<f64>,
    ) -> Vec<[f64; 2]> {
        let mut points: Vec<_> =
            self.rows(report).filter_map(|(abscissa, row)| Some([abscissa, value(row)?])).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points
    }

    /// A line through the means, with their standard errors.
    pub(super) fn line(&self, report: &Report, name: &str, colour: Colour) -> Series {
        let errors = self.points(report, |row| row.mean_m.map(|_| row.se_m.unwrap_or(f64::NAN)));
        Series::path(name, self.points(report, |row| row.mean_m))
            .marked(Mark::LineAndPoints)
            .coloured(colour)
            .with_error(errors.into_iter().map(|[_, error]| error).collect())
    }

    /// A dashed line through the published values.
    pub(super) fn published(&self, report: &Report, name: &str, colour: Colour) -> Series {
        let points = self.points(report, |row| row.published);
        Series::path(name, points).marked(Mark::Dashes).coloured(colour)
    }

    /// A dashed line through the limits.
    pub(super) fn limit(&self, report: &Report) -> Series {
        let points = self.points(report, |row| row.limit_m);
        Series::path("limit", points).marked(Mark::Dashes).coloured(Colour::Limit)
    }

    fn rows<'r>(&self, report: &'r Report) -> impl Iterator<Item = (f64, &'r Row)> {
        report.rows.iter().filter_map(|row| {
            let ours = row.table == self.table && row.filter == self.filter;
            let named = self.named.iter().all(|word| row.cell.contains(word));
            let rest = row.cell.split_once(self.key).filter(|_| ours && named)?.1;
            let number: String =
                rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
            Some((number.parse().ok()?, row))
        })
    }
}

/// A mean with its standard error, as text.
pub(super) fn mean(row: &Row) -> String {
    match (row.mean_m, row.se_m) {
        (Some(mean), Some(error)) => format!("{mean:.1} ± {error:.1}"),
        (Some(mean), None) => format!("{mean:.1}"),
        _ => String::new(),
    }
}

/// A number without decimals; empty if there is none.
pub(super) fn whole(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:.0}"))
}
