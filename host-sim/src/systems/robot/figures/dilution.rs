//! Dilution of precision: over the room, and of the ranges in use.

use kestirim_replay::robot::{Dimensions, Epoch, Event, Range, Reception, Setup, Trace};
use kestirim_uwb_ranging::{dilution_of_precision, expected_range};

use super::Shown;
use super::plan::room;
use crate::figure::{Colour, Figure, Grid, Mark, Series};
use crate::metrics::median;

/// The dilutions for which contour lines are drawn: in a room they are near the minimum for n anchors, 2/√n in the
/// plane.
const LEVELS: [f64; 19] = [
    0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.9, 1.0, 1.05, 1.1, 1.15, 1.2, 1.3, 1.5, 2.0, 3.0, 5.0,
    10.0,
];
/// The number of cells along the longer side of the room.
const CELLS: usize = 60;
/// The margin around the anchors, as a share of their longer side.
const BEYOND: f64 = 0.15;
/// The minimum and maximum time for which a range counts as in use (s); in between it is two rounds of the anchors, as
/// in the tracker.
const FRESH_S: [f64; 2] = [1.0, 8.0];

/// The unknowns besides the horizontal position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unknowns {
    /// Whether the height is unknown rather than given.
    pub height: bool,
    /// Whether the tag's clock is unknown, as with differences of distances.
    pub clock: bool,
}

/// Horizontal dilution of precision: the factor by which the anchors' geometry magnifies the error of a range into that
/// of the horizontal position, √(Q₁₁ + Q₂₂) with Q = (HᵀH)⁻¹ of the directions H from the anchors to the tag, with a
/// column of ones if the clock is unknown (Langley 1999, *Dilution of precision*, GPS World 10(5)). All ranges are
/// assumed to be equally accurate, without a common bias. `None` if the anchors do not determine the position.
pub fn horizontal(
    place: [f64; 3],
    anchors: impl IntoIterator<Item = [f64; 3]>,
    unknowns: Unknowns,
) -> Option<f64> {
    let direction = |anchor: [f64; 3]| expected_range(&place.into(), 0.0, &anchor.into()).direction;
    let mut rows: Vec<[f64; 3]> = anchors.into_iter().map(direction).collect();
    // The other unknowns are eliminated: of each column only the part remains that is orthogonal to theirs.
    if unknowns.clock {
        let mean = [0, 1, 2]
            .map(|axis| rows.iter().map(|row| row[axis]).sum::<f64>() / rows.len().max(1) as f64);
        for row in &mut rows {
            *row = [0, 1, 2].map(|axis| row[axis] - mean[axis]);
        }
    }
    let eliminated = usize::from(unknowns.clock) + usize::from(unknowns.height);
    if rows.len() < 2 + eliminated {
        return None;
    }
    if unknowns.height {
        let with_height = |axis: usize| rows.iter().map(|row| row[axis] * row[2]).sum::<f64>();
        let [x, y, square] = [0, 1, 2].map(with_height);
        if square <= f64::EPSILON {
            return None;
        }
        for row in &mut rows {
            *row = [row[0] - row[2] * x / square, row[1] - row[2] * y / square, 0.0];
        }
    }
    dilution_of_precision(rows.into_iter().map(|[x, y, _]| [x, y])).ok()
}

