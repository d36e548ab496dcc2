//! Figures and tables of a stationary user: Figs 3.1 to 3.5, Table 3.2.

use super::cells::Cells;
use super::{made, tables};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::report::{Comparison, Item};
use crate::systems::drone::paper::report::Report;
use crate::systems::drone::settings::choices::ResamplerKind;
use crate::systems::drone::simulate::trajectory::Trajectory;

/// The items in the thesis' order.
pub(super) fn items(report: &Report) -> Vec<Item> {
    let mut items = paths(report);
    items.extend(tables::of(report, "Table 3.2", (
        "drone-table-3-2",
        "Table 3.2: mean error, m",
        "z: published less ours in standard errors of 100 trials, of the thesis' own filter. Ours has 500 \
         points, or as many as L where that is less.",
    )));
    items.extend(sweeps(report));
    items.extend(resamplers(report));
    items.extend(energy(report));
    items.extend(trajectories(report));
    items.extend(tables::of(report, "Fig. 3.1 c", (
        "drone-equal-energy",
        "Fig. 3.1 (c), T = 16 with the same energy: circle and small grid, mean error, m",
        "One measurement a point at h = 800 m. With one, nobody can come as close as is published.",
    )));
    items
}

/// Fig. 3.1: the measurement positions of the drone.
fn paths(report: &Report) -> Vec<Item> {
    if report.rows.iter().all(|row| row.table != "Table 3.2") {
        return Vec::new();
    }
    let path = |name: &str, trajectory: Trajectory, colour| {
        Series::path(name, trajectory.points(9)).marked(Mark::LineAndPoints).coloured(colour)
    };
    let figure = Figure::new("drone-fig-3-1", "Fig. 3.1, paths of the drone for T = 9")
        .axes("x, m", "y, m")
        .map()
        .caption("The user is anywhere in the square; the small grid is as long as the circle.")
        .with(
            Series::path("square", [[0.0, 0.0], [2e3, 0.0], [2e3, 2e3], [0.0, 2e3], [0.0, 0.0]])
                .coloured(Colour::Truth),
        )
        .with(path("(a) grid", Trajectory::grid(9), Colour::Other(0)))
        .with(path("(b) circle", Trajectory::CIRCLE, Colour::Other(1)))
        .with(path("(c) small grid", Trajectory::small_grid(9), Colour::Other(2)));
    vec![made(report, "none: nothing is random").item(figure)]
}

/// A figure of a sweep: published values, both filters and the limit; `None` if the report has no such cells.
fn sweep(
    report: &Report,
    (table, named, key): (&str, &[&str], &str),
    (id, title, label): (&str, &str, &str),
    caption: &str,
) -> Option<Item> {
    let paper = Cells { table, filter: "published", named, key };
    let best = Cells { filter: "best", ..paper };
    let published = paper.published(report, "published", Colour::Published);
    if published.x.is_empty() {
        return None;
    }
    let figure = Figure::new(id, title)
        .axes(label, "mean error, m")
        .caption(caption)
        .with(published)
        .with(paper.line(report, "the thesis' filter", Colour::Other(3)))
        .with(best.limit(report))
        .with(best.line(report, "ours", Colour::Ours));
    Some(made(report, "as in the table above").item(figure))
}

fn sweeps(report: &Report) -> impl Iterator<Item = Item> {
    const ALIKE: &str = "Published means scatter by their own errors about the thesis' filter; ours lies on the limit.";
    let radius = sweep(
        report,
        ("Table 3.2", &["h=500"], "r=2000/"),
        ("drone-table-3-2-radius", "Table 3.2 over the circle", "2000 m / radius of the circle"),
        ALIKE,
    );
    let height = sweep(
        report,
        ("Table 3.2", &["L=1000", "r=2000/3"], "h="),
        ("drone-table-3-2-height", "Table 3.2 over the height", "height of the drone, m"),
        ALIKE,
    );
    let particles = sweep(
        report,
        ("Table 3.2", &["h=800"], "L="),
        ("drone-table-3-2-particles", "Table 3.2 over the particles", "particles L"),
        "A lattice of 100 points is where the limit is; a cloud of 3000 is not.",
    );
    [radius, height, particles].into_iter().flatten()
}

