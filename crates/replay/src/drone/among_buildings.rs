//! Search through the thesis' channel, with as much additional shadowing as the measurements show.

use kestirim_air_to_ground::{Channel, Measurement};
use kestirim_particle_filter::Region;
use kestirim_user_locator::{Locator, Within};
use rayon::prelude::*;

use super::search::CALIBRATION_DB;
use super::{Cloud, EnvironmentKind, Estimate, MOST, MOST_CORNERS, POINTS, Quantity, Search};

/// The range of possible transmitter levels on either side of the nominal one, dB.
const LEVELS_DB: f64 = 100.0;
/// The number of levels over which the density is summed.
const LEVELS: usize = 41;
/// The range of possible common errors of path losses, in standard deviations of the calibration.
const LIKELY: f64 = 2.0;
/// Lower limits of the standard deviation of a measurement that are considered in addition to the thesis' own (a tenth
/// of a decibel below the drone, which no radio measures), dB.
const LEAST_SIGMAS_DB: [f64; 3] = [1.0, 2.0, 4.0];

/// The share below which a hypothesis does not enter the credible region; points lighter than the heaviest by `LIGHT`
/// (as a logarithm) do not either.
const LEAST_SHARE: f64 = 0.01;
const LIGHT: f64 = -12.0;
/// The common error of path losses that is at the edge of what is considered possible, dB.
pub(super) const FAR_OFF_DB: f64 = 0.8 * LIKELY * CALIBRATION_DB;

/// The thesis' channel for users within an area.
type ChannelWithin<'a> = Within<'a, f64, Channel<f64>, MOST_CORNERS>;
/// A locator of a user in the plane, with the common error of all path losses, dB, as third coordinate.
type UserLocator<'a> = Locator<f64, POINTS, MOST, 3, ChannelWithin<'a>>;

/// A search that assumes one lower limit of the measurements' standard deviation.
#[derive(Debug)]
struct Hypothesis<'a> {
    locator: Box<UserLocator<'a>>,
    /// Logarithm of the density of all measurements, up to a constant.
    evidence: f64,
}

/// The combined belief of all hypotheses.
struct Believed<'h, 'a> {
    hypotheses: &'h [Hypothesis<'a>],
    /// The weight of each hypothesis; they sum to 1.
    shares: Vec<f64>,
}

impl Search<'_> {
    /// Estimates through the thesis' channel.
    pub(super) fn among_buildings(
        &self,
        environment: EnvironmentKind,
        quantity: Quantity,
    ) -> Vec<Estimate> {
        let Ok(channel) = environment.channel_at(self.wavelength_m) else { return Vec::new() };
        let noisier =
            LEAST_SIGMAS_DB.iter().filter_map(|sigma| channel.with_least_sigma(*sigma).ok());
        let region = self.area.region();
        let within = match quantity {
            Quantity::PathLoss => LIKELY * CALIBRATION_DB,
            Quantity::Level => LEVELS_DB,
        };
        let [width, height] = *region.high();
        let corners = ([0.0, 0.0, -within], [width, height, within]);
        let Ok(region) = Region::new(corners.0, corners.1) else { return Vec::new() };
        let hypothesis = |channel| Hypothesis {
            locator: Box::new(Locator::new(Within::new(channel, &*self.area), &region)),
            evidence: 0.0,
        };
        self.follow(quantity, std::iter::once(channel).chain(noisier).map(hypothesis).collect())
    }

    fn follow(&self, quantity: Quantity, mut hypotheses: Vec<Hypothesis<'_>>) -> Vec<Estimate> {
        let mut estimates = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let Some(measurement) = self.measurement(stop) else { continue };
            let taken: Vec<bool> =
                hypotheses.par_iter_mut().map(|it| it.measure(&measurement)).collect();
            // A measurement that no hypothesis explains is left out.
            if !taken.contains(&true) {
                continue;
            }
            let mut taken = taken.into_iter();
            hypotheses.retain(|_| taken.next() == Some(true));
            let believed = Believed::of(&hypotheses);
            let ([x, y, off_db], [along, across, _]) = believed.moments();
            let last = number + 1 == self.stops.len();
            let truth = self.truth.get(number).filter(|_| last);
            let cloud = || {
                let cloud = Cloud::of_lattice(believed.heaviest()?.locator.posterior());
                Some(cloud.moved(self.origin))
            };
            estimates.push(Estimate {
                stop: number,
                first: 0,
                place: self.outward([x, y]),
                sd_m: along.hypot(across),
                // A received level is the negative loss: the more the transmitter sends, the smaller the loss.
                level_db: (quantity == Quantity::Level).then_some(-off_db),
                off_db,
                covered: truth.and_then(|truth| believed.covers(self.inward(*truth))),
                next: None,
                cloud: self.with_clouds.then(cloud).flatten(),
            });
        }
        estimates
    }
}