impl Shown<'_> {
    /// The dilution of precision over the anchors' area, from all anchors that answered, with the track on top.
    pub fn dilution(&self, id: &str, setup: &Setup) -> Figure {
        let (anchors, unknowns) = (self.answered(setup), self.unknowns(setup));
        let known: Vec<_> =
            self.traces.iter().flat_map(Trace::known).map(|(_, [.., z])| z).collect();
        let height = if known.is_empty() { setup.height_m } else { median(&known) };
        let [x0, y0, x1, y1] = self.recording.anchors.rectangle();
        let margin = BEYOND * (x1 - x0).max(y1 - y0);
        let area = [x0 - margin, y0 - margin, x1 + margin, y1 + margin];
        // A grid of the reciprocal, which is zero where the dilution is infinite.
        let grid = Grid::new(area, CELLS, |[x, y]| {
            let dilution = horizontal([x, y, height], anchors.iter().copied(), unknowns);
            dilution.map_or(0.0, f64::recip)
        });
        let lines = LEVELS.iter().enumerate();
        let lines =
            lines.map(|(place, level)| iso_line(*level, &grid).coloured(Colour::Other(place)));
        Figure { title: "Dilution of precision over the room".to_owned(), ..room(id, self.recording) }
            .caption(format!(
                "Lines of equal HDOP at a height of {height:.2} m with all anchors that answered: an error of a range is as many \
                 times as large in the position.",
            ))
            .with_all(lines.filter(|line| !line.x.is_empty()))
            .with(self.track("track", self.line()).coloured(Colour::Ours))
    }

    /// The dilution of precision at the estimated positions, from the anchors whose ranges were in use, and from all
    /// that answered.
    pub fn dilution_over_time(&self, id: &str, setup: &Setup) -> Figure {
        let (answered, unknowns) = (self.answered(setup), self.unknowns(setup));
        let all = |_: usize, trace: &Trace| {
            let dilution = |place| horizontal(place?, answered.iter().copied(), unknowns);
            let of = |it: &Epoch| (it.time_us, dilution(it.position).unwrap_or(f64::NAN));
            trace.epochs.iter().map(of).collect()
        };
        let used = |_: usize, trace: &Trace| used(trace, setup, answered.len(), unknowns);
        Figure::new(id, "Dilution of precision of the ranges used")
            .over_seconds("HDOP")
            .logarithmic()
            .caption(
                "What the geometry makes of a range's error where the tag was: with the anchors whose ranges were taken in lately, and \
                 with all that answered. Where the former is above, anchors are missing.",
            )
            .with(self.over_time("all that answered", Mark::Dashes, all).coloured(Colour::Limit))
            .with(self.over_time("ranges used", self.line(), used).coloured(Colour::Ours))
    }

    /// The positions of the anchors that have ranges.
    fn answered(&self, setup: &Setup) -> Vec<[f64; 3]> {
        let mut heard = vec![false; setup.anchors.len()];
        for (range, _) in self.traces.iter().flat_map(|trace| &trace.ranges) {
            if let Some(heard) = heard.get_mut(range.anchor) {
                *heard = true;
            }
        }
        let anchors = setup.anchors.iter().zip(heard);
        anchors.filter(|(_, heard)| *heard).map(|(anchor, _)| *anchor).collect()
    }

    fn unknowns(&self, setup: &Setup) -> Unknowns {
        let mut events = self.recording.parts.iter().flat_map(|part| &part.events);
        Unknowns {
            height: setup.dimensions == Dimensions::Three,
            clock: events.any(|event| matches!(event, Event::Difference(_))),
        }
    }
}

/// The contour lines of the dilution `level`, each labelled in its middle.
fn iso_line(level: f64, grid: &Grid) -> Series {
    let (mut points, mut labels) = (Vec::new(), Vec::new());
    for line in grid.contour(level.recip()) {
        let middle = points.len() + line.len() / 2;
        points.extend(line.into_iter().chain([[f64::NAN; 2]]));
        labels.resize(points.len(), String::new());
        labels[middle] = level.to_string();
    }
    Series::path(format!("HDOP {level}"), points).labelled(labels)
}

