//! The report of the experiment.

use std::fmt;

use comfy_table::Table;
use serde::Serialize;

use crate::metrics::mean;
use crate::output;
use crate::system::ScalarKind;
use crate::systems::gnss::paper::published::PppErrors;
use crate::systems::gnss::simulate::trial::Score;

/// A filter's errors.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The table of the paper, or a name for what goes beyond it.
    pub table: &'static str,
    /// The name of the filter.
    pub filter: &'static str,
    /// The errors published in the paper.
    pub published: Option<PppErrors>,
    /// The means over the station-days; that of the convergence time is over those that converged.
    pub ours: PppErrors,
    /// The largest RMS error of a station-day (mm).
    pub worst_rms_mm: f64,
    /// The number of station-days whose solution did not converge.
    pub unconverged: usize,
    /// The number of epochs without a solution, over all station-days.
    pub unsolved: usize,
    /// The scores of each station-day.
    pub days: Vec<Score>,
}

impl Row {
    /// The means of the station-days.
    pub fn of(
        table: &'static str,
        filter: &'static str,
        published: Option<PppErrors>,
        days: Vec<Score>,
    ) -> Self {
        let means = |of: fn(&Score) -> [f64; 4]| {
            [0, 1, 2, 3].map(|part| mean(&days.iter().map(|day| of(day)[part]).collect::<Vec<_>>()))
        };
        let converged: Vec<_> = days.iter().filter_map(|day| day.convergence_min).collect();
        let ours = PppErrors {
            final_mm: means(|day| day.final_mm),
            rms_mm: means(|day| day.rms_mm),
            convergence_min: (!converged.is_empty()).then(|| mean(&converged)),
        };
        Self {
            table,
            filter,
            published,
            ours,
            worst_rms_mm: days.iter().map(|day| day.rms_mm[3]).fold(0.0, f64::max),
            unconverged: days.len() - converged.len(),
            unsolved: days.iter().map(|day| day.unsolved).sum(),
            days,
        }
    }
}

impl Row {
    /// The minutes until convergence as text, with the numbers of days that did not converge and of epochs without a
    /// solution.
    pub(in crate::systems::gnss::paper) fn converged(&self) -> String {
        let mean = self.ours.convergence_min.map_or("never".to_owned(), |it| format!("{it:.1}"));
        let never = match self.unconverged {
            0 => String::new(),
            count if count == self.days.len() => String::new(),
            count => format!(", {count} never"),
        };
        let unsolved = match self.unsolved {
            0 => String::new(),
            count => format!(", {count} epochs unsolved"),
        };
        mean + &never + &unsolved
    }

    /// Whether the filter is taken as published.
    pub(in crate::systems::gnss::paper) fn is_published(&self) -> bool {
        self.filter.ends_with("as published")
    }
}

/// The results of all filters on the same station-days.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Always `gnss`.
    pub system: &'static str,
    /// Seed of all randomness.
    pub seed: u64,
    /// The number type of the filters.
    pub scalar: ScalarKind,
    /// The number of station-days.
    pub trials: usize,
    /// The variance rate of each coordinate in kinematic filters (m²/s).
    pub process_noise: f64,
    /// The rows of all filters.
    pub rows: Vec<Row>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seed, trials, process_noise, .. } = self;
        writeln!(
            f,
            "gnss: mean errors N E U 3-D of static and kinematic receivers that stand still, mm: at the end of the \
             day, and\nRMS after the first hour (in brackets: the worst day's); minutes until 3-D stays below 10 cm \
             for a quarter of an hour;\n{trials} synthetic station-days with faults (published: 100 real ones, whose \
             faults are not known), seed {seed};\nkinematic: {process_noise:e} m²/s a coordinate"
        )?;
        for rows in self.rows.chunk_by(|a, b| a.table == b.table) {
            writeln!(f, "{}", shown(rows))?;
        }
        Ok(())
    }
}

fn shown(rows: &[Row]) -> Table {
    let mut table = output::table();
    let title = rows.first().map_or("", |row| row.table);
    let compared = rows.iter().any(|row| row.published.is_some());
    // If nothing was published there are no columns for it.
    let cells = |first: String, pairs: [[String; 2]; 3]| {
        let pairs = pairs.into_iter().flat_map(|[published, ours]| {
            compared.then_some(published).into_iter().chain(std::iter::once(ours))
        });
        std::iter::once(first).chain(pairs).collect::<Vec<_>>()
    };
    let names = ["error", "RMS", "converged"];
    table.set_header(cells(
        title.to_owned(),
        names.map(|name| {
            let ours = if compared { "ours" } else { name };
            [format!("{name}: published"), ours.to_owned()]
        }),
    ));
    for row in rows {
        let published =
            |of: fn(&PppErrors) -> String| row.published.as_ref().map_or(String::new(), of);
        let rms = format!("{} ({:.0})", four(row.ours.rms_mm), row.worst_rms_mm);
        let minutes =
            |it: &PppErrors| it.convergence_min.map_or(String::new(), |it| format!("{it:.1}"));
        let pairs = [
            [published(|it| four(it.final_mm)), four(row.ours.final_mm)],
            [published(|it| four(it.rms_mm)), rms],
            [published(minutes), row.converged()],
        ];
        table.add_row(cells(row.filter.to_owned(), pairs));
    }
    table
}

/// Values for north, east, up and 3-D, as text (mm).
pub(in crate::systems::gnss::paper) fn four(numbers: [f64; 4]) -> String {
    numbers.map(|number| format!("{number:.1}")).join(" ")
}
