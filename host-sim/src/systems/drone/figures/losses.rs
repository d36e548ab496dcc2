//! Path losses: measured, predicted, expected.

use kestirim_air_to_ground::{Channel, PathLoss};
use kestirim_replay::drone::{Cloud, Estimate, Stop, Track};
use rayon::prelude::*;

use crate::figure::{Colour, Figure, Mark, Series};
use crate::metrics::distance;
use crate::systems::drone::settings::expected_loss_db;

/// Of so many places of a cloud's sample one predicts.
const STRIDE: usize = 4;
/// Of the predicted losses are below the band and above it.
const TAIL: f64 = 0.025;
/// Times that the stretch in which a border of the band lies is halved.
const HALVINGS: usize = 14;

/// A loss that is one of several normal distributions: share, mean and deviation of each, dB.
struct Mixture(Vec<[f64; 3]>);

impl Mixture {
    /// Of the loss at a stop to a user of whom a cloud is known: with a line of sight or without, to each place.
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

    /// The loss below which so large a part of all lies.
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

/// Part of a standard normal distribution that is below a value, to 1e-7 (Abramowitz & Stegun, *Handbook of Mathematical Functions*,
/// 1964, 26.2.17).
fn normal_below(value: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * value.abs());
    let sum = [1.330_274_429, -1.821_255_978, 1.781_477_937, -0.356_563_782, 0.319_381_530];
    let sum = sum.into_iter().fold(0.0, |sum, factor| (sum + factor) * t);
    let above = (-0.5 * value * value).exp() / std::f64::consts::TAU.sqrt() * sum;
    if value > 0.0 { 1.0 - above } else { above }
}

/// What was predicted of a measurement before it was made, by what was believed after the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Predicted {
    /// Since the first measurement, s.
    t: f64,
    /// dB.
    measured: f64,
    /// 95 % are in between, dB.
    band: [f64; 2],
}

impl Predicted {
    /// Of all measurements but the first, if the channel is known.
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

    /// Share of the measurements that are in their bands; none of none.
    pub(super) fn share(all: &[Self]) -> Option<f64> {
        let inside = |it: &&Self| it.band[0] <= it.measured && it.measured <= it.band[1];
        let count = all.iter().filter(inside).count();
        (!all.is_empty()).then(|| count as f64 / all.len() as f64)
    }
}

/// What was measured, in which band it was predicted, and what the channel expects where it is known.
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
        // A quarter of the upper one is above: of it all but 0.6745 deviations.
        assert!((two.quantile(0.975) - 120.674).abs() < 0.01, "{}", two.quantile(0.975));
    }
}
