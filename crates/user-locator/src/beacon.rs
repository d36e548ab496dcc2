use heapless::Vec;
use kestirim_air_to_ground::{FreeSpace, Measurement};
use kestirim_particle_filter::{Error as FilterError, Moments, PointMass, Region};
use kestirim_scalar::Scalar;

use crate::Error;

/// The power of the likelihood that makes credible regions honest: (1 − ρ)/(1 + ρ) for hovers whose shadowing
/// correlates by 0.82, as it does 20 m apart if it decays over 100 m.
const HONEST: f64 = 0.1;

/// Finds a transmitter of unknown power over open ground, from the levels received at hovers of a real flight.
///
/// Up to M measurements are stored; the posterior is computed from all of them on a lattice of L points when
/// it is asked for. 16·M bytes in single precision.
#[derive(Clone, Debug)]
pub struct Beacon<T, const M: usize> {
    channel: FreeSpace<T>,
    measurements: Vec<Measurement<T>, M>,
}

/// Where a [`Beacon`] is.
#[derive(Clone, Debug)]
pub struct BeaconEstimate<T, const L: usize> {
    /// The place, m: the mean of the posterior that takes measurements for independent. That is the sharper
    /// one, whose mean is not drawn to where nobody has flown; its width means nothing.
    pub place: [T; 2],
    /// The level received at one metre, dB.
    pub level: T,
    /// The posterior that allows for their correlation: for how well the place is known.
    pub posterior: PointMass<T, 2, L>,
    /// By which the posterior was computed.
    channel: FreeSpace<T>,
}

impl<T: Scalar, const L: usize> BeaconEstimate<T, L> {
    /// Mean and spread of the posterior that allows for correlation.
    pub fn moments(&self) -> Moments<T, 2> {
        self.posterior.moments()
    }
}

impl<T: Scalar, const M: usize> Beacon<T, M> {
    /// Without measurements.
    pub fn new(channel: FreeSpace<T>) -> Self {
        const { assert!(M <= 128, "the channel reads no more") };
        Self { channel, measurements: Vec::new() }
    }

    /// Takes in a measurement, of which the loss is the negative received level.
    ///
    /// # Errors
    /// [`Error::Filter`] with `TooMany` after M measurements; then nothing has changed.
    pub fn measure(&mut self, measurement: &Measurement<T>) -> Result<(), Error> {
        self.measurements.push(*measurement).map_err(|_| FilterError::TooMany.into())
    }

    /// Where in a region the transmitter is, if it is where `inside` says that it can be.
    ///
    /// # Errors
    /// [`Error::Filter`] with `Degenerate` if it can be nowhere.
    pub fn estimate<const L: usize>(
        &self,
        region: &Region<T, 2>,
        inside: impl Fn([T; 2]) -> bool,
    ) -> Result<BeaconEstimate<T, L>, Error> {
        let mut channel = self.channel;
        let mut posterior = sharp::<T, L>(&channel, &self.measurements, region, &inside)?;
        if let Some(likeliest) = posterior.point(posterior.heaviest()) {
            // Once more with the noise that the likeliest place leaves.
            channel = channel.fitted(&self.measurements, likeliest);
            posterior = sharp(&channel, &self.measurements, region, &inside)?;
        }
        let place = posterior.moments().mean();
        let level = channel.level(&self.measurements, place);
        let channel = channel.doubtful();
        let mut posterior = PointMass::new(region);
        posterior.update(|place| {
            let honest = T::from_f64(HONEST);
            log_posterior(&channel, &self.measurements, place, honest, &inside)
        })?;
        Ok(BeaconEstimate { place, level, posterior, channel })
    }

    /// Whether a place belongs to the smallest region that holds the transmitter with this probability.
    pub fn credible<const L: usize>(
        &self,
        estimate: &BeaconEstimate<T, L>,
        place: [T; 2],
        probability: T,
    ) -> bool {
        let channel = &estimate.channel;
        let density =
            |place| channel.log_likelihood(&self.measurements, place, T::from_f64(HONEST));
        let posterior = &estimate.posterior;
        let Some(heaviest) = posterior.point(posterior.heaviest()) else { return false };
        posterior.region().contains(&place)
            && density(place) - density(heaviest) >= posterior.density_level(probability)
    }
}

/// The posterior that takes measurements for independent.
fn sharp<T: Scalar, const L: usize>(
    channel: &FreeSpace<T>,
    measurements: &[Measurement<T>],
    region: &Region<T, 2>,
    inside: &impl Fn([T; 2]) -> bool,
) -> Result<PointMass<T, 2, L>, FilterError> {
    let weigh = |place| log_posterior(channel, measurements, place, T::ONE, inside);
    let mut posterior = PointMass::<T, 2, L>::new(region);
    posterior.update(weigh)?;
    while let Some(mut finer) = posterior.finer(T::from_f64(12.0)) {
        finer.update(weigh)?;
        posterior = finer;
        if posterior.effective() > T::from_binary(L as i32, 0) * T::from_f64(0.05) {
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
