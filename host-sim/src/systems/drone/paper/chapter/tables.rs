//! Tables made from rows of the report.

use super::cells::{mean, whole};
use super::made;
use crate::report::{Comparison, Item, Value};
use crate::systems::drone::paper::report::{Report, Row};

/// A table with a row per cell, and the number of trials; `None` if there are no rows.
pub(super) fn of(
    report: &Report,
    table: &str,
    (id, title, note): (&str, &str, &str),
) -> Option<Item> {
    let rows: Vec<_> = report.rows.iter().filter(|row| row.table == table).collect();
    let mut comparison = Comparison::new(id, title).note(note);
    for cell in rows.chunk_by(|a, b| a.cell == b.cell) {
        let (published, limit) = (cell.iter().find_map(|row| row.published), cell[0].limit_m);
        let limit = limit.map_or_else(String::new, |limit| format!("{limit:.1}"));
        let of = |is_published: bool| {
            let rows = cell.iter().filter(|row| (row.filter == "published") == is_published);
            rows.map(|row| words(row)).collect::<Vec<_>>().join("; ")
        };
        comparison = comparison
            .beside(cell[0].cell.clone(), whole(published), of(true), of(false), limit)
            .values(cell.iter().flat_map(|row| values(row)));
    }
    let fewest = rows.iter().map(|row| row.trials).min()?;
    let most = rows.iter().map(|row| row.trials).max()?;
    let trials = if fewest == most {
        format!("{most} flights a cell")
    } else {
        format!("{fewest} to {most} flights a cell")
    };
    Some(made(report, trials).item(comparison))
}

/// The result of a filter in a cell, as text.
fn words(row: &Row) -> String {
    let energy = row.energy_j.filter(|_| row.lost_percent.is_some());
    let energy = energy.map_or_else(String::new, |joules| format!(" m, {:.0} kJ", joules / 1e3));
    let lost = row.lost_percent.map_or_else(String::new, |lost| format!(", {lost:.0} % lost"));
    let z = row.published_z.map_or_else(String::new, |z| format!(", z = {z:.1}"));
    format!("{}{energy}{lost}{z}", mean(row))
}

/// The numbers of a row, for other programs.
pub(super) fn values(row: &Row) -> Vec<Value> {
    let method = match row.filter {
        "published" => "published method",
        "best" => "default",
        other => other,
    };
    let of = |quantity: &str, unit| {
        Value::new(quantity, unit).under(format!("{}: {}", row.table, row.cell)).by(method)
    };
    // For the formulas of Fig. 3.4 the published number is the energy.
    let published = row.published.filter(|_| row.mean_m.is_some());
    let quantity = match row.table {
        table if table.contains("maximum") => "expected largest of 100 errors of the position",
        _ => "mean error of the position",
    };
    let error = of(quantity, "m").published(published).limited(row.limit_m);
    let error = error.is(row.mean_m).of(row.trials, row.se_m);
    let energy = of("energy of the flight", "J").is(row.energy_j);
    let energy = energy.published(row.published.filter(|_| row.mean_m.is_none()));
    let lost = of("lost flights", "%").is(row.lost_percent).of(row.trials, None);
    [error, energy, lost].into_iter().filter(|value| value.value.is_some()).collect()
}

/// The table of results that go beyond the thesis.
pub(super) fn beyond(report: &Report) -> Option<Item> {
    let words = (
        "drone-beyond",
        "Beyond the thesis: wild measurements, unknown levels, other ways to follow (mean error, m)",
        "The thesis names variable height, several users and the user's motion as future work.",
    );
    of(report, "beyond the thesis", words)
}
