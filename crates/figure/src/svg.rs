//! Figures as SVG, for papers and for the book.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;

use crate::{Axis, Figure, Mark, Series, extent};

/// Width and height of a diagram, px; text is sized for half a page.
const SIZE: (u32, u32) = (720, 430);
/// Width and height of a map, which keeps its proportions, px.
const MAP: (u32, u32) = (720, 620);

/// The largest number of series for which a legend is drawn: the names of more would hide the figure, and there are not
/// as many colours.
const MOST_NAMES: usize = 20;

/// The result of drawing a figure.
type Drawn<'a> = Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>>;

/// The figure as a drawing on white; empty if the drawing library refuses it.
pub fn draw(figure: &Figure) -> String {
    let mut text = String::new();
    let size = if figure.equal { MAP } else { SIZE };
    let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
    let drawn = on(&area, figure);
    drop(area);
    if drawn.is_ok() { text } else { String::new() }
}

fn on<'a>(area: &DrawingArea<SVGBackend<'a>, Shift>, figure: &Figure) -> Drawn<'a> {
    area.fill(&WHITE)?;
    let (mut xs, mut ys) =
        (bounds(figure, &figure.x, |s| &s.x), bounds(figure, &figure.y, |s| &s.y));
    if figure.equal {
        (xs, ys) = equally_long(xs, ys);
    }
    match (figure.x.logarithmic, figure.y.logarithmic) {
        (false, false) => chart(area, figure, xs, ys),
        (false, true) => chart(area, figure, xs, ys.log_scale()),
        (true, false) => chart(area, figure, xs.log_scale(), ys),
        (true, true) => chart(area, figure, xs.log_scale(), ys.log_scale()),
    }
}

fn chart<'a, X, Y>(
    area: &DrawingArea<SVGBackend<'a>, Shift>,
    figure: &Figure,
    xs: X,
    ys: Y,
) -> Drawn<'a>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .caption(&figure.title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(62)
        .build_cartesian_2d(xs, ys)?;
    chart
        .configure_mesh()
        .x_desc(&figure.x.label)
        .y_desc(&figure.y.label)
        .light_line_style(WHITE)
        .draw()?;
    for series in figure.series.iter().filter(|series| !series.hidden) {
        let [r, g, b] = series.colour.rgb().map(|part| {
            // The same opacity as on the page, over white.
            let faint = (0.45 * f64::from(part) + 0.55 * 255.0) as u8;
            if series.faint { faint } else { part }
        });
        let colour = RGBColor(r, g, b);
        let points = || series.x.iter().copied().zip(series.y.iter().copied());
        let shown = || points().filter(|(x, y)| x.is_finite() && y.is_finite());
        let stroke = colour.stroke_width(2);
        let lined =
            matches!(series.mark, Mark::Line | Mark::Dashes | Mark::Steps | Mark::LineAndPoints);
        if lined {
            for stretch in stretches(series) {
                if series.mark == Mark::Dashes {
                    chart.draw_series(DashedLineSeries::new(stretch, 6, 4, stroke))?;
                } else {
                    chart.draw_series(LineSeries::new(stretch, stroke))?;
                }
            }
        }
        let radius = match series.mark {
            Mark::Dots => 1,
            Mark::LineAndPoints => 3,
            _ => 4,
        };
        let legend = match series.mark {
            Mark::Crosses => chart.draw_series(shown().map(|at| Cross::new(at, 3, stroke)))?,
            Mark::Points | Mark::Dots | Mark::LineAndPoints => {
                chart.draw_series(shown().map(|at| Circle::new(at, radius, colour.filled())))?
            }
            Mark::Line | Mark::Dashes | Mark::Steps => {
                chart.draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
            }
        };
        legend
            .label(&series.name)
            .legend(move |(x, y)| Rectangle::new([(x, y - 2), (x + 16, y + 2)], colour.filled()));
        if let Some(error) = &series.error {
            let bars = points().zip(error).filter(|((x, y), e)| (x + y + **e).is_finite());
            chart.draw_series(
                bars.map(|((x, y), e)| PathElement::new(vec![(x, y - e), (x, y + e)], colour)),
            )?;
        }
        if let Some(labels) = &series.labels {
            let font = ("sans-serif", 12).into_font();
            chart.draw_series(
                points().zip(labels).filter(|((x, y), _)| (x + y).is_finite()).map(
                    |((x, y), label)| {
                        EmptyElement::at((x, y)) + Text::new(label.clone(), (5, -14), font.clone())
                    },
                ),
            )?;
        }
    }
    if figure.series.iter().filter(|series| !series.hidden).count() <= MOST_NAMES {
        chart
            .configure_series_labels()
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .draw()?;
    }
    area.present()
}

