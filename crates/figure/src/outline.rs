//! Thinning of the paths of a map by distance: what is left out is within a given distance of what is drawn.

use std::collections::HashSet;
use std::ops::Range;

use crate::{Axis, Figure, Mark, Series, extent};

/// The longer side of what a map shows at first: of its axis ranges where they are set, else of the series that are not
/// hidden.
pub(crate) fn width(figure: &Figure, shown: &[Range<usize>]) -> f64 {
    let seen = figure.series.iter().zip(shown).filter(|(series, _)| !series.hidden);
    let length = |axis: &Axis, values: fn(&Series) -> &[f64]| {
        let all = seen.clone().flat_map(|(series, shown)| &values(series)[shown.clone()]).copied();
        axis.range.or_else(|| extent(all)).map_or(0.0, |[low, high]| high - low)
    };
    length(&figure.x, |series| &series.x).max(length(&figure.y, |series| &series.y))
}

/// The indices of the points that are drawn. Of a line, those that keep it within `most` of the whole line, at each
/// time if times are known, and its ellipses within `COARSER` times as much of their own; of points, one of those that
/// would be drawn over each other at about the same time. Gaps are kept.
pub(crate) fn indices(series: &Series, shown: Range<usize>, most: f64) -> Vec<usize> {
    // The marks along such a line are its content.
    let is_marked = series.mark == Mark::LineAndPoints;
    if most <= 0.0 || is_marked || series.labels.is_some() || series.error.is_some() {
        return shown.collect();
    }
    let times = series.times.as_deref().filter(|times| times.len() >= shown.end);
    let place = |i: usize| [series.x[i], series.y[i]];
    let is_gap = |i: usize| !place(i).iter().all(|value| value.is_finite());
    if matches!(series.mark, Mark::Points | Mark::Dots | Mark::Crosses) {
        let mut seen = HashSet::new();
        let length = times.filter(|_| !shown.is_empty());
        let length = length.map_or(0.0, |times| times[shown.end - 1] - times[shown.start]);
        let stretch = (length / STRETCHES).max(f64::MIN_POSITIVE);
        let when = |i: usize| times.map_or(0, |times| (times[i] / stretch) as i64);
        let cell = |i: usize| (place(i).map(|value| (value / most) as i64), when(i));
        return shown.filter(|&i| is_gap(i) || seen.insert(cell(i))).collect();
    }
    let most = most / std::f64::consts::SQRT_2;
    match series.ellipses().filter(|ellipses| ellipses.len() >= shown.end) {
        None => Line { times, most, place }.kept(shown, is_gap),
        Some(ellipses) => {
            let place = |i: usize| {
                let ([x, y], [a, b, c]) = (place(i), ellipses[i]);
                // An unknown ellipse counts as constant.
                let coarser = |part: f64| if part.is_nan() { 0.0 } else { part / COARSER };
                [x, y, coarser(a), coarser(b), coarser(c)]
            };
            Line { times, most, place }.kept(shown, is_gap)
        }
    }
}

/// The number of intervals of time into which a series is divided: in each, a spot is drawn once.
const STRETCHES: f64 = 500.0;

/// The factor by which ellipses may be coarser than the line: an uncertainty is read to a tenth, and shrinks a little
/// with every measurement.
const COARSER: f64 = 8.0;

/// A line, and the distance by which it may be moved along each of N axes.
struct Line<'a, F> {
    times: Option<&'a [f64]>,
    most: f64,
    /// The coordinates of a point.
    place: F,
}

impl<const N: usize, F: Fn(usize) -> [f64; N]> Line<'_, F> {
    /// The points that are kept of each piece between gaps, and the gaps.
    fn kept(&self, shown: Range<usize>, is_gap: impl Fn(usize) -> bool) -> Vec<usize> {
        let mut kept = Vec::new();
        let mut begin = shown.start;
        while begin < shown.end {
            let end = (begin..shown.end).find(|&i| is_gap(i)).unwrap_or(shown.end);
            self.straightened(begin..end, &mut kept);
            kept.extend((end < shown.end).then_some(end));
            begin = end + 1;
        }
        kept
    }

    /// The time of a point; if times are unknown, the points are taken as equally spaced in time.
    fn time(&self, i: usize) -> f64 {
        self.times.map_or(i as f64, |times| times[i])
    }

    /// Appends the points that are kept of a piece. Each straight line goes as far as it stays within the bound of
    /// every point at the point's time: the swinging-door algorithm, in one pass.
    fn straightened(&self, points: Range<usize>, kept: &mut Vec<usize>) {
        let Some(mut from) = points.clone().next() else { return };
        kept.push(from);
        let mut door = Door::OPEN;
        for i in points.clone().skip(1) {
            if !door.takes(self.seen(i, from)) {
                if i - 1 > from {
                    from = i - 1;
                    kept.push(from);
                }
                // Another place at the same time is a jump, of which both ends are kept.
                if !Door::OPEN.takes(self.seen(i, from)) {
                    from = i;
                    kept.push(from);
                }
                door = Door::OPEN;
            }
            door.close(self.seen(i, from), self.most);
        }
        let end = points.end - 1;
        kept.extend((end > from).then_some(end));
    }

    /// The time from another point to this one, and the offset along each axis.
    fn seen(&self, i: usize, from: usize) -> (f64, [f64; N]) {
        let (here, there) = ((self.place)(i), (self.place)(from));
        (self.time(i) - self.time(from), std::array::from_fn(|axis| here[axis] - there[axis]))
    }
}