/// Figs 3.2 and 3.3: the resamplers.
fn resamplers(report: &Report) -> Vec<Item> {
    let mut items = Vec::new();
    items.extend(sweep(
        report,
        ("Fig. 3.2", &["systematic"], "T="),
        ("drone-fig-3-2-systematic", "Fig. 3.2, systematic resampling", "measurements T"),
        "The cloud keeps its distance from the limit, because its jitter never shrinks.",
    ));
    for (table, id, title, label) in [
        ("Fig. 3.2", "drone-fig-3-2", "Fig. 3.2, mean error of four resamplers", "mean error, m"),
        (
            "Fig. 3.3 (maximum)",
            "drone-fig-3-3",
            "Fig. 3.3, largest of 100 errors of four resamplers",
            "largest of 100 errors, m",
        ),
    ] {
        let mut figure = Figure::new(id, title).axes("measurements T", label).caption(
            "Broken: published. The four do not differ by more than their standard errors.",
        );
        for (number, kind) in ResamplerKind::OF_THE_THESIS.into_iter().enumerate() {
            let name = format!("{kind:?}").to_lowercase();
            let named = [name.as_str()];
            let cells = Cells { table, filter: "published", named: &named, key: "T=" };
            let (published, colour) = (format!("{name}, published"), Colour::Other(number));
            figure = figure
                .with(cells.published(report, &published, colour))
                .with(cells.line(report, &name, colour));
        }
        if figure.series.iter().any(|series| !series.x.is_empty()) {
            items.push(made(report, "as in the table below").item(figure));
        }
        let table_id = format!("{id}-table");
        let note = if table == "Fig. 3.2" {
            ""
        } else {
            "Ours: the expected maximum of 100 such errors, by the law of the tail of all of them."
        };
        items.extend(tables::of(report, table, (&table_id, title, note)));
    }
    items
}

/// Fig. 3.4: the energy.
fn energy(report: &Report) -> Vec<Item> {
    let table = "Fig. 3.4 (energy)";
    let rows: Vec<_> = report.rows.iter().filter(|row| row.table == table).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let once = made(report, "none: nothing is random");
    let mut figure = Figure::new("drone-fig-3-4", "Fig. 3.4, energy of grid and circle")
        .axes("measurements T", "energy, kJ")
        .caption("Broken: published, which the printed constants do not give.");
    for (name, colour) in [("grid", Colour::Other(0)), ("circle", Colour::Other(1))] {
        let named = [name];
        let cells = Cells { table, filter: "formulas", named: &named, key: "T=" };
        let kilojoules = |joules: Option<f64>| joules.map(|joules| joules / 1e3);
        let published = cells.points(report, |row| kilojoules(row.published));
        let ours = cells.points(report, |row| kilojoules(row.energy_j));
        figure = figure
            .with(
                Series::path(format!("{name}, published"), published)
                    .marked(Mark::Dashes)
                    .coloured(colour),
            )
            .with(
                Series::path(format!("{name}, by the formulas"), ours)
                    .marked(Mark::LineAndPoints)
                    .coloured(colour),
            );
    }
    let mut comparison = Comparison::new("drone-fig-3-4-table", "Fig. 3.4: energy, kJ").note(
        "Here: as eqs 2.12 to 2.17 and the printed constants say. The published ones come out of three other \
         numbers, which are printed nowhere.",
    );
    for row in rows {
        let kilojoules =
            |joules: Option<f64>| joules.map_or_else(String::new, |j| format!("{:.1}", j / 1e3));
        let refitted = row.note.clone().unwrap_or_default();
        let here = format!("{} ({refitted})", kilojoules(row.energy_j));
        comparison = comparison
            .repeated(row.cell.clone(), kilojoules(row.published), here, "")
            .values(tables::values(row));
    }
    vec![once.item(figure), once.item(comparison)]
}

/// Fig. 3.5: the trajectories.
fn trajectories(report: &Report) -> Vec<Item> {
    let table = "Fig. 3.5";
    let mut figure = Figure::new("drone-fig-3-5", "Fig. 3.5, mean error of grid and circle")
        .axes("measurements T", "mean error, m")
        .caption(
            "What is published for T = 16 and 25 lies below the limit of one measurement a point; three a \
             point from 450 m come closest.",
        );
    for (name, colour) in [("grid", Colour::Other(0)), ("circle", Colour::Other(1))] {
        let once = [name, "once"];
        let cells = Cells { table, filter: "best", named: &once, key: "T=" };
        let thrice = [name, "3 times"];
        let more = Cells { named: &thrice, ..cells };
        let paper = Cells { filter: "published", ..cells };
        figure = figure
            .with(paper.published(report, &format!("{name}, published"), colour))
            .with(cells.line(report, &format!("{name}, ours, once at 800 m"), colour))
            .with(more.line(report, &format!("{name}, ours, 3 times at 450 m"), colour).hidden());
    }
    let Some(item) = tables::of(
        report,
        table,
        (
            "drone-fig-3-5-table",
            "Fig. 3.5: mean error of grid and circle, m",
            "49 and 39 m are published where the exact posterior of one measurement a point is worse: more than \
         one must have been made.",
        ),
    ) else {
        return Vec::new();
    };
    vec![made(report, "as in the table below").item(figure), item]
}
