//! One trial of a user who stays: all filters on the same measurements.

use kestirim_air_to_ground::{Channel, Measurement};
use kestirim_particle_filter::{Likelihood, PointMass};
use kestirim_replay::ScalarKind;
use kestirim_scalar::{Q16_16, Scalar};

use super::static_user::{Flight, Geometry, MOST, PublishedFilter, square};

/// Filters of no more particles than this are kept in less memory, which stays in the cache.
const FEW: usize = 1024;
/// Points of the lattice that stands for the exact posterior.
const DENSE: usize = 640;

/// Which filters are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// On these measurements.
    pub geometry: Geometry,
    /// The thesis' filters.
    pub published: Vec<PublishedFilter>,
    /// Numbers of points of our filters.
    pub bests: Vec<usize>,
    /// Whether the exact posterior is wanted.
    pub limit: bool,
}

/// What came out of a trial, m.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outcome {
    /// Errors of the thesis' filters.
    pub published: Vec<f64>,
    /// Errors of ours.
    pub bests: Vec<f64>,
    /// Error of the exact posterior's mean; 0 if it was not wanted.
    pub limit: f64,
    /// Measurements that a filter refused.
    pub refused: u32,
    /// Of our first filter, whether its 90 % region holds the user.
    pub credible: bool,
}

impl Job {
    /// Names of the numbers of an outcome.
    pub fn columns(&self) -> Vec<String> {
        let published = self.published.iter().map(|PublishedFilter { particles, resampler }| {
            format!("published {particles} {resampler:?}_m")
        });
        let bests = self.bests.iter().map(|points| format!("best {points}_m"));
        let first = ["limit_m", "refused", "credible"].map(str::to_owned);
        first.into_iter().chain(published).chain(bests).collect()
    }
}

impl Outcome {
    /// As a row of numbers, in the order of [`Job::columns`].
    pub fn numbers(&self) -> Vec<f64> {
        let first = [self.limit, f64::from(self.refused), f64::from(self.credible)];
        [&first[..], &self.published, &self.bests].concat()
    }

    /// From a row of numbers of a job; what is not there is 0.
    pub fn of_numbers(job: &Job, row: &[f64]) -> Self {
        let mut row = row.iter().copied();
        let mut next = || row.next().unwrap_or_default();
        let (limit, refused, credible) = (next(), next() as u32, next() != 0.0);
        let published = job.published.iter().map(|_| next()).collect();
        let bests = job.bests.iter().map(|_| next()).collect();
        Self { published, bests, limit, refused, credible }
    }
}

/// One user, one flight.
pub fn trial(job: &Job, scalar: ScalarKind, seed: u64, index: u64) -> Outcome {
    match scalar {
        ScalarKind::F32 => with_scalar::<f32>(job, seed, index),
        ScalarKind::F64 => with_scalar::<f64>(job, seed, index),
        ScalarKind::Fixed => with_scalar::<Q16_16>(job, seed, index),
    }
}

fn with_scalar<T: Scalar>(job: &Job, seed: u64, index: u64) -> Outcome {
    let flight = Flight::new(&job.geometry, seed, index);
    let mut outcome = Outcome::default();
    for filter in &job.published {
        let (error, refused) = if filter.particles <= FEW {
            flight.by_published::<T, FEW>(*filter)
        } else {
            flight.by_published::<T, MOST>(*filter)
        };
        outcome.published.push(error);
        outcome.refused += refused;
    }
    for (place, &points) in job.bests.iter().enumerate() {
        let found = if points <= FEW {
            flight.by_best::<T, FEW>(points, place == 0)
        } else {
            flight.by_best::<T, MOST>(points, place == 0)
        };
        outcome.bests.push(found.error);
        outcome.refused += found.refused;
        outcome.credible |= found.credible;
    }
    outcome.limit = if job.limit { flight.exact() } else { 0.0 };
    outcome
}

/// What our filter found.
struct Found {
    error: f64,
    refused: u32,
    credible: bool,
}

/// A path loss: how likely it is with the user at a place.
struct Loss<'a> {
    channel: &'a Channel<f32>,
    measurement: &'a Measurement<f32>,
}

impl Likelihood<f32, 2> for Loss<'_> {
    #[inline(always)]
    fn logarithm(&self, user: [f32; 2]) -> f32 {
        self.channel.log_likelihood(self.measurement, user)
    }
}

impl Flight<'_> {
    /// Error of the thesis' filter, and how many measurements it refused.
    fn by_published<T: Scalar, const L: usize>(&self, filter: PublishedFilter) -> (f64, u32) {
        let (mut filter, mut rng) = self.published::<T, L>(filter);
        let measurements = self.measurements::<T>();
        let refused = measurements.filter(|m| filter.measure(m, &mut rng).is_err()).count() as u32;
        (self.error(filter.moments().mean()), refused)
    }

    /// Our filter; whether its 90 % region holds the user takes a while, and is only found if asked for.
    fn by_best<T: Scalar, const L: usize>(&self, points: usize, region: bool) -> Found {
        let mut filter = Box::new(self.lattice::<T, L>(points));
        let refused = self.measurements::<T>().filter(|m| filter.measure(m).is_err()).count();
        let user = self.user.map(T::from_f64);
        let credible = region && filter.credible(&user, T::from_f64(0.9)) == Some(true);
        Found { error: self.error(filter.moments().mean()), refused: refused as u32, credible }
    }

    /// Error of the mean of the exact posterior, on a lattice laid anew until it is fine enough.
    fn exact(&self) -> f64 {
        let channel = self.geometry.environment.channel::<f32>();
        let weigh = |mut posterior: PointMass<f32, 2, DENSE>| {
            for measurement in self.measurements() {
                // What nothing explains is left out.
                let _ = posterior.weigh(&Loss { channel: &channel, measurement: &measurement });
            }
            posterior
        };
        let mut posterior = weigh(PointMass::new(&square()));
        for _ in 0..3 {
            let finer =
                posterior.finer(12.0).filter(|_| posterior.effective() < 0.1 * DENSE as f32);
            let Some(finer) = finer else { break };
            posterior = weigh(finer);
        }
        self.error(posterior.moments().mean())
    }
}
