//! Consistency and whiteness of a Kalman filter's innovations.

use kestirim_replay::uav::Followed;

use super::{KALMAN, Line, seconds};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::systems::uav::track::Track;

/// The number of lags for which the autocorrelation is shown.
const LAGS: usize = 40;
/// The maximum number of innovations per output from which it is computed.
const MOST: usize = 50_000;
/// The number of time intervals over which the normalised innovations squared are averaged.
const STRETCHES: usize = 100;
/// The smallest value shown on a logarithmic axis.
const LEAST: f64 = 1e-3;
/// The number of standard deviations within which 95 % of a normal distribution lie.
const WITHIN: f64 = 1.96;

/// The normalised innovations of each output: one per line, `None` where it was not measured.
pub(super) fn normalised(followed: &Followed) -> Vec<Vec<Option<f64>>> {
    let outputs = followed.innovations.iter().zip(&followed.normalised);
    let of_output = |(innovations, normalised): (&Vec<Option<f64>>, &Vec<f64>)| {
        let mut next = normalised.iter().copied();
        innovations.iter().map(|innovation| innovation.and_then(|_| next.next())).collect()
    };
    outputs.map(of_output).collect()
}

/// The autocorrelation of a zero-mean sequence at lags from 1 on, and the number of products in the first one: r(k) is
/// the mean product of two values that are k lines apart, divided by the mean square (Mehra, *On the Identification of
/// Variances and Adaptive Kalman Filtering*, IEEE Trans. Automatic Control 15 (1970)). For white noise 95 % are within
/// ±1.96/√N.
pub(super) fn autocorrelation(innovations: &[Option<f64>]) -> (Vec<f64>, usize) {
    let squares = innovations.iter().flatten().map(|it| it * it);
    let count = squares.clone().count();
    let square = squares.sum::<f64>() / count.max(1) as f64;
    let at = |lag: usize| {
        let pairs = innovations.iter().zip(innovations.iter().skip(lag));
        let (sum, count) = pairs
            .filter_map(|(a, b)| Some(a.as_ref()? * b.as_ref()?))
            .fold((0.0, 0_usize), |(sum, count), product| (sum + product, count + 1));
        sum / count.max(1) as f64 / square.max(f64::MIN_POSITIVE)
    };
    ((1..=LAGS.min(count / 4)).map(at).collect(), count.saturating_sub(1))
}

/// The second half of a sequence, when the filter has settled.
pub(super) fn late<T>(values: &[T]) -> &[T] {
    &values[values.len() / 2..]
}

/// The autocorrelation of each output's innovations, with the bound of white noise.
pub(super) fn whiteness(ours: &Track, kalman: Option<&Track>) -> Figure {
    let all = kalman.map(|track| normalised(&track.followed)).unwrap_or_default();
    let interval = ours.flight.log.interval_s;
    let (mut series, mut fewest, mut lags) = (Vec::new(), usize::MAX, 0);
    for ((place, name), innovations) in ours.flight.names().enumerate().zip(&all) {
        let innovations = late(innovations);
        let (values, count) = autocorrelation(&innovations[..innovations.len().min(MOST)]);
        (fewest, lags) = (fewest.min(count), lags.max(values.len()));
        let points = values.into_iter().enumerate().map(|(k, it)| [(k + 1) as f64 * interval, it]);
        let line = Series::path(name, points).marked(Mark::LineAndPoints);
        series.push(line.coloured(Colour::Other(place)));
    }
    let bound = WITHIN / (fewest.max(1) as f64).sqrt();
    let end = lags as f64 * interval;
    let border = |name: &str, at: f64| {
        Series::path(name, [[0.0, at], [end, at]]).marked(Mark::Dashes).coloured(Colour::Limit)
    };
    Figure::new("whiteness", "Autocorrelation of the Kalman filter's innovations")
        .axes("lag, s", "autocorrelation")
        .caption(
            "Of the later half. A filter whose model and noise are right leaves white noise: 19 of 20 values within the broken lines. \
             What lasts is wind, a bias, another trim or aircraft.",
        )
        .with_all(series)
        .with(border("95 % bound of white noise", bound))
        .with(border("the same, below", -bound))
}

