use kestirim_air_to_ground::{Channel, Measurement};
use kestirim_particle_filter::{Moments, Particles, Region, Resampler, Start, Update};
use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::Error;
use crate::seen::Seen;

/// Parameters of the published filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PublishedSettings<T> {
    /// Resampling scheme.
    pub resampler: Resampler,
    /// The effective share of the particles below which they are resampled: `N_th/L`.
    pub threshold: T,
    /// Standard deviation of the jitter per coordinate and step, m.
    pub jitter: T,
}

impl<T: Scalar> PublishedSettings<T> {
    /// The settings of the published tables: systematic resampling, `N_th` = L/10, jitter of 10 m.
    #[inline]
    pub fn thesis() -> Self {
        Self {
            resampler: Resampler::Systematic,
            threshold: T::from_f64(0.1),
            jitter: T::from_f64(10.0),
        }
    }
}

/// The published particle filter (the thesis' Table 2.1).
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct PublishedLocator<T, const L: usize> {
    channel: Channel<T>,
    settings: PublishedSettings<T>,
    particles: Particles<T, 2, L>,
}

impl<T: Scalar, const L: usize> PublishedLocator<T, L> {
    /// Creates a filter with particles spread at random over a region (m).
    #[inline]
    pub fn new<R: Rng + ?Sized>(
        channel: Channel<T>,
        region: &Region<T, 2>,
        settings: PublishedSettings<T>,
        rng: &mut R,
    ) -> Self {
        let particles = Particles::new(Start::Random, region, rng);
        Self { channel, settings, particles }
    }

    /// Creates a filter as [`PublishedLocator::new`] does, with `count` particles.
    ///
    /// # Errors
    /// [`Error::Filter`] with `NotPositive` if `count` is zero, with `TooMany` if it exceeds L.
    #[inline]
    pub fn with_count<R: Rng + ?Sized>(
        count: usize,
        channel: Channel<T>,
        region: &Region<T, 2>,
        settings: PublishedSettings<T>,
        rng: &mut R,
    ) -> Result<Self, Error> {
        let particles = Particles::with_count(count, Start::Random, region, rng)?;
        Ok(Self { channel, settings, particles })
    }

    /// Processes a measurement: lines 5 to 15.
    ///
    /// # Errors
    /// [`Error::Filter`] if no particle explains it; nothing is changed.
    #[inline]
    pub fn measure<R: Rng + ?Sized>(
        &mut self,
        measurement: &Measurement<T>,
        rng: &mut R,
    ) -> Result<Update<T>, Error> {
        let update = self.particles.weigh(&Seen { channel: &self.channel, measurement })?;
        if update.effective
            < self.settings.threshold * T::from_binary(self.particles.len() as i32, 0)
        {
            self.particles.resample(self.settings.resampler, rng)?;
        }
        self.particles.jitter(&[self.settings.jitter; 2], rng);
        Ok(update)
    }

    /// Weighted mean and spread: lines 17 and 18.
    #[inline]
    pub fn moments(&self) -> Moments<T, 2> {
        self.particles.moments()
    }

    /// The particles.
    #[inline]
    pub fn particles(&self) -> &Particles<T, 2, L> {
        &self.particles
    }
}