impl Hypothesis<'_> {
    /// Takes in a measurement; returns whether some place explains it.
    fn measure(&mut self, measurement: &Measurement<f64>) -> bool {
        let is_taken = self.locator.measure(measurement).is_ok();
        if is_taken {
            self.weigh();
        }
        is_taken
    }

    /// Updates the evidence: the mean of the likelihood over all places, which is zero outside the lattice.
    fn weigh(&mut self) {
        let posterior = self.locator.posterior();
        let volume: f64 = posterior.region().width().iter().product();
        let part = volume / posterior.len() as f64;
        let Some(state) = posterior.point(posterior.heaviest()) else { return };
        let heaviest = self.locator.log_posterior(&state);
        self.evidence = heaviest + (posterior.sum() * part).ln();
    }
}

impl<'h, 'a> Believed<'h, 'a> {
    fn of(hypotheses: &'h [Hypothesis<'a>]) -> Self {
        let all = log_sum(hypotheses.iter().map(|it| it.evidence));
        let shares = hypotheses.iter().map(|it| (it.evidence - all).exp()).collect();
        Self { hypotheses, shares }
    }

    fn heaviest(&self) -> Option<&'h Hypothesis<'a>> {
        self.hypotheses.iter().max_by(|a, b| a.evidence.total_cmp(&b.evidence))
    }

    /// Means and standard deviations of the place and of the level.
    fn moments(&self) -> ([f64; 3], [f64; 3]) {
        let all: Vec<_> = self.hypotheses.iter().map(|it| it.locator.moments()).collect();
        let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
            self.shares.iter().enumerate().map(|(index, share)| share * of(index)).sum()
        };
        let mean = [0, 1, 2].map(|axis| sum(&|index| all[index].mean()[axis]));
        let deviation = [0, 1, 2].map(|axis| {
            let square = |index: usize| {
                all[index].deviation()[axis].hypot(all[index].mean()[axis] - mean[axis])
            };
            sum(&|index| square(index).powi(2)).sqrt()
        });
        (mean, deviation)
    }

    /// Whether the 90 % region of places holds the true one. The level, the third coordinate, is integrated out, as the
    /// true one is unknown.
    fn covers(&self, truth: [f64; 2]) -> Option<bool> {
        let ([.., level], [.., deviation]) = self.moments();
        let levels: [f64; LEVELS] = std::array::from_fn(|k| {
            level + deviation * (8.0 * k as f64 / (LEVELS - 1) as f64 - 4.0)
        });
        let counting =
            self.hypotheses.iter().zip(&self.shares).filter(|(_, it)| **it > LEAST_SHARE);
        let counting: Vec<_> = counting.collect();
        let density = |place: [f64; 2]| {
            let of = |(hypothesis, _): &(&Hypothesis<'_>, _)| {
                hypothesis.locator.log_posterior_of_levels(place, &levels)
            };
            log_sum(counting.iter().flat_map(of))
        };
        let mut places = Vec::new();
        for (hypothesis, share) in &counting {
            let posterior = hypothesis.locator.posterior();
            let all = posterior.sum();
            let states = (0..posterior.len())
                .filter_map(|index| posterior.point(index).zip(posterior.log_weights().get(index)));
            let heavy = states.filter(|(_, log_weight)| **log_weight > LIGHT);
            // All hypotheses together contribute as many points as a single one would.
            let some = heavy.step_by(counting.len());
            places.extend(some.map(|([x, y, _], log)| ([x, y], *share * log.exp() / all)));
        }
        let mut points: Vec<(f64, f64)> =
            places.par_iter().map(|(place, weight)| (density(*place), *weight)).collect();
        points.sort_by(|a, b| b.0.total_cmp(&a.0));
        let all: f64 = points.iter().map(|(_, weight)| weight).sum();
        let mut sum = 0.0;
        let border = points.iter().find(|(_, weight)| {
            sum += weight;
            sum >= 0.9 * all
        });
        border.map(|(least, _)| density(truth) >= *least)
    }
}

/// The logarithm of the sum of exponentials.
fn log_sum(logs: impl Iterator<Item = f64>) -> f64 {
    let logs: Vec<f64> = logs.collect();
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest + logs.iter().map(|log| (log - largest).exp()).sum::<f64>().ln()
}
