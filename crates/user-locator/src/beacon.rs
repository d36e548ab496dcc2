use heapless::Vec;
use kestirim_air_to_ground::{FreeSpace, Measurement};
use kestirim_particle_filter::{Error as FilterError, Moments, PointMass, Region};
use kestirim_scalar::Scalar;

use crate::level_step::health;
use crate::{Error, Health};

/// The power to which the likelihood is raised so that credible regions have their nominal coverage: (1 − ρ)/(1 + ρ)
/// for hovers whose shadowing has the correlation ρ = 0.82, as 20 m apart with a correlation length of 100 m.
const COMPOSITE_POWER: f64 = 0.1;
/// Points whose log-weight is this far below the heaviest one's lie outside of a finer lattice.
const DEPTH: f64 = 12.0;
/// A lattice is refined until its effective number of points is more than this fraction of them.
const FEWEST: f64 = 0.05;

/// Locates a transmitter of unknown power over open ground, from the levels received at hovers of a real flight.
///
/// Up to M measurements are stored; the posterior is computed from all of them, on a lattice of L points, on request.
/// 16·M bytes in single precision.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Beacon<T, const M: usize> {
    channel: FreeSpace<T>,
    measurements: Vec<Measurement<T>, M>,
}

/// The estimate of a [`Beacon`].
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct BeaconEstimate<T, const L: usize> {
    /// The estimated place, m: the mean of the posterior that treats measurements as independent. This is the sharper
    /// posterior, whose mean is not drawn to areas without measurements; its width has no meaning.
    pub place: [T; 2],
    /// The level received at one metre, dB.
    pub level: T,
    /// The posterior that allows for correlated measurements, which represents the uncertainty of the place.
    pub posterior: PointMass<T, 2, L>,
    /// The channel with which the posterior was computed.
    channel: FreeSpace<T>,
}

impl<T: Scalar, const L: usize> BeaconEstimate<T, L> {
    /// Mean and spread of the posterior that allows for correlated measurements.
    pub fn moments(&self) -> Moments<T, 2> {
        self.posterior.moments()
    }

    /// Standard deviation of the place, m: that of the posterior about the place, which is not quite its mean.
    pub fn sigma(&self) -> T {
        let moments = self.moments();
        let [x, y] = moments.mean();
        T::norm(&[moments.spread(), x - self.place[0], y - self.place[1]])
    }

    /// The estimate from all measurements, restricted to places in `region` that are `inside`.
    pub(crate) fn of(
        mut channel: FreeSpace<T>,
        measurements: &[Measurement<T>],
        region: &Region<T, 2>,
        inside: impl Fn([T; 2]) -> bool,
    ) -> Result<Self, Error> {
        let mut posterior = refined::<T, L>(&channel, measurements, region, T::ONE, &inside)?;
        if let Some(likeliest) = posterior.point(posterior.heaviest()) {
            // Again with the noise scale that the residuals at the likeliest place suggest.
            channel = channel.fitted(measurements, likeliest);
            posterior = refined(&channel, measurements, region, T::ONE, &inside)?;
        }
        let place = posterior.moments().mean();
        let level = channel.level(measurements, place);
        let channel = channel.doubtful();
        let power = T::from_f64(COMPOSITE_POWER);
        let posterior = refined(&channel, measurements, region, power, &inside)?;
        Ok(Self { place, level, posterior, channel })
    }

    /// Whether a place belongs to the smallest credible region of this probability, given the measurements of the
    /// estimate.
    pub(crate) fn is_credible(
        &self,
        measurements: &[Measurement<T>],
        place: [T; 2],
        probability: T,
    ) -> bool {
        let density =
            |place| self.channel.log_likelihood(measurements, place, T::from_f64(COMPOSITE_POWER));
        let posterior = &self.posterior;
        let Some(heaviest) = posterior.point(posterior.heaviest()) else { return false };
        posterior.region().contains(&place)
            && density(place) - density(heaviest) >= posterior.density_level(probability)
    }
}

impl<T: Scalar, const M: usize> Beacon<T, M> {
    /// Creates a beacon without measurements.
    pub fn new(channel: FreeSpace<T>) -> Self {
        const { assert!(M <= 128, "the channel reads no more") };
        Self { channel, measurements: Vec::new() }
    }

    /// Adds a measurement, whose loss is the negative received level.
    ///
    /// # Errors
    /// [`Error::Filter`] with `TooMany` after M measurements; then nothing has changed.
    pub fn measure(&mut self, measurement: &Measurement<T>) -> Result<(), Error> {
        self.measurements.push(*measurement).map_err(|_| FilterError::TooMany.into())
    }

    /// The posterior of the transmitter's place in a region, restricted to places that are `inside`.
    ///
    /// # Errors
    /// [`Error::Filter`] with `Degenerate` if no place explains the measurements.
    pub fn estimate<const L: usize>(
        &self,
        region: &Region<T, 2>,
        inside: impl Fn([T; 2]) -> bool,
    ) -> Result<BeaconEstimate<T, L>, Error> {
        BeaconEstimate::of(self.channel, &self.measurements, region, inside)
    }

    /// Whether a place belongs to the smallest region that contains the transmitter with this probability, given what is `inside`, as
    /// for the estimate.
    pub fn credible<const L: usize>(
        &self,
        estimate: &BeaconEstimate<T, L>,
        place: [T; 2],
        probability: T,
        inside: impl Fn([T; 2]) -> bool,
    ) -> bool {
        inside(place) && estimate.is_credible(&self.measurements, place, probability)
    }

    /// Whether an estimate from these measurements is reliable: reports `innovations` if their levels show a step
    /// ([`LevelStep`](crate::LevelStep)) as seen from the estimated place.
    pub fn health<const L: usize>(&self, estimate: &BeaconEstimate<T, L>) -> Health {
        health(&self.measurements, estimate.place)
    }
}

/// The posterior of a likelihood raised to this power, on a lattice that is refined until it resolves it.
fn refined<T: Scalar, const L: usize>(
    channel: &FreeSpace<T>,
    measurements: &[Measurement<T>],
    region: &Region<T, 2>,
    power: T,
    inside: &impl Fn([T; 2]) -> bool,
) -> Result<PointMass<T, 2, L>, FilterError> {
    let weigh = |place| log_posterior(channel, measurements, place, power, inside);
    let mut posterior = PointMass::<T, 2, L>::new(region);
    posterior.update(weigh)?;
    let fewest = T::from_binary(L as i32, 0) * T::from_f64(FEWEST);
    while let Some(mut finer) = posterior.finer(T::from_f64(DEPTH)) {
        finer.update(weigh)?;
        posterior = finer;
        if posterior.effective() > fewest {
            break;
        }
    }
    Ok(posterior)
}

fn log_posterior<T: Scalar>(
    channel: &FreeSpace<T>,
    measurements: &[Measurement<T>],
    place: [T; 2],
    power: T,
    inside: &impl Fn([T; 2]) -> bool,
) -> T {
    if inside(place) { channel.log_likelihood(measurements, place, power) } else { T::ZERO.ln() }
}
