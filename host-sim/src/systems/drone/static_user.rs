//! One trial of a user who stays: all filters on the same measurements.

use kestirim_air_to_ground::{Measurement, Rotor};
use kestirim_particle_filter::{PointMass, Region, Resampler, Xoshiro128PlusPlus};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{Locator, PublishedLocator, PublishedSettings};
use rand_core::{Rng, SeedableRng};

use super::cloud::Cloud;
use super::film::Frame;
use super::scenario::{EnvironmentKind, measure};
use super::trajectory::{SIDE_M, Trajectory};
use crate::system::ScalarKind;
use crate::metrics::distance;
use crate::random::{stream, uniform};

/// Most particles of a filter.
const MOST: usize = 4096;
/// Filters of no more particles than this are kept in less memory, which stays in the cache.
const FEW: usize = 1024;
/// Most measurements that a lattice remembers.
const MEMORY: usize = 400;
/// Points of the lattice that stands for the exact posterior.
const DENSE: usize = 640;
/// Time of a measurement, s.
const HOVER_S: f64 = 5.0;

/// Where and how the user is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Points at which the drone stops.
    pub stops: u32,
    /// Measurements at each.
    pub per_stop: u32,
    /// Height of the drone, m.
    pub height_m: f64,
    /// Where the points are.
    pub trajectory: Trajectory,
    /// What is built on the ground.
    pub environment: EnvironmentKind,
}

impl Geometry {
    /// The thesis' circle in a city.
    pub const fn circle(stops: u32, height_m: f64) -> Self {
        let (trajectory, environment) = (Trajectory::CIRCLE, EnvironmentKind::Urban);
        Self { stops, per_stop: 1, height_m, trajectory, environment }
    }

    /// Energy of the flight by the printed formulas and constants (eqs 2.12 to 2.17), J.
    pub fn energy_j(&self, speed_kmh: f64) -> f64 {
        let way = self.trajectory.length(self.stops);
        let hover = f64::from(self.stops) * HOVER_S;
        Rotor::base_station().energy(way, speed_kmh / 3.6, hover).expect("a speed above zero")
    }
}

/// The thesis' filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paper {
    /// Particles L.
    pub particles: usize,
    /// How they are resampled.
    pub resampler: Resampler,
}

/// Which filters are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Job {
    /// On these measurements.
    pub geometry: Geometry,
    /// The thesis' filters.
    pub papers: Vec<Paper>,
    /// Numbers of points of our filters.
    pub bests: Vec<usize>,
    /// Whether the exact posterior is wanted.
    pub limit: bool,
}

/// What came out of a trial, m.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outcome {
    /// Errors of the thesis' filters.
    pub papers: Vec<f64>,
    /// Errors of ours.
    pub bests: Vec<f64>,
    /// Error of the exact posterior's mean; 0 if it was not wanted.
    pub limit: f64,
    /// Measurements that a filter refused.
    pub refused: u32,
    /// Of our first filter, whether its 90 % region holds the user.
    pub credible: bool,
}

/// One user, one flight.
pub fn trial(job: &Job, scalar: ScalarKind, seed: u64, index: u64) -> Outcome {
    match scalar {
        ScalarKind::F32 => with_scalar::<f32>(job, seed, index),
        ScalarKind::F64 => with_scalar::<f64>(job, seed, index),
        ScalarKind::Fixed => with_scalar::<Q16_16>(job, seed, index),
    }
}

/// Which filter a film shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shown {
    /// The thesis'.
    Paper(Paper),
    /// Ours, with so many points.
    Best(usize),
}

/// The same flight as [`trial`]'s, in double precision, frame by frame.
pub fn film(geometry: &Geometry, shown: Shown, seed: u64, index: u64) -> Vec<Frame> {
    let flight = Flight::new(geometry, seed, index);
    match shown {
        Shown::Paper(paper) => {
            let (mut filter, mut rng) = flight.printed::<f64, MOST>(paper);
            flight.film(|measurement| {
                let update = filter.measure(measurement, &mut rng);
                let effective = update.map_or(0.0, |update| update.effective);
                Cloud::of_particles(filter.particles(), effective)
            })
        }
        Shown::Best(points) => {
            let mut filter = Box::new(flight.lattice::<f64, MOST>(points));
            flight.film(|measurement| {
                // What nothing explains leaves the lattice as it was.
                let _ = filter.measure(measurement);
                Cloud::of_lattice(filter.posterior())
            })
        }
    }
}

