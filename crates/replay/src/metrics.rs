//! Quality of estimates: errors, spreads, and the alignment that makes two tracks comparable.
//!
//! Horizontal positions are `[x, y]` in metres, in any right-handed frame with z up.

/// Standard gravity, m/s²: the g in which accelerometers are specified.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Root mean square; 0 for an empty slice.
pub fn rms(values: &[f64]) -> f64 {
    mean(&values.iter().map(|value| value * value).collect::<Vec<_>>()).sqrt()
}

/// Arithmetic mean; 0 for an empty slice.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Standard deviation of a sample (divided by n − 1); 0 for fewer than two values.
pub fn standard_deviation(values: &[f64]) -> f64 {
    let centre = mean(values);
    let squares: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    (squares / values.len().saturating_sub(1).max(1) as f64).sqrt()
}

/// The value below which `percent` of the values lie, interpolated between neighbours; 0 for an empty slice.
pub fn percentile(values: &[f64], percent: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let place = percent.clamp(0.0, 100.0) / 100.0 * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    sorted[below] + (sorted[above] - sorted[below]) * place.fract()
}

/// The median; 0 for an empty slice.
pub fn median(values: &[f64]) -> f64 {
    percentile(values, 50.0)
}

/// The relative difference of `value` from `reference` in percent (negative if smaller); `None` unless `reference` is
/// positive.
pub fn relative_error_percent(value: f64, reference: f64) -> Option<f64> {
    (reference > 0.0).then(|| 100.0 * (value - reference) / reference)
}

/// Length of the straight line between two points, m.
pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Length of the line through all points, m.
pub fn polyline_length(points: &[[f64; 2]]) -> f64 {
    points.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

/// Distance from the first to the last point, m; 0 for an empty slice.
pub fn closure(points: &[[f64; 2]]) -> f64 {
    match (points.first(), points.last()) {
        (Some(&first), Some(&last)) => distance(first, last),
        _ => 0.0,
    }
}

/// Horizontal distances, m, between corresponding points of two tracks after yaw alignment.
///
/// An inertial tracker knows neither its start nor its initial heading: both tracks are moved so that they start at the
/// origin, then `ours` is turned about it by the one angle that minimises the sum of the squared distances.
pub fn aligned_errors(ours: &[[f64; 2]], truth: &[[f64; 2]]) -> Vec<f64> {
    let (sin, cos) = best_turn(ours, truth).sin_cos();
    let pairs = from_start(ours).into_iter().zip(from_start(truth));
    pairs.map(|(a, b)| distance([cos * a[0] - sin * a[1], sin * a[0] + cos * a[1]], b)).collect()
}

/// The angle, rad, anticlockwise, by which [`aligned_errors`] turns `ours` about its start; 0 for empty tracks.
pub fn best_turn(ours: &[[f64; 2]], truth: &[[f64; 2]]) -> f64 {
    let (ours, truth) = (from_start(ours), from_start(truth));
    // Not `sum`, which is −0 for no terms, with an angle of π.
    let (sine, cosine) = ours.iter().zip(&truth).fold((0.0, 0.0), |(sine, cosine), (a, b)| {
        (sine + (a[0] * b[1] - a[1] * b[0]), cosine + (a[0] * b[0] + a[1] * b[1]))
    });
    f64::atan2(sine, cosine)
}

/// Root mean square error over root mean square standard deviation, from pairs of both; `None` without pairs.
pub fn error_over_sigma(told: impl IntoIterator<Item = (f64, f64)>) -> Option<f64> {
    let [errors, sigmas] = told.into_iter().fold([0.0, 0.0], |[errors, sigmas], (error, sigma)| {
        [errors + error * error, sigmas + sigma * sigma]
    });
    (sigmas > 0.0).then(|| (errors / sigmas).sqrt())
}

/// A ratio as text, or a dash.
pub fn ratio_in_words(ratio: Option<f64>) -> String {
    ratio.map_or_else(|| "—".to_owned(), |ratio| format!("{ratio:.2}"))
}

fn from_start(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let start = points.first().copied().unwrap_or_default();
    points.iter().map(|point| [point[0] - start[0], point[1] - start[1]]).collect()
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "these values are exact")]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.5]];

    #[test]
    fn averages() {
        let values = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(mean(&values), 2.5);
        assert_eq!(median(&values), 2.5);
        assert_eq!(percentile(&values, 0.0), 1.0);
        assert_eq!(percentile(&values, 100.0), 4.0);
        assert_eq!(rms(&[3.0, -4.0]), 12.5_f64.sqrt());
        assert_eq!(standard_deviation(&[1.0, 3.0]), 2.0_f64.sqrt());
        assert_eq!(
            (mean(&[]), rms(&[]), median(&[]), standard_deviation(&[])),
            (0.0, 0.0, 0.0, 0.0)
        );
    }

    #[test]
    fn lengths() {
        assert_eq!(polyline_length(&SQUARE), 3.5);
        assert_eq!(closure(&SQUARE), 0.5);
        assert_eq!(relative_error_percent(12.0, 10.0), Some(20.0));
        assert_eq!(relative_error_percent(12.0, 0.0), None);
    }

    #[test]
    fn a_moved_and_turned_track_has_no_error() {
        let (sin, cos) = 2.0_f64.sin_cos();
        let turned = SQUARE.map(|[x, y]| [7.0 + cos * x - sin * y, -3.0 + sin * x + cos * y]);
        assert!(aligned_errors(&turned, &SQUARE).iter().all(|&error| error < 1e-12));
    }

    #[test]
    fn alignment_turns_but_never_stretches() {
        let long = SQUARE.map(|[x, y]| [2.0 * x, 2.0 * y]);
        let errors = aligned_errors(&long, &SQUARE);
        assert_eq!(errors[0], 0.0);
        assert!((errors[2] - 2.0_f64.sqrt()).abs() < 1e-12);
    }
}
