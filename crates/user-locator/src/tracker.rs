use core::f64::consts::FRAC_1_SQRT_2;

use kestirim_air_to_ground::{Channel, Likelihood, Measurement};
use kestirim_particle_filter::{
    Error as FilterError, Moments, Particles, Region, Resampler, Start, Update,
};
use kestirim_scalar::Scalar;
use rand_core::Rng;

use crate::Error;
use crate::seen::Seen;

/// Motion model of a user, and the threshold at which the filter counts as diverged.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Motion<T> {
    /// Initial standard deviation of each component of a user's velocity, m/s.
    pub speed: T,
    /// Process noise of the velocity: standard deviation after one second, m/s.
    pub velocity_noise: T,
    /// Process noise of the place: standard deviation after one second, m.
    pub place_noise: T,
    /// Roughening: the minimum noise of a step as a fraction of the cloud's own spread, so that a cloud that is still
    /// wide does not commit itself to a velocity.
    pub roughening: T,
    /// Threshold of the mean log-evidence (density per dB) over about the last ten measurements, below which the
    /// cloud is spread anew; `None` disables this.
    pub least_evidence: Option<T>,
}

impl<T: Scalar> Motion<T> {
    /// People on foot or by bicycle, with the thesis' channel unchanged: losses are measured to a quarter of a
    /// decibel from nearby.
    #[inline]
    pub fn people() -> Self {
        Self {
            speed: T::from_f64(1.2),
            velocity_noise: T::from_f64(0.053_7),
            place_noise: T::from_f64(1.79),
            roughening: T::from_f64(0.1),
            least_evidence: Some(T::from_f64(-4.0)),
        }
    }

    /// People on foot or by bicycle, with losses measured to `sigma` (dB) at best: see
    /// [`Channel::with_least_sigma`](kestirim_air_to_ground::Channel::with_least_sigma). Less precise measurements
    /// have smaller densities, and the threshold is lowered accordingly.
    #[inline]
    pub fn people_measured_to(sigma: T) -> Self {
        let quarters = (sigma * T::from_f64(4.0)).max(T::ONE);
        let people = Self::people();
        Self { least_evidence: people.least_evidence.map(|least| least - quarters.ln()), ..people }
    }
}

/// Tracks a moving user with a Rao–Blackwellised particle filter.
///
/// Each particle is a place and the mean velocity implied by its own path; the variance of the velocity is the same
/// for all, because it follows a Kalman filter whose measurements are the drawn steps (Schön, Gustafsson and
/// Nordlund, IEEE Trans. Signal Processing 53(7), 2005). A cloud of places *and* velocities would need many times as
/// many particles, and diverges from a start in which neither is known. 28·L bytes in single precision.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, C: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>, C: serde::Deserialize<'de>"
    ))
)]
pub struct Tracker<T, const L: usize, C = Channel<T>> {
    channel: C,
    motion: Motion<T>,
    region: Region<T, 2>,
    /// The particles: place (m) and mean velocity (m/s).
    particles: Particles<T, 4, L>,
    /// Standard deviation of each component of the velocity, m/s.
    velocity_deviation: T,
    /// The estimate at the last measurement.
    estimate: TrackEstimate<T>,
    /// Running mean of the log-evidence.
    evidence: T,
}

/// The place and velocity of a user.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TrackEstimate<T> {
    /// Place at the time of the last measurement, m.
    pub place: [T; 2],
    /// Velocity, m/s.
    pub velocity: [T; 2],
    /// Root mean square distance of the cloud from the place, m.
    pub spread: T,
}