fn with_scalar<T: Scalar>(job: &Job, seed: u64, index: u64) -> Outcome {
    let flight = Flight::new(&job.geometry, seed, index);
    let mut outcome = Outcome::default();
    for paper in &job.papers {
        let (error, refused) = if paper.particles <= FEW {
            flight.paper::<T, FEW>(*paper)
        } else {
            flight.paper::<T, MOST>(*paper)
        };
        outcome.papers.push(error);
        outcome.refused += refused;
    }
    for (place, &points) in job.bests.iter().enumerate() {
        let found = if points <= FEW {
            flight.best::<T, FEW>(points, place == 0)
        } else {
            flight.best::<T, MOST>(points, place == 0)
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

struct Flight<'a> {
    geometry: &'a Geometry,
    losses: Vec<([f64; 2], f64)>,
    user: [f64; 2],
    seed: u64,
}

impl<'a> Flight<'a> {
    fn new(geometry: &'a Geometry, seed: u64, index: u64) -> Self {
        let mut rng = stream(seed, index);
        let user = [SIDE_M * uniform(&mut rng), SIDE_M * uniform(&mut rng)];
        let channel = geometry.environment.channel::<f64>();
        let mut losses = Vec::new();
        for place in geometry.trajectory.points(geometry.stops) {
            for _ in 0..geometry.per_stop {
                losses.push((place, measure(&channel, user, place, geometry.height_m, &mut rng)));
            }
        }
        Self { geometry, losses, user, seed: rng.next_u64() }
    }

    /// What a filter believes after each measurement.
    fn film(&self, mut cloud: impl FnMut(&Measurement<f64>) -> Cloud) -> Vec<Frame> {
        let frame = |measurement: Measurement<f64>| {
            let cloud = cloud(&measurement);
            let ([x, y], height) = (measurement.place(), measurement.height());
            let (user, estimate) = (self.user, cloud.mean);
            Frame { drone: [x, y, height], user, loss_db: measurement.loss(), estimate, cloud }
        };
        self.measurements().map(frame).collect()
    }

    /// The thesis' filter, and its randomness.
    fn printed<T: Scalar, const L: usize>(
        &self,
        paper: Paper,
    ) -> (Box<PublishedLocator<T, L>>, Xoshiro128PlusPlus) {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(self.seed);
        let settings =
            PublishedSettings { resampler: paper.resampler, ..PublishedSettings::thesis() };
        let channel = self.geometry.environment.channel::<T>();
        let filter = PublishedLocator::<T, L>::with_count(
            paper.particles,
            channel,
            &square(),
            settings,
            &mut rng,
        );
        (Box::new(filter.expect("the number of particles is within bounds")), rng)
    }

    /// Our filter.
    fn lattice<T: Scalar, const L: usize>(&self, points: usize) -> Locator<T, L, MEMORY> {
        let channel = self.geometry.environment.channel::<T>();
        let filter = Locator::<T, L, MEMORY>::with_count(points, channel, &square());
        filter.expect("the number of points is within bounds")
    }

    /// Error of the thesis' filter, and how many measurements it refused.
    fn paper<T: Scalar, const L: usize>(&self, paper: Paper) -> (f64, u32) {
        let (mut filter, mut rng) = self.printed::<T, L>(paper);
        let measurements = self.measurements::<T>();
        let refused = measurements.filter(|m| filter.measure(m, &mut rng).is_err()).count() as u32;
        (self.error(filter.moments().mean()), refused)
    }

    /// Our filter; whether its 90 % region holds the user takes a while, and is only found if asked for.
    fn best<T: Scalar, const L: usize>(&self, points: usize, region: bool) -> Found {
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
                let _ = posterior.update(|user| channel.log_likelihood(&measurement, user));
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

    fn measurements<T: Scalar>(&self) -> impl Iterator<Item = Measurement<T>> {
        let height = T::from_f64(self.geometry.height_m);
        self.losses.iter().filter_map(move |(place, loss)| {
            Measurement::new(place.map(T::from_f64), height, T::from_f64(*loss)).ok()
        })
    }

    fn error<T: Scalar>(&self, place: [T; 2]) -> f64 {
        distance(self.user, place.map(T::to_f64))
    }
}

/// The square in which the user is.
fn square<T: Scalar>() -> Region<T, 2> {
    Region::new([T::ZERO; 2], [T::from_f64(SIDE_M); 2]).expect("a square")
}
