//! One trial with a stationary user: all filters on the same measurements.

use kestirim_air_to_ground::{Channel, Measurement};
use kestirim_particle_filter::{Likelihood, PointMass};
use kestirim_replay::ScalarKind;
use kestirim_scalar::{Q16_16, Scalar};

use super::static_user::{Flight, Geometry, PublishedFilter, square};

/// The number of points of the lattice that represents the exact posterior.
const DENSE: usize = 640;

/// The filters to compare and the measurements to compare them on.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// The geometry of the measurements.
    pub geometry: Geometry,
    /// The variants of the thesis' filter.
    pub published: Vec<PublishedFilter>,
    /// The numbers of points of our filters.
    pub bests: Vec<usize>,
    /// Whether to compute the exact posterior.
    pub limit: bool,
}

/// The result of a trial; errors in m.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outcome {
    /// The errors of the thesis' filters, m.
    pub published: Vec<f64>,
    /// The errors of our filters, m.
    pub bests: Vec<f64>,
    /// The error of the mean of the exact posterior, m; 0 if it was not requested.
    pub limit: f64,
    /// The number of measurements that a filter refused.
    pub refused: u32,
    /// Whether the 90 % credible region of our first filter contains the user.
    pub credible: bool,
}

impl Job {
    /// The names of the numbers of an outcome.
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
    /// The outcome as a row of numbers, in the order of [`Job::columns`].
    pub fn numbers(&self) -> Vec<f64> {
        let first = [self.limit, f64::from(self.refused), f64::from(self.credible)];
        [&first[..], &self.published, &self.bests].concat()
    }

    /// The outcome that a row of numbers stands for; missing numbers are 0.
    pub fn of_numbers(job: &Job, row: &[f64]) -> Self {
        let mut row = row.iter().copied();
        let mut next = || row.next().unwrap_or_default();
        let (limit, refused, credible) = (next(), next() as u32, next() != 0.0);
        let published = job.published.iter().map(|_| next()).collect();
        let bests = job.bests.iter().map(|_| next()).collect();
        Self { published, bests, limit, refused, credible }
    }
}

/// Simulates one flight with one user.
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
        let (error, refused) = flight.by_published::<T>(*filter);
        outcome.published.push(error);
        outcome.refused += refused;
    }
    for (place, &points) in job.bests.iter().enumerate() {
        let found = flight.by_best::<T>(points, place == 0);
        outcome.bests.push(found.error);
        outcome.refused += found.refused;
        outcome.credible |= found.credible;
    }
    outcome.limit = if job.limit { flight.exact() } else { 0.0 };
    outcome
}

/// The result of our filter.
struct Found {
    error: f64,
    refused: u32,
    credible: bool,
}

/// A measured path loss, as a likelihood over the user's positions.
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
    /// The error of the thesis' filter, m, and the number of measurements that it refused.
    fn by_published<T: Scalar>(&self, filter: PublishedFilter) -> (f64, u32) {
        let (mut filter, mut rng) = self.published::<T>(filter);
        let measurements = self.measurements::<T>();
        let refused = measurements.filter(|m| filter.measure(m, &mut rng).is_err()).count() as u32;
        (self.error(filter.moments().mean()), refused)
    }

    /// Runs our filter. Whether its 90 % credible region contains the user is expensive, and only computed if `region`
    /// is set.
    fn by_best<T: Scalar>(&self, points: usize, region: bool) -> Found {
        let mut filter = Box::new(self.lattice::<T>(points));
        let refused = self.measurements::<T>().filter(|m| filter.measure(m).is_err()).count();
        let user = self.user.map(T::from_f64);
        let credible = region && filter.credible(&user, T::from_f64(0.9)) == Some(true);
        Found { error: self.error(filter.moments().mean()), refused: refused as u32, credible }
    }

    /// The error of the mean of the exact posterior, m, on a lattice that is refined until it is fine enough.
    fn exact(&self) -> f64 {
        let channel = self.geometry.environment.channel::<f32>();
        let weigh = |mut posterior: PointMass<f32, 2, DENSE>| {
            for measurement in self.measurements() {
                // A measurement that no point explains is left out.
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
