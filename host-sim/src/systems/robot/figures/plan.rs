//! The plan of a room: anchors, truth, and the uncertainty of a position.

use crate::figure::{Colour, Figure, Mark, Series, ellipse};
use crate::systems::robot::recording::{Recording, Truth};

/// A map with the anchors, their bounding rectangle, and the true path.
pub fn room(id: &str, recording: &Recording) -> Figure {
    let places = || recording.anchors.positions.iter().map(|&[x, y, _]| [x, y]);
    let anchors = Series::points("anchors", places())
        .labelled(recording.anchors.names.clone())
        .coloured(Colour::Truth);
    let around = rectangle("rectangle of the anchors", recording.anchors.rectangle());
    let mut figure = Figure::new(id, "Plan")
        .axes("x, m", "y, m")
        .map()
        .with(around.coloured(Colour::Truth))
        .with(anchors);
    let (mut points, mut names) = (Vec::new(), Vec::new());
    for part in &recording.parts {
        match &part.truth {
            Some(Truth::Course(course)) => {
                let path = course.rows().iter().map(|(_, place)| *place);
                let path = Series::path("true path", path).marked(Mark::Dashes);
                figure.series.push(path.coloured(Colour::Truth));
            }
            Some(Truth::Point(point)) => {
                points.push(*point);
                names.push(part.name.clone());
            }
            None => {}
        }
    }
    if !points.is_empty() {
        let points = Series::points("true points", points).labelled(names);
        figure.series.push(points.coloured(Colour::Truth));
    }
    figure
}

/// A rectangle with two given opposite corners.
pub(super) fn rectangle(name: &str, [x0, y0, x1, y1]: [f64; 4]) -> Series {
    Series::path(name, [[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]])
}

/// The ellipse that contains 95 % of a normal distribution.
pub(super) fn around([x, y]: [f64; 2], spread: [f64; 3]) -> Vec<[f64; 2]> {
    let [a, b, c] = ellipse(spread);
    let point = |step: u32| {
        let (v, u) = (std::f64::consts::TAU * f64::from(step) / 24.0).sin_cos();
        [x + a * u, y + b * u + c * v]
    };
    (0..=24).map(point).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::distance;
    use kestirim_replay::robot::Anchors;

    #[test]
    fn an_ellipse_lies_along_its_longer_axis() {
        let points = around([1.0, 2.0], [2.5, 1.5, 2.5]);
        let positions = points.iter().map(|&[x, y]| [x, y, 0.0]).collect();
        let [x0, y0, x1, y1] = Anchors { positions, ..Anchors::default() }.rectangle();
        // χ² with two degrees of freedom; the variance is 4 along the diagonal and 1 across it.
        let (chi_square, extent) = (5.991_f64, (5.991_f64 * 2.5).sqrt());
        for (found, expected) in [(x1 - 1.0, extent), (1.0 - x0, extent), (y1 - 2.0, extent)] {
            assert!((found - expected).abs() < 0.05 * extent, "{found} / {expected}");
        }
        assert!((y0 - (2.0 - extent)).abs() < 0.05 * extent);
        let farthest = points.iter().map(|&p| distance(p, [1.0, 2.0])).fold(0.0, f64::max);
        assert!((farthest - 2.0 * chi_square.sqrt()).abs() < 0.02, "{farthest}");
        for [x, y] in points.iter().map(|[x, y]| [x - 1.0, y - 2.0]) {
            let [along, across] = [(x + y) / 2_f64.sqrt(), (x - y) / 2_f64.sqrt()];
            let square = along * along / 4.0 + across * across;
            assert!((square - chi_square).abs() < 1e-9, "{square}");
        }
    }
}
