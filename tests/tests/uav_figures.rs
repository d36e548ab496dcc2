//! The book's figures of the UAV.
//!
//! `cargo test --release -p kestirim-tests --test uav_figures -- --ignored`

use std::error::Error;
use std::iter::once;
use std::path::{Path, PathBuf};

use host_sim::cli::ScalarKind;
use host_sim::systems::uav::accuracy::{Cell, Window};
use host_sim::systems::uav::catching::{BANDS, Chase, caught};
use host_sim::systems::uav::design::{FAST, Kind, MIDDLE, SLOW};
use host_sim::systems::uav::plant::{Outputs, Plant, STATES};
use host_sim::systems::uav::responses::{Responses, responses};
use host_sim::systems::uav::scenario::{INTERVAL_S, Inputs, NEAR, Noise};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

type Done = Result<(), Box<dyn Error>>;
type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Of the states, as axes have them.
const UNITS: [&str; 4] = ["rad", "rad/s", "m/s", "rad"];

/// Points that are joined, in a colour of the palette.
struct Line {
    colour: usize,
    width: u32,
    points: Vec<(f64, f64)>,
}

/// A diagram's axes: what they show, and how far they reach.
struct Axes<'a, X, Y> {
    x: &'a str,
    y: &'a str,
    xs: X,
    ys: Y,
}

impl<X, Y> Axes<'_, X, Y>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    /// Lines, and marks for the same colours.
    fn draw(self, area: &Area, lines: &[Line], marks: &[(usize, (f64, f64))]) -> Done {
        let mut chart = ChartBuilder::on(area)
            .margin(10)
            .x_label_area_size(36)
            .y_label_area_size(58)
            .build_cartesian_2d(self.xs, self.ys)?;
        chart
            .configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .x_labels(7)
            .y_labels(6)
            .x_label_formatter(&f64::to_string)
            .y_label_formatter(&f64::to_string)
            .light_line_style(WHITE)
            .draw()?;
        let (xs, ys) = (chart.x_range(), chart.y_range());
        let inside = |(x, y): &(f64, f64)| xs.contains(x) && ys.contains(y);
        for line in lines {
            let style = colour(line.colour).stroke_width(line.width);
            for run in line.points.chunk_by(|a, b| inside(a) == inside(b)) {
                if inside(&run[0]) {
                    chart.draw_series(LineSeries::new(run.iter().copied(), style))?;
                }
            }
        }
        let mark = |&(number, point)| Circle::new(point, 5, colour(number).filled());
        chart.draw_series(marks.iter().map(mark))?;
        Ok(())
    }
}

/// The palette without its yellow, which is faint on white.
fn colour(number: usize) -> RGBAColor {
    Palette99::pick(if number < 2 { number } else { number + 1 }).to_rgba()
}

fn file(name: &str) -> Result<PathBuf, std::io::Error> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/figures");
    std::fs::create_dir_all(&folder)?;
    Ok(folder.join(name))
}

/// What the colours are, above everything: so many in a row, a name for each.
fn legend<'a>(root: &Area<'a>, names: &[&str], columns: i32) -> Result<Area<'a>, Box<dyn Error>> {
    root.fill(&WHITE)?;
    let (width, _) = root.dim_in_pixel();
    let rows = (i32::try_from(names.len())? + columns - 1) / columns;
    let (head, body) = root.split_vertically(10 + 18 * rows);
    for (number, name) in names.iter().enumerate() {
        let place = i32::try_from(number)?;
        let x = 70 + place % columns * ((i32::try_from(width)? - 80) / columns);
        let y = 16 + 18 * (place / columns);
        head.draw(&PathElement::new([(x, y), (x + 18, y)], colour(number).stroke_width(3)))?;
        head.draw(&Text::new(*name, (x + 24, y - 6), ("sans-serif", 13)))?;
    }
    Ok(body)
}

