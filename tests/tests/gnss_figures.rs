//! The book's figures of satellite positioning, from recordings: the paper's figures 3 to 5 on data whose faults
//! are known.
//!
//! `cargo test --release -p kestirim-tests --test gnss_figures -- --ignored`

use std::error::Error;
use std::path::{Path, PathBuf};

use host_sim::systems::gnss::follow::{Followed, follow};
use host_sim::systems::gnss::options::{FilterKind, PROCESS_NOISE};
use kestirim_gnss_ppp::Corrections;
use kestirim_ppp_filter::{Config, Motion, SatelliteReport};
use kestirim_robust_kalman::Reason;
use kestirim_tests::gnss::{ACOR, ESBC, ESBC_INJECTED, Station};
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;
use plotters::coord::Shift;
use plotters::prelude::*;
use rayon::prelude::*;

type Done = Result<(), Box<dyn Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Colours that those tell apart, too, who see few (Okabe and Ito), without the yellow, which is faint on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(110, 110, 110),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 60, 120),
    RGBColor(213, 94, 0),
];

/// Of a filter.
fn colour(filter: FilterKind) -> RGBColor {
    COLOURS[FilterKind::ALL.iter().position(|&other| other == filter).unwrap_or(0)]
}

/// As thick as it matters.
fn width(filter: FilterKind) -> u32 {
    if filter == FilterKind::Default { 2 } else { 1 }
}

fn name(filter: FilterKind) -> &'static str {
    match filter {
        FilterKind::Gkf => "plain (GKF)",
        FilterKind::Rkf => "IGG III (RKF)",
        FilterKind::Skf => "t-test (SKF)",
        FilterKind::Ikf => "iterative IGG III (IKF)",
        FilterKind::Adaptive => "adaptive (UKF)",
        FilterKind::Default => "default",
    }
}

/// What filters make of a station's day, with what became of each observation.
fn follow_all(station: &Station, folder: &Path, filters: &[FilterKind], motion: Motion) -> Days {
    let recording = station.read(folder);
    let receiver = recording.receiver(Corrections::ALL);
    let epochs = recording.epochs(Some(station.until));
    let day = |&filter: &FilterKind| {
        let config = Config { estimator: filter.estimator(motion, false), ..Config::new(motion) };
        (filter, follow(&recording, epochs, &receiver, config, true, || ()))
    };
    filters.par_iter().map(day).collect()
}

/// 3-D errors over the hours, thinned out: each epoch of the first hour, then one in twenty.
fn errors(station: &Station, followed: &Followed) -> Vec<(f64, f64)> {
    let truth = Vector3::from(station.truth);
    let fixes = followed.fixes.iter().enumerate();
    let wanted = fixes.filter(|(epoch, _)| *epoch < 120 || epoch % 20 == 0);
    wanted.map(|(_, fix)| (fix.t / 3600.0, (fix.position - truth).norm())).collect()
}

type Days = Vec<(FilterKind, Followed)>;

fn file(name: &str) -> Result<PathBuf, std::io::Error> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/figures");
    std::fs::create_dir_all(&folder)?;
    Ok(folder.join(name))
}

/// What the colours are, above everything: three in a row.
fn legend<'a>(root: &Area<'a>, filters: &[FilterKind]) -> Result<Area<'a>, Box<dyn Error>> {
    const COLUMNS: i32 = 3;
    root.fill(&WHITE)?;
    let (width_px, _) = root.dim_in_pixel();
    let rows = (i32::try_from(filters.len())? + COLUMNS - 1) / COLUMNS;
    let (head, body) = root.split_vertically(10 + 18 * rows);
    for (place, &filter) in (0..).zip(filters) {
        let x = 60 + place % COLUMNS * ((i32::try_from(width_px)? - 70) / COLUMNS);
        let y = 16 + 18 * (place / COLUMNS);
        let style = colour(filter).stroke_width(width(filter) + 1);
        head.draw(&PathElement::new([(x, y), (x + 22, y)], style))?;
        head.draw(&Text::new(name(filter), (x + 28, y - 6), ("sans-serif", 13)))?;
    }
    Ok(body)
}

/// Errors of filters over the day.
fn panel(area: &Area, title: &str, ys: std::ops::Range<f64>, lines: &[Line]) -> Done {
    let mut chart = ChartBuilder::on(area)
        .margin(8)
        .margin_right(16)
        .caption(title, ("sans-serif", 14))
        .x_label_area_size(34)
        .y_label_area_size(58)
        .build_cartesian_2d(0.0..24.0, ys.clone().log_scale())?;
    chart
        .configure_mesh()
        .x_desc("hours")
        .y_desc("3-D error, m")
        .x_labels(13)
        .y_labels(6)
        .x_label_formatter(&f64::to_string)
        .y_label_formatter(&f64::to_string)
        .max_light_lines(0)
        .draw()?;
    for (filter, points) in lines {
        let style = colour(*filter).stroke_width(width(*filter));
        let inside = points.iter().map(|&(t, error)| (t, error.clamp(ys.start, ys.end)));
        chart.draw_series(LineSeries::new(inside, style))?;
    }
    Ok(())
}

