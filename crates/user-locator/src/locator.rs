use heapless::Vec;
use kestirim_air_to_ground::{Channel, Measurement};
use kestirim_particle_filter::{Moments, PointMass, Region, Update};
use kestirim_scalar::Scalar;

use crate::Error;

/// What is less than e⁻¹² of the largest density is given up when the lattice is laid anew.
const DEPTH: f64 = 12.0;
/// The lattice is laid anew when its weight is on less than this share of its points.
const SHARE: f64 = 0.12;
/// A lattice that is still too coarse is laid anew at once, at most so often.
const ROUNDS: usize = 4;

/// Finds a user who stays where they are: the posterior on a lattice of L points, which is laid anew, more
/// finely, where the posterior is.
///
/// A user who does not move leaves all measurements worth remembering: up to M of them are stored, and each new
/// lattice is weighed by all. Beyond M the lattice stays as it is. 4·L + 16·M bytes in single precision.
#[derive(Clone, Debug)]
pub struct Locator<T, const L: usize, const M: usize> {
    channel: Channel<T>,
    posterior: PointMass<T, 2, L>,
    measurements: Vec<Measurement<T>, M>,
    /// Measurements that could not be stored.
    forgotten: u32,
}

impl<T: Scalar, const L: usize, const M: usize> Locator<T, L, M> {
    /// A user who is equally likely to be anywhere in a region (m).
    #[inline]
    pub fn new(channel: Channel<T>, region: &Region<T, 2>) -> Self {
        Self { channel, posterior: PointMass::new(region), measurements: Vec::new(), forgotten: 0 }
    }

    /// Takes in a measurement.
    ///
    /// # Errors
    /// [`Error::Filter`] if nothing in the region explains it; then nothing has changed.
    pub fn measure(&mut self, measurement: &Measurement<T>) -> Result<Update<T>, Error> {
        let channel = &self.channel;
        let update = self.posterior.update(|user| channel.log_likelihood(measurement, user))?;
        if self.measurements.push(*measurement).is_err() {
            self.forgotten = self.forgotten.saturating_add(1);
        }
        if self.forgotten == 0 {
            self.refine();
        }
        Ok(update)
    }

    fn refine(&mut self) {
        let few = T::from_binary(L as i32, 0) * T::from_f64(SHARE);
        for _ in 0..ROUNDS {
            if self.posterior.effective() > few {
                return;
            }
            let (channel, measurements) = (&self.channel, &self.measurements);
            let refined = self
                .posterior
                .refine(T::from_f64(DEPTH), |user| log_posterior(channel, measurements, user));
            // A lattice that cannot be laid anew is still a posterior.
            if refined != Ok(true) {
                return;
            }
        }
    }

    /// Where the user is, and how well that is known.
    #[inline]
    pub fn moments(&self) -> Moments<T, 2> {
        self.posterior.moments()
    }

    /// The posterior itself.
    #[inline]
    pub fn posterior(&self) -> &PointMass<T, 2, L> {
        &self.posterior
    }

    /// Whether a place belongs to the smallest region that holds the user with this probability (0 to 1):
    /// where the density is highest. None once measurements have been forgotten.
    pub fn credible(&self, place: [T; 2], probability: T) -> Option<bool> {
        if self.forgotten > 0 {
            return None;
        }
        if !self.posterior.region().contains(&place) {
            return Some(false);
        }
        // The lattice knows densities relative to that of its heaviest point.
        let here = log_posterior(&self.channel, &self.measurements, place);
        let heaviest = self.posterior.point(self.posterior.heaviest())?;
        let most = log_posterior(&self.channel, &self.measurements, heaviest);
        Some(here - most >= self.posterior.density_level(probability))
    }
}

/// The logarithm of the posterior's density, without a constant.
#[inline(always)]
fn log_posterior<T: Scalar>(
    channel: &Channel<T>,
    measurements: &[Measurement<T>],
    user: [T; 2],
) -> T {
    let mut sum = T::ZERO;
    for measurement in measurements {
        sum += channel.log_likelihood(measurement, user);
    }
    sum
}
