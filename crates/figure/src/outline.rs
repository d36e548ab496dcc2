//! Paths of a map, thinned by distance: what is left out is no farther from what is drawn than asked.

use std::collections::HashSet;
use std::ops::Range;

use crate::{Mark, Series};

/// The longer side of what these series cover.
pub(crate) fn width(series: &[Series], shown: &[Range<usize>]) -> f64 {
    let extent = |values: fn(&Series) -> &[f64]| {
        let of = series.iter().zip(shown);
        let all = of.flat_map(|(series, shown)| &values(series)[shown.clone()]).copied();
        let (low, high) = all
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), value| (l.min(value), h.max(value)));
        if low <= high { high - low } else { 0.0 }
    };
    extent(|series| &series.x).max(extent(|series| &series.y))
}

/// Indices of the points that are drawn: of a line, those that keep it within `most` of the whole one; of points, one of those
/// that would be drawn over each other. A gap stays one.
pub(crate) fn indices(series: &Series, shown: Range<usize>, most: f64) -> Vec<usize> {
    if most <= 0.0 || series.labels.is_some() || series.error.is_some() {
        return shown.collect();
    }
    let place = |i: usize| [series.x[i], series.y[i]];
    let is_gap = |i: usize| !place(i).iter().all(|value| value.is_finite());
    if matches!(series.mark, Mark::Points | Mark::Dots | Mark::Crosses) {
        let mut seen = HashSet::new();
        let cell = |i: usize| place(i).map(|value| (value / most) as i64);
        return shown.filter(|&i| is_gap(i) || seen.insert(cell(i))).collect();
    }
    let mut kept = Vec::new();
    let mut begin = shown.start;
    while begin < shown.end {
        let end = (begin..shown.end).find(|&i| is_gap(i)).unwrap_or(shown.end);
        straightened(&distant(begin..end, most / 2.0, place), most / 2.0, place, &mut kept);
        kept.extend((end < shown.end).then_some(end));
        begin = end + 1;
    }
    kept
}

/// Points farther than `most` from the one that was kept before, and the last.
fn distant(points: Range<usize>, most: f64, place: impl Fn(usize) -> [f64; 2]) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for i in points.clone() {
        let is_far = kept.last().is_none_or(|&last| distance(place(i), place(last)) > most);
        if is_far || i + 1 == points.end {
            kept.push(i);
        }
    }
    kept
}

/// Points without which a line would move by more than `most`: Douglas and Peucker, 1973.
fn straightened(
    points: &[usize],
    most: f64,
    place: impl Fn(usize) -> [f64; 2],
    kept: &mut Vec<usize>,
) {
    let (Some(&first), Some(last)) = (points.first(), points.len().checked_sub(1)) else { return };
    kept.push(first);
    // Stretches that are still to be looked at, the earliest on top; each begins where the last one ended.
    let mut stretches = vec![(0, last)];
    while let Some((from, to)) = stretches.pop() {
        let ends = [from, to].map(|end| place(points[end]));
        let off = |&i: &usize| from_segment(place(points[i]), ends);
        let farthest = (from + 1..to).max_by(|a, b| off(a).total_cmp(&off(b)));
        match farthest.filter(|i| off(i) > most) {
            Some(middle) => stretches.extend([(middle, to), (from, middle)]),
            None => kept.extend((to > from).then(|| points[to])),
        }
    }
}

fn from_segment([x, y]: [f64; 2], [[ax, ay], [bx, by]]: [[f64; 2]; 2]) -> f64 {
    let (dx, dy) = (bx - ax, by - ay);
    let square = dx * dx + dy * dy;
    let along = if square > 0.0 { ((x - ax) * dx + (y - ay) * dy) / square } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    distance([x, y], [ax + along * dx, ay + along * dy])
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    (ax - bx).hypot(ay - by)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Laps of a lane with rounded ends, which do not repeat.
    fn laps(points: u32) -> Series {
        let lap = |i: u32| {
            let turn = f64::from(i) * 0.01;
            [20.0 * turn.cos() + 0.3 * (0.37 * turn).sin(), 3.0 * turn.sin()]
        };
        Series::path("laps", (0..points).map(lap))
    }

    #[test]
    fn a_long_path_is_drawn_true() {
        let series = laps(100_000);
        let most = 40.0 / 1400.0;
        let kept = indices(&series, 0..series.len(), most);
        assert!(kept.len() < 20_000 && kept.is_sorted(), "{}", kept.len());
        let place = |i: usize| [series.x[i], series.y[i]];
        for pair in kept.windows(2) {
            for i in pair[0]..pair[1] {
                let off = from_segment(place(i), [place(pair[0]), place(pair[1])]);
                assert!(off <= most, "{i} is {off} m off");
            }
        }
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 99_999));
    }

    #[test]
    fn gaps_and_labels_stay_and_a_straight_line_has_two_ends() {
        let mut series = Series::path("", (0..10).map(|i| [f64::from(i), 0.0]));
        series.x[4] = f64::NAN;
        assert_eq!(indices(&series, 0..10, 0.1), [0, 3, 4, 5, 9]);
        let labelled = series.clone().labelled(vec![String::new(); 10]);
        assert_eq!(indices(&labelled, 0..10, 0.1).len(), 10);
        assert_eq!(indices(&series, 3..3, 0.1).len(), 0);
    }

    #[test]
    fn points_on_the_same_spot_are_drawn_once() {
        let series = Series::points("", [[1.0, 1.0], [1.001, 1.0], [2.0, 1.0], [1.0, 1.0]]);
        assert_eq!(indices(&series, 0..4, 0.1), [0, 2]);
    }

    #[test]
    fn the_width_is_of_what_is_shown() {
        let series = Series::path("", [[0.0, f64::NAN], [1.0, 5.0], [9.0, 7.0]]);
        let both = [series.clone(), series];
        assert_eq!(width(&both, &[0..3, 0..1]), 9.0);
        assert_eq!(width(&both, &[1..2, 1..1]), 0.0);
    }
}