type Line = (FilterKind, Vec<(f64, f64)>);

/// The residual of a code in the standard deviations that the filter gave it; none of one that it rejected.
fn standardised(report: &SatelliteReport) -> Option<f64> {
    let code = &report.code;
    (code.reason != Reason::Rejected).then(|| code.standardised * code.weight.sqrt())
}

/// Figure 3: what is left in the codes.
#[test]
#[ignore = "makes the book's figures"]
fn residuals() -> Done {
    /// Everything beyond this is drawn …
    const FAR: f64 = 4.0;
    /// … and of the rest one in so many, in no order that would show.
    const THINNED: usize = 113;
    let Some(folder) = folder_of("gnss") else { return Ok(()) };
    let path = file("gnss-residuals.svg")?;
    let root = SVGBackend::new(&path, (720, 640)).into_drawing_area();
    root.fill(&WHITE)?;
    let days = follow_all(&ESBC_INJECTED, &folder, &FilterKind::ALL, Motion::Static);
    for (area, (filter, followed)) in root.split_evenly((3, 2)).iter().zip(&days) {
        let codes = followed.residuals.iter().enumerate();
        let codes: Vec<_> = codes
            .filter_map(|(place, (t, report))| {
                let value = standardised(report)?;
                let drawn = value.abs() > FAR || place % THINNED == 0;
                drawn.then_some((t / 3600.0, value, usize::from(report.satellite)))
            })
            .collect();
        let rejected = followed.rejected.code;
        let title = format!("{}: {rejected} codes rejected", name(*filter));
        let mut chart = ChartBuilder::on(area)
            .margin(6)
            .margin_right(14)
            .caption(title, ("sans-serif", 14))
            .x_label_area_size(32)
            .y_label_area_size(44)
            .build_cartesian_2d(0.0..24.0, -34.0..34.0)?;
        chart
            .configure_mesh()
            .x_desc("hours")
            .y_desc("code residual, σ")
            .x_labels(5)
            .y_labels(7)
            .x_label_formatter(&f64::to_string)
            .y_label_formatter(&f64::to_string)
            .max_light_lines(0)
            .draw()?;
        chart.draw_series(codes.iter().map(|&(t, value, satellite)| {
            let colour = COLOURS[satellite % COLOURS.len()];
            Circle::new((t, value), 1, colour.filled())
        }))?;
    }
    root.present()?;
    Ok(())
}

/// Figure 4: a receiver that is known to stand still.
#[test]
#[ignore = "makes the book's figures"]
fn standing() -> Done {
    let Some(folder) = folder_of("gnss") else { return Ok(()) };
    let path = file("gnss-static.svg")?;
    let root = SVGBackend::new(&path, (720, 820)).into_drawing_area();
    let body = legend(&root, &FilterKind::ALL)?;
    let stations = [
        (&ESBC, "ESBC, clocks every 30 s"),
        (&ESBC_INJECTED, "the same with faults"),
        (&ACOR, "ACOR, clocks every 15 min"),
    ];
    for (area, (station, title)) in body.split_evenly((3, 1)).iter().zip(stations) {
        let days = follow_all(station, &folder, &FilterKind::ALL, Motion::Static);
        let lines: Vec<Line> =
            days.iter().map(|(filter, day)| (*filter, errors(station, day))).collect();
        panel(area, title, 1e-3..1e1, &lines)?;
    }
    root.present()?;
    Ok(())
}

/// Figure 5: a receiver that might move.
#[test]
#[ignore = "makes the book's figures"]
fn moving() -> Done {
    const FILTERS: [FilterKind; 3] = [FilterKind::Ikf, FilterKind::Adaptive, FilterKind::Default];
    let Some(folder) = folder_of("gnss") else { return Ok(()) };
    let path = file("gnss-kinematic.svg")?;
    let root = SVGBackend::new(&path, (720, 560)).into_drawing_area();
    let body = legend(&root, &FILTERS)?;
    let noises = [
        (PROCESS_NOISE, "ESBC with faults, 100 m²/s: each epoch stands alone"),
        (1e-4, "1e-4 m²/s: the epochs hold together"),
    ];
    for (area, (process_noise, title)) in body.split_evenly((2, 1)).iter().zip(noises) {
        let motion = Motion::Kinematic { process_noise };
        let days = follow_all(&ESBC_INJECTED, &folder, &FILTERS, motion);
        let lines: Vec<Line> =
            days.iter().map(|(filter, day)| (*filter, errors(&ESBC_INJECTED, day))).collect();
        panel(area, title, 1e-3..1e2, &lines)?;
    }
    root.present()?;
    Ok(())
}