/// The range of slopes along each axis with which a straight line passes within the bound of all points so far.
struct Door<const N: usize>([[f64; 2]; N]);

impl<const N: usize> Door<N> {
    const OPEN: Self = Self([[f64::NEG_INFINITY, f64::INFINITY]; N]);

    /// Whether the line may end at a point at this offset. At the time where it begins, it may only end where it
    /// begins.
    fn takes(&self, (time, way): (f64, [f64; N])) -> bool {
        let mut all = self.0.iter().zip(way);
        let has_slope = |low, high, way: f64| (low..=high).contains(&(way / time));
        all.all(
            |(&[low, high], way)| if time > 0.0 { has_slope(low, high, way) } else { way == 0.0 },
        )
    }

    /// Excludes the slopes that miss a point by more than the bound.
    fn close(&mut self, (time, way): (f64, [f64; N]), most: f64) {
        for ([low, high], way) in self.0.iter_mut().zip(way) {
            if time > 0.0 {
                (*low, *high) = (low.max((way - most) / time), high.min((way + most) / time));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn from_segment([x, y]: [f64; 2], [[ax, ay], [bx, by]]: [[f64; 2]; 2]) -> f64 {
        let (dx, dy) = (bx - ax, by - ay);
        let square = dx * dx + dy * dy;
        let along = if square > 0.0 { ((x - ax) * dx + (y - ay) * dy) / square } else { 0.0 };
        let along = along.clamp(0.0, 1.0);
        (x - ax - along * dx).hypot(y - ay - along * dy)
    }

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
        assert!(kept.len() < 30_000 && kept.is_sorted(), "{}", kept.len());
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
    fn both_ends_of_a_jump_are_kept_once() {
        let series = Series::path("", (0..9).map(|i| [f64::from(i / 5) * 10.0, 0.0]));
        let times = [0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 5.0, 6.0, 7.0];
        assert_eq!(indices(&series.timed(times), 0..9, 0.1), [0, 4, 5, 8]);
    }

    #[test]
    fn who_stands_on_the_way_is_seen_to_stand() {
        // Ten metres in ten seconds, a minute's rest, ten metres more.
        let at = |i: u32| f64::from(i.min(100)) * 0.1 + f64::from(i.saturating_sub(700)) * 0.1;
        let series = Series::path("", (0..800).map(|i| [at(i), 0.0]));
        let series = series.timed((0..800).map(|i| f64::from(i) * 0.1));
        let kept = indices(&series, 0..800, 0.1);
        assert!(kept.len() < 20, "{kept:?}");
        let times = series.times.as_deref().unwrap();
        let between = |time: f64| {
            let after = kept.partition_point(|&i| times[i] < time).clamp(1, kept.len() - 1);
            let [a, b] = [kept[after - 1], kept[after]];
            let share = (time - times[a]) / (times[b] - times[a]);
            series.x[a] + share * (series.x[b] - series.x[a])
        };
        for i in 0..800 {
            let off = (between(times[i]) - series.x[i]).abs();
            assert!(off <= 0.1, "{off} m off after {} s", times[i]);
        }
    }

    #[test]
    fn an_ellipse_that_grows_on_a_straight_way_is_kept() {
        // Nothing is known for a while, then the variance grows to a square metre and shrinks again.
        let spread = |i: u32| match f64::from(i) / 100.0 {
            ..0.2 => [f64::NAN; 3],
            part => [1.0, 0.0, 1.0].map(|it| it * (1.0 - (2.0 * part - 1.0).abs())),
        };
        let series = Series::path("", (0..100).map(|i| [f64::from(i), 0.0]));
        assert_eq!(indices(&series, 0..100, 0.02), [0, 99]);
        let series = series.uncertain((0..100).map(spread));
        let kept = indices(&series, 0..100, 0.02);
        assert!(kept.len() < 30, "{kept:?}");
        assert!([0, 19, 20, 99].iter().all(|end| kept.contains(end)), "{kept:?}");
        let ellipses = series.ellipses().unwrap();
        for pair in kept.windows(2).filter(|pair| pair[0] >= 20) {
            for i in pair[0]..pair[1] {
                let share = (i - pair[0]) as f64 / (pair[1] - pair[0]) as f64;
                let [before, after] = [pair[0], pair[1]].map(|i| ellipses[i][0]);
                let off = before + share * (after - before) - ellipses[i][0];
                assert!(off.abs() <= COARSER * 0.02, "{off} at {i}");
            }
        }
    }

    #[test]
    fn the_width_is_of_what_is_seen() {
        let series = Series::path("", [[0.0, f64::NAN], [1.0, 5.0], [9.0, 7.0]]);
        let far = Series::path("", [[0.0, 0.0], [1e3, 0.0]]).hidden();
        let mut figure = Figure::new("f", "F").map().with(series).with(far);
        assert_eq!(width(&figure, &[0..3, 0..2]), 9.0);
        assert_eq!(width(&figure, &[1..2, 0..2]), 0.0);
        (figure.x.range, figure.y.range) = (Some([0.0, 3.0]), Some([0.0, 4.0]));
        assert_eq!(width(&figure, &[0..3, 0..2]), 4.0);
    }
}
