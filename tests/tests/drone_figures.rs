//! The book's figures of the drone, from one run of all its tables.
//!
//! `cargo test --release -p kestirim-tests --test drone_figures -- --ignored`

use std::error::Error;
use std::ops::Range;
use std::path::Path;

use host_sim::systems::drone::experiment;
use host_sim::systems::drone::options::Run;
use host_sim::systems::drone::report::{Report, Row};
use plotters::prelude::*;

/// A line of a figure: its name and points.
type Line<'a> = (&'a str, Vec<(f64, f64)>);

/// A figure: its file, what its axes show, and how far they reach.
struct Figure {
    file: &'static str,
    x: &'static str,
    y: &'static str,
    xs: Range<f64>,
    ys: Range<f64>,
}

impl Figure {
    fn draw(&self, lines: &[Line]) -> Result<(), Box<dyn Error>> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/figures");
        std::fs::create_dir_all(&folder)?;
        let path = folder.join(self.file);
        let root = SVGBackend::new(&path, (640, 360)).into_drawing_area();
        root.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&root)
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(50)
            .build_cartesian_2d(self.xs.clone(), self.ys.clone())?;
        chart.configure_mesh().x_desc(self.x).y_desc(self.y).light_line_style(WHITE).draw()?;
        for (number, (name, points)) in lines.iter().enumerate() {
            let colour = Palette99::pick(number).to_rgba();
            let inside = points.iter().copied().filter(|(_, y)| self.ys.contains(y));
            let inside: Vec<_> = inside.collect();
            chart
                .draw_series(LineSeries::new(inside.clone(), colour.stroke_width(2)))?
                .label(*name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
            chart
                .draw_series(inside.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
        }
        let background = WHITE.mix(0.8);
        chart.configure_series_labels().background_style(background).border_style(BLACK).draw()?;
        root.present()?;
        Ok(())
    }
}

/// Values over what stands behind `key` in the names of a table's cells.
fn line(
    report: &Report,
    (table, filter): (&str, &str),
    (named, key): (&[&str], &str),
    value: fn(&Row) -> Option<f64>,
) -> Vec<(f64, f64)> {
    let rows = report.rows.iter().filter(|row| row.table == table && row.filter == filter);
    let point = |row: &Row| {
        let rest = row.cell.split_once(key)?.1;
        let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
        Some((number.parse().ok()?, value(row)?))
    };
    let wanted = |row: &&Row| named.iter().all(|name| row.cell.contains(name));
    let mut points: Vec<(f64, f64)> = rows.filter(wanted).filter_map(point).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points
}

#[test]
#[ignore = "makes the book's figures"]
fn figures() -> Result<(), Box<dyn Error>> {
    let report = experiment::run(Run::default())?;
    let cells = |table, named: &[&str], key, xs, file, x, most| -> Result<(), Box<dyn Error>> {
        let of = |filter, value| line(&report, (table, filter), (named, key), value);
        Figure { file, x, y: "mean error, m", xs, ys: 0.0..most }.draw(&[
            ("published", of("paper", |row| row.published)),
            ("the thesis' filter", of("paper", |row| row.mean_m)),
            ("limit", of("best", |row| row.limit_m)),
            ("ours", of("best", |row| row.mean_m)),
        ])
    };
    cells(
        "Table 3.2",
        &["h=500"],
        "r=2000/",
        1.5..8.5,
        "drone-radius.svg",
        "2000 m / radius of the circle",
        350.0,
    )?;
    cells(
        "Table 3.2",
        &["L=1000", "r=2000/3"],
        "h=",
        100.0..1500.0,
        "drone-height.svg",
        "height of the drone, m",
        400.0,
    )?;
    cells(
        "Fig. 3.2",
        &["systematic"],
        "t=",
        8.0..42.0,
        "drone-measurements.svg",
        "measurements T",
        130.0,
    )?;
    cells("Table 3.2", &["h=800"], "L=", 0.0..3100.0, "drone-particles.svg", "particles L", 150.0)?;
    let walks = |table, key, xs, file, x, most| -> Result<(), Box<dyn Error>> {
        let of = |filter| line(&report, (table, filter), (&[], key), |row| row.mean_m);
        Figure { file, x, y: "mean error, m", xs, ys: 0.0..most }.draw(&[
            ("hovering over the estimate (thesis)", of("paper")),
            ("circling, velocity marginalised", of("best")),
        ])
    };
    walks(
        "Fig. 3.8 (h=500)",
        "r=",
        500.0..2100.0,
        "drone-user-radius.svg",
        "radius of the user's circle, m",
        2000.0,
    )?;
    walks(
        "Fig. 3.11",
        "T_end=",
        350.0..1050.0,
        "drone-end-time.svg",
        "steps for the user's circle",
        450.0,
    )
}
