//! Figures of path losses: measured, predicted and expected.

use kestirim_air_to_ground::{Channel, PathLoss};
use kestirim_replay::drone::{Cloud, Estimate, Stop, Track};
use rayon::prelude::*;

use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::distance;
use crate::systems::drone::settings::expected_loss_db;

/// One in this many positions of a cloud's sample is used for the prediction.
const STRIDE: usize = 4;
/// The probability below the band of predicted losses, and that above it.
const TAIL: f64 = 0.025;
/// The number of bisection steps that locate a border of the band.
const HALVINGS: usize = 14;

/// A loss distributed as a mixture of normal distributions: weight, mean and standard deviation (dB) of each.
struct Mixture(Vec<[f64; 3]>);

impl Mixture {
    /// The distribution of the loss between a stop and a user with the given cloud: to each position, with and without
    /// a line of sight.
    fn of(channel: &Channel<f64>, cloud: &Cloud, stop: &Stop) -> Option<Self> {
        let to = |place: &[f32; 2]| {
            channel.path_loss(distance(stop.place, place.map(f64::from)), stop.height).ok()
        };
        let parts = |it: PathLoss<f64>| {
            let clear = it.line_of_sight_probability;
            [
                [clear, it.line_of_sight_mean, it.line_of_sight_sigma],
                [1.0 - clear, it.obstructed_mean, it.obstructed_sigma],
            ]
        };
        let parts: Vec<_> =
            cloud.sample.iter().step_by(STRIDE).filter_map(to).flat_map(parts).collect();
        (!parts.is_empty()).then_some(Self(parts))
    }

    /// The quantile of the distribution for a probability of `part`.
    fn quantile(&self, part: f64) -> f64 {
        let all: f64 = self.0.iter().map(|[share, ..]| share).sum();
        let end = |sign: f64| {
            let ends = self.0.iter().map(|[_, mean, sigma]| sign * mean + 6.0 * sigma);
            sign * ends.fold(f64::NEG_INFINITY, f64::max)
        };
        let (mut low, mut high) = (end(-1.0), end(1.0));
        for _ in 0..HALVINGS {
            let middle = low.midpoint(high);
            let below =
                |[share, mean, sigma]: &[f64; 3]| share * normal_below((middle - mean) / sigma);
            let is_above = self.0.iter().map(below).sum::<f64>() > part * all;
            *(if is_above { &mut high } else { &mut low }) = middle;
        }
        low.midpoint(high)
    }
}

/// The standard normal distribution function, to 1e-7 (Abramowitz & Stegun, *Handbook of Mathematical Functions*, 1964,
/// 26.2.17).
fn normal_below(value: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * value.abs());
    let sum = [1.330_274_429, -1.821_255_978, 1.781_477_937, -0.356_563_782, 0.319_381_530];
    let sum = sum.into_iter().fold(0.0, |sum, factor| (sum + factor) * t);
    let above = (-0.5 * value * value).exp() / std::f64::consts::TAU.sqrt() * sum;
    if value > 0.0 { 1.0 - above } else { above }
}

/// The prediction of a measurement before it was made, from the belief after the previous one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Predicted {
    /// The time since the first measurement (s).
    t: f64,
    /// The measured loss (dB).
    measured: f64,
    /// The band that holds 95 % of the predicted distribution (dB).
    band: [f64; 2],
}

impl Predicted {
    /// The predictions of all measurements but the first, if the channel is known.
    pub(super) fn of(track: &Track, channel: Option<&Channel<f64>>) -> Vec<Self> {
        let Some(channel) = channel else { return Vec::new() };
        let one = |pair: &[Estimate]| {
            let [before, after] = pair else { return None };
            let stop = track.stop(after);
            let mixture = Mixture::of(channel, before.cloud.as_ref()?, &stop)?;
            let band = [TAIL, 1.0 - TAIL].map(|part| mixture.quantile(part));
            Some(Self { t: track.seconds(after), measured: stop.loss, band })
        };
        track.estimates.par_windows(2).filter_map(one).collect()
    }

    /// The share of measurements inside their bands; `None` if there are none.
    pub(super) fn share(all: &[Self]) -> Option<f64> {
        let inside = |it: &&Self| it.band[0] <= it.measured && it.measured <= it.band[1];
        let count = all.iter().filter(inside).count();
        (!all.is_empty()).then(|| count as f64 / all.len() as f64)
    }
}

/// The figure of measured losses, predicted bands, and the losses that the channel expects if the true position is
/// known.
pub(super) fn figure(
    track: &Track,
    channel: Option<&Channel<f64>>,
    predicted: &[Predicted],
) -> Figure {
    let begin = track.stops.first().map_or(0.0, |stop| stop.t);
    let (times, losses) = track.stops.iter().map(|stop| (stop.t - begin, stop.loss)).unzip();
    let expected = |name: &str, place: &dyn Fn(&Estimate) -> Option<[f64; 2]>, colour| {
        let points = track.estimates.iter().filter_map(|estimate| {
            let loss = expected_loss_db(channel?, &track.stop(estimate), place(estimate)?)?;
            Some([track.seconds(estimate), loss])
        });
        channel.map(|_| Series::path(name, points).coloured(colour))
    };
    let band = |end: usize| {
        let points = predicted.iter().map(|it| [it.t, it.band[end]]);
        let name = ["95 % band, lower end", "95 % band, upper end"][end];
        channel.map(|_| Series::path(name, points).marked(Mark::Dashes).coloured(Colour::Limit))
    };
    Figure::new("path-loss", "Path loss")
        .over_seconds("path loss, or negative level, dB")
        .caption(
            "The band was predicted before the measurement, by what was believed till then: one in twenty is beside it. What is \
             expected is the channel's mean, with and without a line of sight.",
        )
        .with_all(band(0))
        .with_all(band(1))
        .with(Series::new("measured", Mark::Dots, times, losses).coloured(Colour::Other(4)))
        .with_all(expected("expected at the user", &|it| track.user(it), Colour::Truth))
        .with_all(expected("expected at the estimate", &|it| Some(it.place), Colour::Ours))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_a_normal_distribution_and_of_two() {
        let one = Mixture(vec![[1.0, 100.0, 2.0]]);
        for (part, known) in [(0.025, 96.08), (0.5, 100.0), (0.975, 103.92)] {
            assert!((one.quantile(part) - known).abs() < 0.01, "{part}");
        }
        let two = Mixture(vec![[0.9, 100.0, 1.0], [0.1, 120.0, 1.0]]);
        // A quarter of the upper component lies above it, which is at 0.6745 deviations above its mean.
        assert!((two.quantile(0.975) - 120.674).abs() < 0.01, "{}", two.quantile(0.975));
    }
}
