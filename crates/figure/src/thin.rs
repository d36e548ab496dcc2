//! Long series, thinned to what a screen can show.

use std::ops::Range;

use crate::{Figure, Series, outline};

/// What a screen shows of a figure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The approximate number of points of a series that the screen can show.
    pub most_points: usize,
    /// The range of the horizontal axis, if it is zoomed in; of a map, the range of times, s.
    pub window: Option<[f64; 2]>,
}

/// The indices of points of each series that look like all of them in this view.
pub(crate) fn of(figure: &Figure, view: View) -> Vec<Vec<usize>> {
    if !figure.equal {
        return figure.series.iter().map(|series| indices(series, view)).collect();
    }
    let shown: Vec<_> = figure.series.iter().map(|series| then(series, view.window)).collect();
    let width = outline::width(figure, &shown);
    // Half a pixel.
    let most = width / (2 * view.most_points.max(1)) as f64;
    let thinned = figure.series.iter().zip(shown);
    thinned
        .map(|(series, shown)| {
            let are_few = shown.len() <= view.most_points;
            if are_few { shown.collect() } else { outline::indices(series, shown, most) }
        })
        .collect()
}

/// The points of a map within a range of times; all of them if the range or sorted times are missing.
fn then(series: &Series, window: Option<[f64; 2]>) -> Range<usize> {
    let all = 0..series.len();
    let (Some([low, high]), Some(times)) = (window, &series.times) else { return all };
    let times = &times[..times.len().min(all.end)];
    if !times.is_sorted() {
        return all;
    }
    let begin = times.partition_point(|&time| time < low);
    begin..times.partition_point(|&time| time <= high).max(begin)
}

/// The lowest and the highest point of each interval, so that no peak is lost.
fn indices(series: &Series, view: View) -> Vec<usize> {
    let seen = seen(series, view.window);
    if seen.len() <= view.most_points {
        return seen.collect();
    }
    let stretch = (2 * seen.len()).div_ceil(view.most_points).max(1);
    let mut kept = Vec::with_capacity(view.most_points + 2);
    for begin in seen.clone().step_by(stretch) {
        let end = (begin + stretch).min(seen.end);
        let by_height = |&a: &usize, &b: &usize| series.y[a].total_cmp(&series.y[b]);
        let places = || (begin..end).filter(|&i| !series.y[i].is_nan());
        let (low, high) = (places().min_by(by_height), places().max_by(by_height));
        // Gaps must be kept as well.
        let gap = (begin..end).find(|&i| series.y[i].is_nan());
        let mut chosen: Vec<_> = [low, high, gap].into_iter().flatten().collect();
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen);
    }
    for end in [seen.start, seen.end - 1] {
        if let Err(place) = kept.binary_search(&end) {
            kept.insert(place, end);
        }
    }
    kept
}

/// The points in the window, and in half its width on either side, for panning.
fn seen(series: &Series, window: Option<[f64; 2]>) -> Range<usize> {
    let all = 0..series.len();
    let Some([low, high]) = window.filter(|_| series.x.is_sorted()) else { return all };
    let margin = (high - low).abs() / 2.0;
    let begin = series.x.partition_point(|&x| x < low - margin).saturating_sub(1);
    let end = (series.x.partition_point(|&x| x <= high + margin) + 1).min(all.end);
    begin.min(end)..end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_ends_and_gaps_survive() {
        let x: Vec<f64> = (0..10_000).map(f64::from).collect();
        let mut y = vec![0.0; 10_000];
        (y[4321], y[7777], y[5000]) = (9.0, -9.0, f64::NAN);
        let series = Series::line("", x, y);
        let kept = indices(&series, View { most_points: 500, window: None });
        assert!(kept.len() <= 505, "{}", kept.len());
        assert!(kept.is_sorted());
        for index in [0, 4321, 5000, 7777, 9999] {
            assert!(kept.contains(&index), "{index}");
        }
    }

    #[test]
    fn short_series_stay_as_they_are() {
        let series = Series::line("", vec![1.0, 2.0], vec![3.0, f64::NAN]);
        let view = View { most_points: 2, window: None };
        assert_eq!(indices(&series, view), [0, 1]);
        assert!(indices(&Series::line("", vec![], vec![]), view).is_empty());
    }

    #[test]
    fn zooming_in_shows_every_point() {
        let x: Vec<f64> = (0..10_000).map(|i| f64::from(i) / 100.0).collect();
        let series = Series::line("", x.clone(), x);
        let zoomed = |window| indices(&series, View { most_points: 500, window: Some(window) });
        let kept = zoomed([50.0, 51.0]);
        assert_eq!((kept[0], kept.len(), kept[kept.len() - 1]), (4949, 203, 5151));
        assert!(zoomed([-9.0, -8.0]).len() <= 2);
        assert!(zoomed([900.0, 901.0]).len() <= 2);
        assert!(zoomed([f64::NAN, 1.0]).len() <= 505);
    }
}