#[test]
#[ignore = "makes the book's figures"]
fn steps() -> Done {
    let Responses { step, step_times_s, .. } = responses(Plant::P2);
    let path = file("uav-steps.svg")?;
    let root = SVGBackend::new(&path, (680, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    let panels = [
        (2, 0, "V, m/s per rad of δe"),
        (2, 1, "V, m/s per unit of δt"),
        (3, 0, "θ, rad per rad of δe"),
        (3, 1, "θ, rad per unit of δt"),
    ];
    for (area, (state, input, y)) in root.split_evenly((2, 2)).iter().zip(panels) {
        let values = step[input].iter().map(|sample| sample[state]);
        let points: Vec<_> = step_times_s.iter().copied().zip(values).collect();
        let low = points.iter().fold(0.0, |low, point| f64::min(low, point.1));
        let high = points.iter().fold(0.0, |high, point| f64::max(high, point.1));
        let room = 0.05 * (high - low);
        let axes = Axes { x: "t, s", y, xs: 0.0..900.0, ys: low - room..high + room };
        axes.draw(area, &[Line { colour: input, width: 2, points }], &[])?;
    }
    root.present()?;
    Ok(())
}

#[test]
#[ignore = "makes the book's figures"]
fn singular_values() -> Done {
    let path = file("uav-singular-values.svg")?;
    let root = SVGBackend::new(&path, (640, 380)).into_drawing_area();
    let body = legend(&root, &Plant::ALL.map(Plant::name), 3)?;
    let mut lines = Vec::new();
    for (number, plant) in Plant::ALL.into_iter().enumerate() {
        let Responses { bode, peak, .. } = responses(plant);
        let mut largest: Vec<_> =
            bode.iter().map(|point| (point.omega, point.singular_values[0])).collect();
        // The resonance is narrower than the frequencies are apart.
        largest.push((peak.omega, peak.gain));
        largest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let smallest = bode.iter().map(|point| (point.omega, point.singular_values[1])).collect();
        lines.push(Line { colour: number, width: 2, points: largest });
        lines.push(Line { colour: number, width: 1, points: smallest });
    }
    Axes {
        x: "ω, rad/s",
        y: "largest and smallest singular value",
        xs: (9e-4..1.1e2).log_scale(),
        ys: (1e-2..3e4).log_scale(),
    }
    .draw(&body, &lines, &[])?;
    root.present()?;
    Ok(())
}

/// The thesis' aircraft from the near start, all outputs, no noise.
fn chase(kind: Kind) -> Chase {
    let (plant, outputs, inputs) = (Plant::P2, Outputs::Full, Inputs::Constant);
    Chase { plant, outputs, kind, start: NEAR, inputs }
}

#[test]
#[ignore = "makes the book's figures"]
fn catching() -> Done {
    let kinds = [
        Kind::Ratio(1e-2),
        Kind::TimeVarying(Noise::SENSORS),
        Kind::Luenberger(SLOW),
        Kind::Luenberger(FAST),
    ];
    let names = kinds.map(|kind| kind.name());
    let mut names: Vec<&str> = names.iter().map(String::as_str).collect();
    names.push("caught below");
    let errors: Result<Vec<_>, _> =
        kinds.into_iter().map(|kind| chase(kind).errors(ScalarKind::F64)).collect();
    let errors = errors?;
    let path = file("uav-catching.svg")?;
    let root = SVGBackend::new(&path, (680, 560)).into_drawing_area();
    let body = legend(&root, &names, 2)?;
    for (state, area) in body.split_evenly((2, 2)).iter().enumerate() {
        let run = |(number, run): (usize, &Vec<_>)| {
            let error = |sample: usize| {
                let error: nalgebra::Vector4<f64> = run[sample];
                (sample as f64 * INTERVAL_S, error[state].abs())
            };
            Line { colour: number, width: 2, points: (0..run.len()).map(error).collect() }
        };
        let band = vec![(0.0, BANDS[state]), (10.0, BANDS[state])];
        let lines: Vec<_> = errors
            .iter()
            .enumerate()
            .map(run)
            .chain(once(Line { colour: names.len() - 1, width: 1, points: band }))
            .collect();
        let y = format!("|error of {}|, {}", STATES[state], UNITS[state]);
        let scale = BANDS[state] / BANDS[0];
        let ys = (1e-5 * scale..1.0 * scale).log_scale();
        Axes { x: "t, s", y: &y, xs: -0.1..10.1, ys }.draw(area, &lines, &[])?;
    }
    root.present()?;
    Ok(())
}

#[test]
#[ignore = "makes the book's figures"]
fn noise() -> Done {
    let (plant, outputs, noise) = (Plant::P2, Outputs::Full, Noise::SENSORS);
    let inputs = Inputs::Constant;
    let settled =
        Cell { plant, outputs, noise, inputs, window: Window::Settled, kinds: Vec::new() };
    let times = |kind| Ok::<_, Box<dyn Error>>(caught(&chase(kind).errors(ScalarKind::F64)?));
    let kalman = Kind::Matched(noise);
    let (best, kalman_times) = (settled.predicted(&kalman), times(kalman)?);
    let mut lines: Vec<_> =
        (0..4).map(|colour| Line { colour, width: 2, points: Vec::new() }).collect();
    let mut marks = Vec::new();
    for (state, time) in kalman_times.into_iter().enumerate() {
        marks.push((state, (time.ok_or("the filter catches the plant")?, 1.0)));
    }
    for quarters in -12..=11 {
        let faster = 2_f64.powf(f64::from(quarters) / 4.0);
        let kind = Kind::Luenberger(MIDDLE.map(|pole| pole * faster));
        let (rmse, times) = (settled.predicted(&kind), times(kind)?);
        for (state, line) in lines.iter_mut().enumerate() {
            line.points.extend(times[state].map(|time| (time, rmse[state] / best[state])));
        }
    }
    let path = file("uav-noise.svg")?;
    let root = SVGBackend::new(&path, (640, 400)).into_drawing_area();
    let body = legend(&root, &STATES, 4)?;
    Axes {
        x: "time to catch without noise, s (circles: steady-state Kalman filter)",
        y: "settled RMSE / Kalman's",
        xs: (0.08..10.0).log_scale(),
        ys: (0.8..12.0).log_scale(),
    }
    .draw(&body, &lines, &marks)?;
    root.present()?;
    Ok(())
}
