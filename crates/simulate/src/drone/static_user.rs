//! A stationary user, measured from a circle or a grid.

use kestirim_air_to_ground::{Measurement, Rotor};
use kestirim_particle_filter::{Region, Resampler, Xoshiro128PlusPlus};
use kestirim_replay::drone::{Cloud, EnvironmentKind, Estimate, Flown, Stop, Track};
use kestirim_replay::metrics::distance;
use kestirim_scalar::Scalar;
use kestirim_user_locator::{Locator, PublishedLocator, PublishedSettings};
use rand_core::{Rng, SeedableRng};

use super::scenario::measure;
use super::trajectory::{SIDE_M, Trajectory};
use crate::random::{stream, uniform};

/// The largest number of particles of a filter.
pub const MOST: usize = 4096;
/// The largest number of measurements that a lattice remembers.
const MEMORY: usize = 400;
/// The duration of a measurement, s.
const HOVER_S: f64 = 5.0;

/// Where and how often the user is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// The number of points at which the drone stops.
    pub stops: u32,
    /// The number of measurements at each stop.
    pub per_stop: u32,
    /// The height of the drone, m.
    pub height_m: f64,
    /// The arrangement of the stops.
    pub trajectory: Trajectory,
    /// The kind of buildings on the ground.
    pub environment: EnvironmentKind,
}

impl Geometry {
    /// The thesis' circle over a city.
    pub const fn circle(stops: u32, height_m: f64) -> Self {
        let (trajectory, environment) = (Trajectory::CIRCLE, EnvironmentKind::Urban);
        Self { stops, per_stop: 1, height_m, trajectory, environment }
    }

    /// The energy of the flight by the published formulas and constants (eqs 2.12 to 2.17), J.
    ///
    /// # Panics
    /// The speed is not above zero.
    pub fn energy_j(&self, speed_kmh: f64) -> f64 {
        let path = self.trajectory.length(self.stops);
        let hover = f64::from(self.stops) * HOVER_S;
        Rotor::base_station().energy(path, speed_kmh / 3.6, hover).expect("a speed above zero")
    }
}

/// The parameters of the thesis' filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedFilter {
    /// The number of particles L.
    pub particles: usize,
    /// The resampling scheme.
    pub resampler: Resampler,
}

/// The choice of the filter that locates the user.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FilterSetting {
    /// The thesis' filter.
    Published(PublishedFilter),
    /// Our filter, with this number of points.
    Best(usize),
}

/// One user with the measurements of one flight.
#[derive(Debug, Clone)]
pub struct Flight<'a> {
    /// Where and how often the user is measured.
    pub geometry: &'a Geometry,
    losses: Vec<([f64; 2], f64)>,
    /// The true position of the user, m.
    pub user: [f64; 2],
    seed: u64,
}

impl<'a> Flight<'a> {
    /// Draws flight number `index` of a seed.
    pub fn new(geometry: &'a Geometry, seed: u64, index: u64) -> Self {
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

    /// The thesis' filter with its random generator.
    ///
    /// # Panics
    /// More than [`MOST`] particles, or none.
    pub fn published<T: Scalar>(
        &self,
        filter: PublishedFilter,
    ) -> (Box<PublishedLocator<T, MOST>>, Xoshiro128PlusPlus) {
        let mut rng = Xoshiro128PlusPlus::seed_from_u64(self.seed);
        let settings =
            PublishedSettings { resampler: filter.resampler, ..PublishedSettings::thesis() };
        let channel = self.geometry.environment.channel::<T>();
        let filter = PublishedLocator::<T, MOST>::with_count(
            filter.particles,
            channel,
            &square(),
            settings,
            &mut rng,
        );
        (Box::new(filter.expect("the number of particles is within bounds")), rng)
    }

    /// Our filter.
    ///
    /// # Panics
    /// More than [`MOST`] points, or none.
    pub fn lattice<T: Scalar>(&self, points: usize) -> Locator<T, MOST, MEMORY> {
        let channel = self.geometry.environment.channel::<T>();
        let filter = Locator::<T, MOST, MEMORY>::with_count(points, channel, &square());
        filter.expect("the number of points is within bounds")
    }

    /// The measurements of the flight.
    pub fn measurements<T: Scalar>(&self) -> impl Iterator<Item = Measurement<T>> {
        let height = T::from_f64(self.geometry.height_m);
        self.losses.iter().filter_map(move |(place, loss)| {
            Measurement::new(place.map(T::from_f64), height, T::from_f64(*loss)).ok()
        })
    }

    /// The distance of `place` from the user, m.
    pub fn error<T: Scalar>(&self, place: [T; 2]) -> f64 {
        distance(self.user, place.map(T::to_f64))
    }

    /// The posterior after each measurement, in double precision.
    fn track(&self, mut cloud: impl FnMut(&Measurement<f64>) -> Cloud) -> Track {
        let (mut stops, mut estimates) = (Vec::new(), Vec::new());
        for (number, measurement) in self.measurements().enumerate() {
            let (height, loss) = (measurement.height(), measurement.loss());
            stops.push(Stop {
                t: number as f64 * HOVER_S,
                place: measurement.place(),
                height,
                loss,
                heading: None,
            });
            estimates.push(Estimate::of_cloud(number, cloud(&measurement)));
        }
        let path_m = self.geometry.trajectory.length(self.geometry.stops);
        let hover_s = f64::from(self.geometry.stops) * HOVER_S;
        Track {
            truth: vec![self.user; stops.len()],
            stops,
            estimates,
            warnings: Vec::new(),
            flown: Some(Flown { path_m, climb_m: 0.0, hover_s }),
            others: Vec::new(),
            moved_m: None,
        }
    }
}

/// Records flight number `index` of a seed, in double precision.
pub fn track(geometry: &Geometry, filter: FilterSetting, seed: u64, index: u64) -> Track {
    let flight = Flight::new(geometry, seed, index);
    match filter {
        FilterSetting::Published(filter) => {
            let (mut filter, mut rng) = flight.published::<f64>(filter);
            flight.track(|measurement| {
                let update = filter.measure(measurement, &mut rng);
                let effective = update.map_or(0.0, |update| update.effective);
                Cloud::of_particles(filter.particles(), effective)
            })
        }
        FilterSetting::Best(points) => {
            let mut filter = Box::new(flight.lattice::<f64>(points));
            flight.track(|measurement| {
                // A measurement that no point explains leaves the lattice unchanged.
                let _ = filter.measure(measurement);
                Cloud::of_lattice(filter.posterior())
            })
        }
    }
}

/// The square that holds the user.
///
/// # Panics
/// Never: there is a square of this side.
pub fn square<T: Scalar>() -> Region<T, 2> {
    Region::new([T::ZERO; 2], [T::from_f64(SIDE_M); 2]).expect("a square")
}
