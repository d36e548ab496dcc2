//! Long series, thinned to what a screen can show.

use super::Series;

/// Indices of at most about `most` points that look like all of them: the lowest and the highest of each
/// stretch, so that no peak is lost.
pub(super) fn indices(series: &Series, most: usize) -> Vec<usize> {
    let length = series.len();
    if length <= most {
        return (0..length).collect();
    }
    let stretch = (2 * length).div_ceil(most).max(1);
    let mut kept = Vec::with_capacity(most + 2);
    for begin in (0..length).step_by(stretch) {
        let end = (begin + stretch).min(length);
        let by_height = |&a: &usize, &b: &usize| series.y[a].total_cmp(&series.y[b]);
        let places = || (begin..end).filter(|&i| !series.y[i].is_nan());
        let (low, high) = (places().min_by(by_height), places().max_by(by_height));
        // A gap, too, must stay one.
        let gap = (begin..end).find(|&i| series.y[i].is_nan());
        let mut chosen: Vec<_> = [low, high, gap].into_iter().flatten().collect();
        chosen.sort_unstable();
        chosen.dedup();
        kept.extend(chosen);
    }
    for end in [0, length - 1] {
        if let Err(place) = kept.binary_search(&end) {
            kept.insert(place, end);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_ends_and_gaps_survive() {
        let x: Vec<f64> = (0..10_000).map(f64::from).collect();
        let mut y = vec![0.0; 10_000];
        (y[4321], y[7777], y[5000]) = (9.0, -9.0, f64::NAN);
        let kept = indices(&Series::line("", x, y), 500);
        assert!(kept.len() <= 505, "{}", kept.len());
        assert!(kept.is_sorted());
        for index in [0, 4321, 5000, 7777, 9999] {
            assert!(kept.contains(&index), "{index}");
        }
    }

    #[test]
    fn short_series_stay_as_they_are() {
        let series = Series::line("", vec![1.0, 2.0], vec![3.0, f64::NAN]);
        assert_eq!(indices(&series, 2), [0, 1]);
        assert!(indices(&Series::line("", vec![], vec![]), 2).is_empty());
    }
}