/// The ends of an axis: the range if one is set, else the extent of all that is shown, with a margin.
fn bounds(figure: &Figure, axis: &Axis, of: fn(&Series) -> &Vec<f64>) -> Range<f64> {
    if let Some([low, high]) = axis.range {
        return low..high;
    }
    let shown = figure.series.iter().filter(|series| !series.hidden).flat_map(of).copied();
    let usable = shown.filter(|value| !axis.logarithmic || *value > 0.0);
    let Some([low, high]) = extent(usable) else {
        return if axis.logarithmic { 0.1..10.0 } else { 0.0..1.0 };
    };
    if axis.logarithmic {
        return low / 1.2..high * 1.2;
    }
    let margin = if high > low { 0.04 * (high - low) } else { 0.5_f64.max(0.01 * high.abs()) };
    low - margin..high + margin
}

/// Widens the shorter axis until both have the same scale in the plot area.
fn equally_long(xs: Range<f64>, ys: Range<f64>) -> (Range<f64>, Range<f64>) {
    let (wide, high) = (f64::from(MAP.0) - 86.0, f64::from(MAP.1) - 92.0);
    let metres_a_pixel = ((xs.end - xs.start) / wide).max((ys.end - ys.start) / high);
    let around = |range: Range<f64>, length: f64| {
        let middle = f64::midpoint(range.start, range.end);
        middle - length / 2.0..middle + length / 2.0
    };
    (around(xs, wide * metres_a_pixel), around(ys, high * metres_a_pixel))
}

/// The unbroken pieces of a line.
fn stretches(series: &Series) -> Vec<Vec<(f64, f64)>> {
    let mut pieces = vec![Vec::new()];
    let mut before: Option<(f64, f64)> = None;
    for at @ (x, y) in series.x.iter().copied().zip(series.y.iter().copied()) {
        if !(x.is_finite() && y.is_finite()) {
            pieces.push(Vec::new());
            before = None;
            continue;
        }
        let Some(piece) = pieces.last_mut() else { continue };
        if let (Mark::Steps, Some((_, held))) = (series.mark, before) {
            piece.push((x, held));
        }
        piece.push(at);
        before = Some(at);
    }
    pieces.retain(|piece| piece.len() > 1);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Colour;

    #[test]
    fn every_mark_is_drawn_and_gaps_break_a_line() {
        let xs = vec![1.0, 2.0, 3.0, 4.0, 5.0];
        let ys = vec![1.0, 2.0, f64::NAN, 2.0, 3.0];
        let marks = [
            Mark::Line,
            Mark::Dashes,
            Mark::Steps,
            Mark::LineAndPoints,
            Mark::Points,
            Mark::Dots,
            Mark::Crosses,
        ];
        let figure = Figure::new("all", "All marks").axes("x", "y").with_all(
            marks.map(|mark| Series::new(format!("{mark:?}"), mark, xs.clone(), ys.clone())),
        );
        for figure in [figure.clone(), figure.clone().map(), figure.logarithmic()] {
            let text = draw(&figure);
            assert!(text.ends_with("</svg>\n"), "{text}");
            for mark in marks {
                assert!(text.contains(&format!("{mark:?}")), "{mark:?}");
            }
        }
        let steps = Series::new("", Mark::Steps, xs, ys);
        let expected =
            [vec![(1.0, 1.0), (2.0, 1.0), (2.0, 2.0)], vec![(4.0, 2.0), (5.0, 2.0), (5.0, 3.0)]];
        assert_eq!(stretches(&steps), expected);
    }

    #[test]
    fn nothing_is_drawn_as_an_empty_frame() {
        assert!(draw(&Figure::new("none", "None")).contains("None"));
        let odd = Series::line("odd", vec![0.0, f64::INFINITY], vec![f64::NAN, 1.0]);
        assert!(draw(&Figure::new("odd", "Odd").logarithmic().with(odd)).contains("Odd"));
    }

    #[test]
    fn names_never_hide_a_figure() {
        let lines = |count: usize| {
            let line = |i| Series::path(format!("line {i}"), [[0.0, 0.0], [1.0, 1.0]]);
            draw(&Figure::new("many", "Many").with_all((1..=count).map(line)))
        };
        assert!(lines(MOST_NAMES).contains("line 20"));
        assert!(!lines(MOST_NAMES + 1).contains("line 20"));
    }

    #[test]
    fn a_map_keeps_its_proportions() {
        let (xs, ys) = equally_long(0.0..10.0, 0.0..1.0);
        let (wide, high) = (f64::from(MAP.0) - 86.0, f64::from(MAP.1) - 92.0);
        assert!(((xs.end - xs.start) / wide - (ys.end - ys.start) / high).abs() < 1e-12);
        assert_eq!(Colour::Other(7).rgb(), Colour::Other(0).rgb());
    }
}
