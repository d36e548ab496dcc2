//! Tests whether measurements are what an environment predicts.

use kestirim_air_to_ground::Channel;

use super::{Estimate, Quantity, Stop};
use crate::clipped::Clipped;
use crate::metrics::{distance, rms};

/// The fewest measurements that are tested: fewer fit any environment at some place.
const FEWEST: usize = 8;
/// The limit to which deviations are clipped, in sigmas: a path that is obstructed where hardly any is lies ten sigmas
/// and more off.
const FARTHEST: f64 = 4.0;
/// The variance of the squared ratio of a deviation to its sigma: 2 for a normal distribution, up to this for a mixture
/// of two.
const SPREAD: f64 = 8.0;
/// The number of its own standard deviations by which the mean square must be off.
const CLEAR: f64 = 5.0;
/// The correlation of successive deviations that is tolerated, although an environment's are independent: shadowing
/// lasts a little.
const LASTING: f64 = 0.3;
/// The mean square of deviations over their sigmas below which they may be correlated: measurements without noise leave
/// rounding errors.
const NEGLIGIBLE: f64 = 0.01;
/// The number of its own standard deviations by which the correlation must be off.
const CLEARLY_LASTING: f64 = 3.0;

/// The deviations of measurements from an environment that does not explain them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Misfit {
    /// Root mean square of the deviations, dB.
    pub found_db: f64,
    /// The root mean square deviation that the environment explains, dB.
    pub expected_db: f64,
    /// Whether the deviations are too large; otherwise they last too long, from measurement to measurement.
    pub is_large: bool,
    /// The correlation of successive deviations; the environment predicts none.
    pub next: f64,
}

impl Misfit {
    /// Tests measurements, in their order, as seen from the estimated place of the user; `None` if the environment's
    /// channel explains them.
    pub fn find(stops: &[Stop], estimate: &Estimate, channel: &Channel<f64>) -> Option<Self> {
        let deviation = |stop: &Stop| {
            let far = distance(stop.place, estimate.place);
            let expected = channel.path_loss(far, stop.height).ok()?;
            Some((stop.loss - estimate.off_db - expected.mean(), expected.sigma()))
        };
        let (deviations, sigmas): (Vec<_>, Vec<_>) = stops.iter().filter_map(deviation).unzip();
        let count = deviations.len();
        if count < FEWEST {
            return None;
        }
        let ratios = deviations.iter().zip(&sigmas).map(|(off, sigma)| off / sigma);
        let Clipped { square, product } = Clipped::of(ratios, FARTHEST);
        let is_large = square > 1.0 + CLEAR * (SPREAD / count as f64).sqrt();
        let next = product / square.max(f64::MIN_POSITIVE);
        let is_lasting =
            square > NEGLIGIBLE && next > LASTING + CLEARLY_LASTING / (count as f64).sqrt();
        let [found_db, expected_db] = [rms(&deviations), rms(&sigmas)];
        (is_large || is_lasting).then_some(Self { found_db, expected_db, is_large, next })
    }

    /// The misfit in a sentence, with the name of the environment.
    pub fn sentence(&self, environment: &str, quantity: Quantity) -> String {
        let Self { found_db, expected_db, is_large, next } = self;
        let off = if *is_large {
            format!(
                "the measurements are {found_db:.1} dB off what {environment} explains ({expected_db:.1} dB)"
            )
        } else {
            format!(
                "the measurements are off what {environment} explains in the same way for long (correlation {next:.2})"
            )
        };
        let instead = match quantity {
            Quantity::PathLoss => "--frequency may be another",
            Quantity::Level => "--environment open assumes less",
        };
        format!("{off}: place and deviation are not to be relied upon, {instead}")
    }
}