impl<T, C, const L: usize> Tracker<T, L, C>
where
    T: Scalar,
    C: Likelihood<T>,
{
    /// Creates a tracker for a user who is equally likely to be anywhere in a region (m).
    #[inline]
    pub fn new<R: Rng + ?Sized>(
        channel: C,
        motion: Motion<T>,
        region: &Region<T, 2>,
        rng: &mut R,
    ) -> Self {
        let particles = Particles::new(Start::QuasiRandom, &region.extended(), rng);
        Self::of(particles, channel, motion, region)
    }

    /// Creates a tracker as [`Tracker::new`] does, with `count` particles.
    ///
    /// # Errors
    /// [`Error::Filter`] with `NotPositive` if `count` is zero, with `TooMany` if it exceeds L.
    #[inline]
    pub fn with_count<R: Rng + ?Sized>(
        count: usize,
        channel: C,
        motion: Motion<T>,
        region: &Region<T, 2>,
        rng: &mut R,
    ) -> Result<Self, Error> {
        let region_of_states = region.extended();
        let particles = Particles::with_count(count, Start::QuasiRandom, &region_of_states, rng)?;
        Ok(Self::of(particles, channel, motion, region))
    }

    fn of(
        particles: Particles<T, 4, L>,
        channel: C,
        motion: Motion<T>,
        region: &Region<T, 2>,
    ) -> Self {
        let estimate = Self::look(&particles);
        Self {
            channel,
            motion,
            region: *region,
            particles,
            velocity_deviation: motion.speed,
            estimate,
            evidence: T::ZERO,
        }
    }

    /// Predicts over `interval` (s).
    ///
    /// # Errors
    /// [`Error::Filter`] with `NotFinite`, or `NotPositive` for a negative interval; nothing is changed.
    pub fn predict<R: Rng + ?Sized>(&mut self, interval: T, rng: &mut R) -> Result<(), Error> {
        if !interval.is_finite() {
            return Err(FilterError::NotFinite.into());
        }
        if interval < T::ZERO {
            return Err(FilterError::NotPositive.into());
        }
        let motion = &self.motion;
        let root = interval.sqrt();
        // Per coordinate: the spread is that of both.
        let roughening = motion.roughening * self.estimate.spread * T::from_f64(FRAC_1_SQRT_2);
        let place_noise = (motion.place_noise * root).max(roughening);
        let drift = self.velocity_deviation * interval;
        // A step's standard deviation is √(drift² + place_noise²); the Kalman gain tells how much of it is velocity.
        let step = T::norm(&[drift, place_noise]).max(T::EPSILON);
        let share = drift / step;
        let gain = share * (self.velocity_deviation / step);
        self.particles.predict(
            |[x, y, vx, vy], [nx, ny]| {
                let (dx, dy) = (nx * step, ny * step);
                [x + vx * interval + dx, y + vy * interval + dy, vx + gain * dx, vy + gain * dy]
            },
            rng,
        );
        let remaining = self.velocity_deviation * (T::ONE - share * share).max(T::ZERO).sqrt();
        self.velocity_deviation = T::norm(&[remaining, motion.velocity_noise * root]);
        Ok(())
    }

    /// Processes a measurement of the present time.
    ///
    /// # Errors
    /// [`Error::Filter`] with `Degenerate` if no particle explains it; nothing is changed, but if the last measurements
    /// have not been explained either, the cloud is spread anew.
    pub fn measure<R: Rng + ?Sized>(
        &mut self,
        measurement: &Measurement<T>,
        rng: &mut R,
    ) -> Result<Update<T>, Error> {
        let weighed = self.particles.weigh(&Seen { channel: &self.channel, measurement });
        match &weighed {
            Ok(update) => self.judge(update.log_evidence, rng),
            Err(FilterError::Degenerate) => self.judge(T::MIN, rng),
            Err(_) => (),
        }
        let update = weighed?;
        if self.particles.effective() < T::from_binary(self.particles.len() as i32, 0) * T::HALF {
            self.particles.resample(Resampler::Systematic, rng)?;
        }
        self.estimate = Self::look(&self.particles);
        Ok(update)
    }

    /// Spreads the cloud anew if it has not explained the last measurements.
    fn judge<R: Rng + ?Sized>(&mut self, log_evidence: T, rng: &mut R) {
        // A single measurement must not trigger it.
        let evidence = log_evidence.max(-T::from_f64(20.0));
        self.evidence += (evidence - self.evidence) * T::from_f64(0.1);
        if self.motion.least_evidence.is_some_and(|least| self.evidence < least) {
            self.particles.spread(Start::Random, &self.region.extended(), rng);
            self.velocity_deviation = self.motion.speed;
            self.evidence = T::ZERO;
            self.estimate = Self::look(&self.particles);
        }
    }

    fn look(particles: &Particles<T, 4, L>) -> TrackEstimate<T> {
        let moments = particles.moments_of(place);
        let velocity = particles.mean_of(|[.., vx, vy]| [vx, vy]);
        TrackEstimate { place: moments.mean(), velocity, spread: moments.spread() }
    }

    /// Place and velocity at the last measurement.
    #[inline]
    pub fn estimate(&self) -> TrackEstimate<T> {
        self.estimate
    }

    /// The present mean and spread of the place.
    #[inline]
    pub fn moments(&self) -> Moments<T, 2> {
        self.particles.moments_of(place)
    }

    /// The particles: place (m) and mean velocity (m/s).
    #[inline]
    pub fn particles(&self) -> &Particles<T, 4, L> {
        &self.particles
    }
}

#[inline(always)]
fn place<T>([x, y, ..]: [T; 4]) -> [T; 2] {
    [x, y]
}
