//! Rows of published and own numbers, and their presentation.

use std::fmt;

use comfy_table::Table;
use serde::Serialize;

use crate::metrics::{mean, percentile, rms, standard_deviation};
use crate::output;
use crate::system::ScalarKind;

/// The number of trials behind each of the thesis' numbers, which is their mean or maximum.
const PUBLISHED_TRIALS: f64 = 100.0;

/// The minimum number of trials for a comparison with published numbers.
const FEW: usize = 40;

/// The results of one filter in a cell of a table.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Row {
    /// The table or figure of the thesis, or a name for what goes beyond it.
    pub table: &'static str,
    /// The name of the cell.
    pub cell: String,
    /// The filter: `published`, `best`, or a description.
    pub filter: &'static str,
    /// The number of trials.
    pub trials: usize,
    /// The thesis' number in m (J in Fig. 3.4); the plots of the moving user are lost and give none.
    pub published: Option<f64>,
    /// The difference between the published number and ours, in standard errors of the published one.
    pub published_z: Option<f64>,
    /// The mean error (m).
    pub mean_m: Option<f64>,
    /// The standard error of the mean (m).
    pub se_m: Option<f64>,
    /// The root mean square error (m).
    pub rmse_m: Option<f64>,
    /// The largest error (m); for a moving user that of a flight, not of a step.
    pub max_m: Option<f64>,
    /// The mean error of the exact posterior's mean on the same measurements (m).
    pub limit_m: Option<f64>,
    /// The energy of the flight by the published formulas (J).
    pub energy_j: Option<f64>,
    /// The share of trials with a mean error of 300 m or more (%).
    pub lost_percent: Option<f64>,
    /// The share of trials in which the 90 % region contained the user (%).
    pub credible_percent: Option<f64>,
    /// A remark.
    pub note: Option<String>,
}

impl Row {
    /// The statistics of a sample of errors (m).
    pub fn of(errors: &[f64]) -> Self {
        let deviation = standard_deviation(errors);
        Self {
            trials: errors.len(),
            mean_m: Some(mean(errors)),
            se_m: (errors.len() > 1).then(|| deviation / (errors.len() as f64).sqrt()),
            rmse_m: Some(rms(errors)),
            max_m: Some(errors.iter().copied().fold(0.0, f64::max)),
            ..Self::default()
        }
    }

    /// Compares with the published mean of a hundred such errors.
    pub fn beside(self, published: Option<f64>, errors: &[f64]) -> Self {
        let error = standard_deviation(errors) / PUBLISHED_TRIALS.sqrt();
        let published_z = published
            .zip(self.mean_m)
            .filter(|_| errors.len() >= FEW)
            .map(|(published, mean)| (published - mean) / error);
        Self { published, published_z, ..self }
    }

    /// The expected maximum of a hundred such errors beside the published one, with its standard deviation.
    ///
    /// The maximum of hundreds of errors says little about that of the next hundred. So the tail above the 95th
    /// percentile is modelled as exponential, with the mean excess over it; the maximum then follows a Gumbel
    /// distribution.
    pub fn of_maximum(errors: &[f64], published: f64) -> Self {
        const TAIL: f64 = 0.05;
        const EULER: f64 = 0.577_215_664_901_532_9;
        let threshold = percentile(errors, 100.0 * (1.0 - TAIL));
        let excess: Vec<f64> = errors
            .iter()
            .filter(|&&error| error > threshold)
            .map(|error| error - threshold)
            .collect();
        let scale = mean(&excess);
        let expected = threshold + scale * ((TAIL * PUBLISHED_TRIALS).ln() + EULER);
        let deviation = scale * std::f64::consts::PI / 6.0_f64.sqrt();
        // The relative standard error of the scale is 1/√exceedances.
        let own = scale * 2.2 / (excess.len().max(1) as f64).sqrt();
        Self {
            trials: errors.len(),
            mean_m: Some(expected),
            se_m: Some(own),
            max_m: Some(errors.iter().copied().fold(0.0, f64::max)),
            published: Some(published),
            published_z: (errors.len() >= FEW).then(|| (published - expected) / deviation),
            ..Self::default()
        }
    }
}

/// The report that the command prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Always `drone`.
    pub system: &'static str,
    /// Seed of all randomness.
    pub seed: u64,
    /// The number type of the filters.
    pub scalar: ScalarKind,
    /// The number of measurements that a filter refused because no particle explained them: lost by degeneracy.
    pub refused: u32,
    /// The rows of all cells.
    pub rows: Vec<Row>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, refused, .. } = self;
        writeln!(
            f,
            "drone: mean distance from the user, m ± standard error; z: published less ours in standard \
             errors\nof 100 trials; limit: mean of the exact posterior; lost: flights with a mean error of 300 m and more;\nseed {seed}; {refused} measurements refused as impossible"
        )?;
        for rows in self.rows.chunk_by(|a, b| a.table == b.table) {
            writeln!(f, "{}", shown(rows))?;
        }
        Ok(())
    }
}

/// A table of rows, in which those of one cell are adjacent.
fn shown(rows: &[Row]) -> Table {
    let mut table = output::table();
    let title = rows.first().map_or("", |row| row.table);
    table.set_header([
        title,
        "published",
        "z",
        "filter",
        "ours",
        "trials",
        "limit",
        "energy",
        "lost",
        "",
    ]);
    let mut before = "";
    for row in rows {
        let cell = if row.cell == before { "" } else { row.cell.as_str() };
        before = &row.cell;
        let number = |value: Option<f64>, digits: usize, unit: &str| {
            value.map_or(String::new(), |value| format!("{value:.digits$}{unit}"))
        };
        let energies = row.mean_m.is_none();
        let published = if energies {
            number(row.published.map(|joules| joules / 1e3), 0, " kJ")
        } else {
            number(row.published, 0, "")
        };
        let ours = match (row.mean_m, row.se_m) {
            (Some(mean), Some(error)) => format!("{mean:.1} ± {error:.1}"),
            _ => String::new(),
        };
        table.add_row([
            cell.to_owned(),
            published,
            number(row.published_z, 1, ""),
            row.filter.to_owned(),
            ours,
            if energies { String::new() } else { row.trials.to_string() },
            number(row.limit_m, 1, ""),
            number(row.energy_j.map(|joules| joules / 1e3), 0, " kJ"),
            number(row.lost_percent, 0, " %"),
            row.note.clone().unwrap_or_default(),
        ]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_summarises_its_errors() {
        let errors = [1.0, 2.0, 3.0, 6.0].repeat(10);
        let row = Row::of(&errors).beside(Some(4.0), &errors);
        assert_eq!((row.mean_m, row.max_m), (Some(3.0), Some(6.0)));
        let deviation = (140.0_f64 / 39.0).sqrt();
        assert!((row.se_m.unwrap() - deviation / 40.0_f64.sqrt()).abs() < 1e-12);
        assert!((row.published_z.unwrap() - 10.0 / deviation).abs() < 1e-12);
    }

    #[test]
    fn the_maximum_of_many_is_that_of_the_last_percent() {
        let errors: Vec<f64> = (0..10_000).map(|k| f64::from(k) / 1e4).collect();
        // −ln of a uniform number is exponentially distributed: the expected maximum of 100 is the harmonic sum.
        let errors: Vec<f64> = errors.iter().map(|u| -(u + 5e-5).ln()).collect();
        let row = Row::of_maximum(&errors, 5.187 + 1.28);
        assert!((row.mean_m.unwrap() - 5.187).abs() < 0.05, "{row:?}");
        assert!((row.published_z.unwrap() - 1.0).abs() < 0.1);
    }
}