/// Normalised innovations squared per measurement, averaged over short intervals, with the bounds that contain 95 % of
/// them if model and noise are right (Bar-Shalom, Li & Kirubarajan, *Estimation with Applications to Tracking and
/// Navigation*, 2001, 5.4.2): those of χ² with as many degrees of freedom as measurements.
pub(super) fn nis(kalman: Option<&Track>) -> Figure {
    let (mut lines, mut means, mut bounds) =
        (Line::default(), Line::default(), [const { Vec::new() }; 2]);
    if let Some(track) = kalman {
        let all = normalised(&track.followed);
        let times: Vec<f64> =
            track.followed.estimates.iter().map(|it| seconds(track, it.t_us)).collect();
        let of_line = |line: usize| {
            let values = all.iter().filter_map(|output| *output.get(line)?);
            values.fold((0.0, 0_usize), |(sum, count), it| (sum + it * it, count + 1))
        };
        let squares: Vec<_> = (0..times.len()).map(of_line).collect();
        let known = times.iter().zip(&squares).filter(|(_, (_, count))| *count > 0);
        lines = known.map(|(t, (sum, count))| (*t, (sum / *count as f64).max(LEAST))).unzip();
        let length = times.len().div_ceil(STRETCHES).max(1);
        for (times, squares) in times.chunks(length).zip(squares.chunks(length)) {
            let [sum, count] =
                squares.iter().fold([0.0; 2], |[sum, count], it| [sum + it.0, count + it.1 as f64]);
            if count > 0.0 {
                means.0.push(times[0].midpoint(times[times.len() - 1]));
                means.1.push((sum / count).max(LEAST));
                for (bound, sign) in bounds.iter_mut().zip([-1.0, 1.0]) {
                    bound.push((chi_squared(count, sign * WITHIN) / count).max(LEAST));
                }
            }
        }
    }
    let [below, above] = bounds.map(|bound| (means.0.clone(), bound));
    let border =
        |name: &str, (x, y): Line| Series::new(name, Mark::Dashes, x, y).coloured(Colour::Limit);
    let (x, y) = lines;
    let (t, mean) = means;
    Figure::new("nis", "Normalised innovations squared of the Kalman filter")
        .over_seconds("NIS a measurement")
        .logarithmic()
        .caption(
            "1 on average if model and noise are right: above, the filter is surer than it may be; below, it is too cautious. 19 of 20 \
             means are within the broken lines.",
        )
        .with(Series::new("each line", Mark::Dots, x, y).coloured(Colour::Other(6)).hidden())
        .with(border("95 % bound, lower end", below))
        .with(border("95 % bound, upper end", above))
        .with(Series::new("mean of a stretch", Mark::LineAndPoints, t, mean).coloured(KALMAN.1))
}

/// The quantile of χ² with this many degrees of freedom that corresponds to the given number of standard deviations of
/// a normal distribution (Wilson & Hilferty, PNAS 17 (1931)).
fn chi_squared(freedom: f64, deviations: f64) -> f64 {
    let spread = 2.0 / (9.0 * freedom);
    freedom * (1.0 - spread + deviations * spread.sqrt()).max(0.0).powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_replay::uav::{Deviations, Estimate, Log, Model, Plant};
    use kestirim_simulate::random::{stream, uniform};

    /// Uniformly distributed noise of unit variance.
    fn white(count: usize) -> impl Iterator<Item = f64> {
        let mut random = stream(7, 0);
        (0..count).map(move |_| (uniform(&mut random) - 0.5) * 12.0_f64.sqrt())
    }

    #[test]
    fn white_noise_is_within_the_bound_and_what_lasts_is_not() {
        let noise: Vec<_> = white(4000).map(Some).collect();
        let (values, count) = autocorrelation(&noise);
        let bound = WITHIN / (count as f64).sqrt();
        let outside = |values: &[f64]| values.iter().filter(|it| it.abs() > bound).count();
        assert_eq!((values.len(), count), (LAGS, 3999));
        assert!(outside(&values) <= 5, "{values:?}");
        // A first-order process: r(k) = 0.6ᵏ.
        let mut last = 0.0;
        let lasting: Vec<_> = white(4000)
            .map(|noise| {
                last = 0.6 * last + noise;
                Some(last)
            })
            .collect();
        let (values, _) = autocorrelation(&lasting);
        for (k, value) in (1..).zip(&values[..4]) {
            assert!((value - 0.6_f64.powi(k)).abs() < 0.08 && *value > bound, "{value}");
        }
    }

    #[test]
    fn what_was_not_measured_is_in_no_product() {
        let halves: Vec<_> = (0..100).map(|k| (k % 2 == 0).then_some(1.0)).collect();
        let (values, _) = autocorrelation(&halves);
        assert_eq!(values[..4], [0.0, 1.0, 0.0, 1.0]);
        assert!(autocorrelation(&[]).0.is_empty());
    }

    #[test]
    fn chi_squared_is_that_of_the_tables() {
        for (freedom, low, high) in [(10.0, 3.247, 20.483), (100.0, 74.222, 129.561)] {
            let found = [-WITHIN, WITHIN].map(|it| chi_squared(freedom, it));
            assert!((found[0] / low - 1.0).abs() < 0.01, "{found:?}");
            assert!((found[1] / high - 1.0).abs() < 0.01, "{found:?}");
        }
    }

    #[test]
    fn noise_as_expected_is_between_the_bounds_and_larger_noise_above() {
        for (size, least, most) in [(1.0, 0.85, 1.0), (1.6, 0.0, 0.1)] {
            let values: Vec<f64> = white(5000).map(|it| size * it).collect();
            let estimate = |t_us: usize| Estimate {
                t_us: 10_000 * t_us as i64,
                state: nalgebra::SVector::zeros(),
                sigma: None,
            };
            let log = Log { outputs: vec![3], samples: Vec::new(), interval_s: 0.01, gaps: 0 };
            let followed = Followed {
                estimates: (0..values.len()).map(estimate).collect(),
                innovations: vec![values.iter().copied().map(Some).collect()],
                normalised: vec![values],
                ..Followed::default()
            };
            let flight = Deviations::simulated(Model::of(Plant::P2), log, Vec::new());
            let track = Track { flight, followed, warnings: Vec::new() };
            let figure = nis(Some(&track));
            let [_, below, above, mean] = figure.series.as_slice() else { panic!("{figure:?}") };
            let is_inside = |k: &usize| (below.y[*k]..=above.y[*k]).contains(&mean.y[*k]);
            let share = (0..mean.y.len()).filter(is_inside).count() as f64 / mean.y.len() as f64;
            assert!((least..=most).contains(&share), "{size}: {share}");
        }
    }
}
