//! The few most important numbers.

use super::cells::{mean, whole};
use crate::report::{Comparison, Headline};
use crate::systems::drone::paper::report::{Report, Row};

/// Cells of Table 3.2 and Fig. 3.2: the table, the name, and the description for people.
const CELLS: [(&str, &str, &str); 5] = [
    ("Table 3.2", "L=1000 T=12 h=500 r=2000/3", "stays: h = 500 m, L = 1000"),
    ("Table 3.2", "L=1000 T=12 h=200 r=2000/3", "stays: h = 200 m, L = 1000"),
    ("Table 3.2", "L=100 T=12 h=800 r=2000/3", "stays: h = 800 m, L = 100"),
    ("Fig. 3.2", "systematic T=20", "stays: h = 800 m, 20 measurements"),
    ("Fig. 3.5", "grid T=25, once at h=800", "stays: h = 800 m, grid of 25"),
];
/// Policies of following, and their descriptions for people.
const WALKS: [(&str, &str); 3] = [
    ("walks: thesis: hovering over the estimate", "walks: drone hovers over the estimate (thesis)"),
    ("walks: orbit, velocity marginalised", "walks: drone circles the estimate"),
    ("walks: the same, 100 to 1000 m high", "walks: the same, 100 to 1000 m high"),
];

/// Means with standard errors; of a report of a single cell, its rows.
pub(super) fn summary(report: &Report) -> Comparison {
    let mut table = Comparison::new("drone-summary", "Drone: mean distance from the user, m");
    for (source, name, words) in CELLS {
        let of = |filter: &str| {
            let mut rows = report.rows.iter();
            rows.find(|row| row.table == source && row.cell == name && row.filter == filter)
        };
        let (Some(paper), Some(best)) = (of("published"), of("best")) else { continue };
        let limit = best.limit_m.map_or_else(String::new, |limit| format!("{limit:.1}"));
        let quantity = format!("{words} ({source})");
        table = table.beside(quantity, whole(paper.published), mean(paper), mean(best), limit);
    }
    for (name, words) in WALKS {
        if let Some(row) = report.rows.iter().find(|row| row.cell == name) {
            table = add(table, row, words, String::new(), walked(row), String::new());
        }
    }
    if table.rows.is_empty() {
        for row in &report.rows {
            let limit = row.limit_m.map_or_else(String::new, |limit| format!("{limit:.1}"));
            let (cell, published) = (row.cell.clone(), whole(row.published));
            table = add(table, row, &cell, published, mean(row), limit);
        }
    }
    let worst = report.rows.iter().filter_map(|row| row.published_z);
    let worst = worst.map(f64::abs).fold(0.0, f64::max);
    table.note(format!(
        "± is a standard error. A published number is a mean (or the maximum) of 100 trials: none but those of \
         Figs 3.5 and 3.1 (c), made in another way, should be far from the thesis' filter here; the farthest \
         of all is {worst:.1} of its own standard errors off."
    ))
}

/// Adds a row of the thesis' filter or of ours.
fn add(
    table: Comparison,
    row: &Row,
    quantity: &str,
    published: String,
    here: String,
    limit: String,
) -> Comparison {
    match row.filter {
        "published" => table.repeated(quantity, published, here, limit),
        _ => table.row(quantity, published, here, limit),
    }
}

/// The headlines of the first page: a stationary user and a walking one.
pub(super) fn headlines(report: &Report) -> Vec<Headline> {
    let find = |is: &dyn Fn(&Row) -> bool| report.rows.iter().find(|row| is(row));
    let (source, cell, words) = CELLS[0];
    let staying =
        |filter: &str| find(&|row| row.table == source && row.cell == cell && row.filter == filter);
    let [hovering, circling] = [0, 1].map(|i| find(&|row| row.cell == WALKS[i].0));
    let line = |quantity: String, theirs: Option<&Row>, ours: Option<&Row>| Headline {
        quantity,
        unit: "m",
        published: theirs.and_then(|row| row.published),
        theirs: theirs.and_then(|row| row.mean_m),
        ours: ours.and_then(|row| row.mean_m),
        limit: ours.and_then(|row| row.limit_m),
    };
    let lines = [
        line(
            format!("mean error of a user's place, {words}"),
            staying("published"),
            staying("best"),
        ),
        line("mean error of a user's place, walks on a circle".to_owned(), hovering, circling),
    ];
    lines.into_iter().filter(|line| line.ours.is_some()).collect()
}

fn walked(row: &Row) -> String {
    let kilojoules = row.energy_j.unwrap_or_default() / 1e3;
    let lost = row.lost_percent.unwrap_or_default();
    format!("{}, {lost:.0} % lost, {kilojoules:.0} kJ", mean(row))
}