/// The dilution at each epoch from the anchors whose ranges were accepted recently.
fn used(trace: &Trace, setup: &Setup, answered: usize, unknowns: Unknowns) -> Vec<(i64, f64)> {
    let fresh_us = fresh_us(trace, answered);
    let mut last_us = vec![None; setup.anchors.len()];
    let mut ranges = trace.ranges.iter().peekable();
    let of = |epoch: &Epoch| {
        let is_before = |(range, _): &&(Range, Reception)| range.time_us <= epoch.time_us;
        while let Some((range, reception)) = ranges.next_if(is_before) {
            if let (true, Some(last)) = (reception.taken, last_us.get_mut(range.anchor)) {
                *last = Some(range.time_us);
            }
        }
        let is_fresh = |last: Option<i64>| last.is_some_and(|it| epoch.time_us - it <= fresh_us);
        let used = setup.anchors.iter().zip(&last_us).filter(|(_, last)| is_fresh(**last));
        let used = used.map(|(anchor, _)| *anchor);
        let dilution = epoch.position.and_then(|place| horizontal(place, used, unknowns));
        (epoch.time_us, dilution.unwrap_or(f64::NAN))
    };
    trace.epochs.iter().map(of).collect()
}

/// The time for which a range counts as in use (µs).
fn fresh_us(trace: &Trace, anchors: usize) -> i64 {
    let ends = trace.epochs.first().zip(trace.epochs.last());
    let span_s = ends.map_or(0.0, |(first, last)| (last.time_us - first.time_us) as f64 * 1e-6);
    let round_s = anchors as f64 * span_s / trace.ranges.len().max(1) as f64;
    ((2.0 * round_s).clamp(FRESH_S[0], FRESH_S[1]) * 1e6) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLANE: Unknowns = Unknowns { height: false, clock: false };
    const SQUARE: [[f64; 3]; 4] =
        [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];

    #[test]
    fn at_the_centre_of_a_square_it_is_one() {
        assert_close(horizontal([0.0; 3], SQUARE, PLANE), 1.0);
        // Two anchors at right angles: each range is a coordinate.
        assert_close(horizontal([0.0; 3], SQUARE.into_iter().take(2), PLANE), 2_f64.sqrt());
        // An unknown clock costs nothing if the anchors are all around.
        assert_close(horizontal([0.0; 3], SQUARE, Unknowns { clock: true, ..PLANE }), 1.0);
        // Ranges from 45° above are half as informative about horizontal distances.
        let high = 2_f64.sqrt();
        assert_close(horizontal([0.0, 0.0, high], SQUARE, PLANE), 2_f64.sqrt());
        // All anchors are equally high: an unknown height costs nothing either.
        assert_close(
            horizontal([0.0, 0.0, high], SQUARE, Unknowns { height: true, ..PLANE }),
            2_f64.sqrt(),
        );
    }

    fn assert_close(found: Option<f64>, expected: f64) {
        assert!((found.unwrap() - expected).abs() < 1e-12, "{found:?}, not {expected}");
    }

    #[test]
    fn what_else_is_unknown_is_paid_for_as_the_whole_matrix_has_it() {
        let (place, anchors) = (
            [0.4, -0.2, 0.6],
            [
                [3.0, 0.0, 2.0],
                [0.0, 2.0, 0.0],
                [-2.0, -1.0, 1.5],
                [1.0, -3.0, 2.5],
                [4.0, 4.0, 0.5],
            ],
        );
        let row = |anchor: [f64; 3]| {
            let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - anchor[axis]);
            let length = (x * x + y * y + z * z).sqrt();
            nalgebra::RowVector4::new(x / length, y / length, z / length, 1.0)
        };
        let matrix =
            nalgebra::OMatrix::<f64, nalgebra::U5, nalgebra::U4>::from_rows(&anchors.map(row));
        let q = (matrix.transpose() * matrix).try_inverse().unwrap();
        let unknowns = Unknowns { height: true, clock: true };
        assert_close(horizontal(place, anchors, unknowns), (q[(0, 0)] + q[(1, 1)]).sqrt());
        assert_eq!(horizontal(place, anchors.into_iter().take(3), unknowns), None, "too few");
    }

    #[test]
    fn anchors_in_a_row_tell_nothing_on_their_line() {
        let row = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        assert_eq!(horizontal([5.0, 0.0, 0.0], row, PLANE), None);
        assert!(horizontal([1.0, 1.0, 0.0], row, PLANE).is_some());
        assert_eq!(horizontal([1.0, 1.0, 0.0], row, Unknowns { height: true, ..PLANE }), None);
    }
}
