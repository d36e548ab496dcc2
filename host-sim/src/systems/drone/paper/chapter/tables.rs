//! Rows of the report as tables.

use super::cells::{mean, whole};
use super::made;
use crate::report::{Comparison, Item};
use crate::systems::drone::paper::report::{Report, Row};

/// The table of some rows, one row a cell, and how many trials it is of; none without rows.
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
        comparison = comparison.row(cell[0].cell.clone(), whole(published), words(cell), limit);
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

/// What both filters make of a cell.
fn words(cell: &[&Row]) -> String {
    let one = |row: &&Row| {
        let energy = row.energy_j.filter(|_| row.lost_percent.is_some());
        let energy =
            energy.map_or_else(String::new, |joules| format!(" m, {:.0} kJ", joules / 1e3));
        let lost = row.lost_percent.map_or_else(String::new, |lost| format!(", {lost:.0} % lost"));
        let words = format!("{}{energy}{lost}", mean(row));
        if row.filter == "published" {
            let z = row.published_z.map_or_else(String::new, |z| format!(", z = {z:.1}"));
            return format!("thesis' filter: {words}{z}");
        }
        words
    };
    // Ours first.
    cell.iter().rev().map(one).collect::<Vec<_>>().join("; ")
}

/// What no table of the thesis has.
pub(super) fn beyond(report: &Report) -> Option<Item> {
    let words = (
        "drone-beyond",
        "Beyond the thesis: wild measurements, unknown levels, other ways to follow (mean error, m)",
        "The thesis names variable height, several users and the user's motion as future work.",
    );
    of(report, "beyond the thesis", words)
}
