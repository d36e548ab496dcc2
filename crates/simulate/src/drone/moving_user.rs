//! One trial with a user who walks in a circle and a drone that follows.

use std::f64::consts::TAU;

use kestirim_air_to_ground::{Channel, Measurement};
use kestirim_particle_filter::{Region, Resampler, Xoshiro128PlusPlus};
use kestirim_replay::ScalarKind;
use kestirim_replay::drone::{Cloud, EnvironmentKind, Estimate, Flown, Stop, Track};
use kestirim_replay::metrics::{distance, mean};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{
    Height, Motion, Orbit, PublishedLocator, PublishedSettings, Tracker, Waypoint,
};
use rand_core::{Rng, SeedableRng};

use super::scenario::measure;
use super::static_user::MOST;
use crate::random::{normal, stream, uniform};

/// The side of the square that holds the user, m.
pub const SIDE_M: f64 = 4000.0;
/// The time between measurements, s. The thesis counts in steps; with its five seconds of hovering per measurement the
/// user of most of its figures walks at 2.5 m/s.
pub const INTERVAL_S: f64 = 5.0;
/// The error from which the user counts as lost, m.
pub const LOST_M: f64 = 300.0;

/// The drone's flight policy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Policy {
    /// The thesis' filter; the drone flies to the estimate and hovers (Table 3.5).
    Hover(Resampler),
    /// The drone orbits the estimate of a particle filter with velocities.
    Orbit,
    /// The drone orbits as with `Orbit`, low when the user's position is certain and high when it is not.
    OrbitLow,
}

/// The parameters of one cell of the sweeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walk {
    /// The number of particles L.
    pub particles: usize,
    /// The height of the drone, m.
    pub height_m: f64,
    /// The radius of the user's circle, m.
    pub user_radius_m: f64,
    /// The number of steps in which the circle is walked.
    pub end_time: u32,
    /// The kind of buildings on the ground.
    pub environment: EnvironmentKind,
    /// The drone's flight policy.
    pub policy: Policy,
    /// The standard deviation of additional noise that the filter's channel does not include, dB.
    pub unknown_noise_db: f64,
    /// The smallest standard deviation that the filter assumes, dB.
    pub least_sigma_db: Option<f64>,
}

impl Walk {
    /// The parameters of most of the thesis' figures.
    pub const fn thesis(policy: Policy) -> Self {
        Self {
            particles: 1000,
            height_m: 500.0,
            user_radius_m: 1000.0,
            end_time: 500,
            environment: EnvironmentKind::Urban,
            policy,
            unknown_noise_db: 0.0,
            least_sigma_db: None,
        }
    }

    /// The jitter of the thesis' filter, m, which the thesis does not state. It must exceed the user's step, or the
    /// cloud falls behind.
    pub fn jitter_m(&self) -> f64 {
        let step = TAU * self.user_radius_m / f64::from(self.end_time);
        (1.27 * step).max(16.0)
    }
}

/// The result of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// The mean error over all steps, m.
    pub error_m: f64,
    /// The distance flown: without hovering, as in the thesis.
    pub flown: Flown,
}

impl Outcome {
    /// The names of the [`numbers`](Self::numbers).
    pub const COLUMNS: [&'static str; 4] = ["error_m", "path_m", "climb_m", "hover_s"];

    /// The outcome as a row of numbers.
    pub fn numbers(&self) -> [f64; Self::COLUMNS.len()] {
        let Flown { path_m, climb_m, hover_s } = self.flown;
        [self.error_m, path_m, climb_m, hover_s]
    }

    /// The outcome that a row of numbers stands for.
    pub fn of_numbers([error_m, path_m, climb_m, hover_s]: [f64; Self::COLUMNS.len()]) -> Self {
        Self { error_m, flown: Flown { path_m, climb_m, hover_s } }
    }
}

/// A filter together with a rule for the drone's next waypoint.
trait Follower {
    /// Updates the filter with a loss measured at a waypoint; returns the estimate of the user's position and the next
    /// waypoint.
    fn step(&mut self, from: Waypoint<f64>, loss_db: f64) -> ([f64; 2], Waypoint<f64>);

    /// The current particle cloud.
    fn cloud(&self) -> Cloud;
}

/// Simulates one flight with one user.
pub fn trial(walk: &Walk, scalar: ScalarKind, seed: u64, index: u64) -> Outcome {
    match scalar {
        ScalarKind::F32 => fly::<f32>(walk, seed, index, &mut |_| {}),
        ScalarKind::F64 => fly::<f64>(walk, seed, index, &mut |_| {}),
        ScalarKind::Fixed => fly::<Q16_16>(walk, seed, index, &mut |_| {}),
    }
}

/// The flight of [`trial`] in double precision, recorded step by step.
pub fn track(walk: &Walk, seed: u64, index: u64) -> Track {
    let mut track = Track::default();
    let mut watch = |step: &Step<'_>| {
        let Waypoint { place, height } = step.waypoint;
        let number = track.stops.len();
        let t = number as f64 * INTERVAL_S;
        track.stops.push(Stop { t, place, height, loss: step.loss_db, heading: None });
        track.truth.push(step.user);
        let estimate = Estimate::of_cloud(number, step.follower.cloud());
        track.estimates.push(Estimate { place: step.estimate, ..estimate });
    };
    let outcome = fly::<f64>(walk, seed, index, &mut watch);
    Track { flown: Some(outcome.flown), ..track }
}

/// One step of a flight, as an observer sees it.
struct Step<'a> {
    waypoint: Waypoint<f64>,
    user: [f64; 2],
    loss_db: f64,
    estimate: [f64; 2],
    follower: &'a dyn Follower,
}

fn fly<T: Scalar>(walk: &Walk, seed: u64, index: u64, watch: &mut dyn FnMut(&Step<'_>)) -> Outcome {
    let mut world = stream(seed, index);
    let phase = TAU * uniform(&mut world);
    let rng = Xoshiro128PlusPlus::seed_from_u64(world.next_u64());
    let mut follower: Box<dyn Follower> = match walk.policy {
        Policy::Hover(resampler) => Box::new(Hovering::<T>::new(walk, resampler, rng)),
        Policy::Orbit => {
            Box::new(Orbiting::<T>::new(walk, Height::Fixed(T::from_f64(walk.height_m)), rng))
        }
        Policy::OrbitLow => {
            let heights = Height::Between(T::from_f64(100.0), T::from_f64(1000.0));
            Box::new(Orbiting::<T>::new(walk, heights, rng))
        }
    };
    let channel = walk.environment.channel::<f64>();
    let start = if walk.policy == Policy::OrbitLow { 1000.0 } else { walk.height_m };
    let mut waypoint = Waypoint { place: [SIDE_M / 2.0; 2], height: start };
    let (mut errors, mut flown) = (Vec::new(), Flown::default());
    for step in 0..walk.end_time {
        let (sine, cosine) = (phase + TAU * f64::from(step) / f64::from(walk.end_time)).sin_cos();
        let user = [cosine, sine].map(|part| SIDE_M / 2.0 + walk.user_radius_m * part);
        let loss = measure(&channel, user, waypoint.place, waypoint.height, &mut world)
            + normal(&mut world, walk.unknown_noise_db);
        let (estimate, next) = follower.step(waypoint, loss);
        watch(&Step { waypoint, user, loss_db: loss, estimate, follower: &*follower });
        errors.push(distance(user, estimate));
        flown.path_m += distance(waypoint.place, next.place).hypot(next.height - waypoint.height);
        flown.climb_m += (next.height - waypoint.height).max(0.0);
        waypoint = next;
    }
    Outcome { error_m: mean(&errors), flown }
}

/// The thesis' filter, with which the drone hovers above its estimate.
struct Hovering<T: Scalar> {
    filter: PublishedLocator<T, MOST>,
    rng: Xoshiro128PlusPlus,
    /// The effective number of particles after the last measurement.
    effective: T,
}

impl<T: Scalar> Hovering<T> {
    fn new(walk: &Walk, resampler: Resampler, mut rng: Xoshiro128PlusPlus) -> Self {
        let jitter = T::from_f64(walk.jitter_m());
        let settings = PublishedSettings { resampler, jitter, ..PublishedSettings::thesis() };
        let filter = PublishedLocator::with_count(
            walk.particles,
            channel(walk),
            &square(),
            settings,
            &mut rng,
        );
        let filter = filter.expect("the number of particles is within bounds");
        Self { filter, rng, effective: T::ZERO }
    }
}

impl<T: Scalar> Follower for Hovering<T> {
    fn step(&mut self, from: Waypoint<f64>, loss_db: f64) -> ([f64; 2], Waypoint<f64>) {
        if let Some(measurement) = measurement(from, loss_db) {
            // A measurement that no particle explains leaves the cloud unchanged.
            let update = self.filter.measure(&measurement, &mut self.rng);
            self.effective = update.map_or(T::ZERO, |update| update.effective);
        }
        let place = self.filter.moments().mean().map(T::to_f64);
        (place, Waypoint { place, height: from.height })
    }

    fn cloud(&self) -> Cloud {
        Cloud::of_particles(self.filter.particles(), self.effective.to_f64())
    }
}

/// Our filter, with which the drone orbits the estimate.
struct Orbiting<T: Scalar> {
    tracker: Tracker<T, MOST>,
    orbit: Orbit<T>,
    rng: Xoshiro128PlusPlus,
    begun: bool,
    /// The effective number of particles after the last measurement.
    effective: T,
}

impl<T: Scalar> Orbiting<T> {
    fn new(walk: &Walk, height: Height<T>, mut rng: Xoshiro128PlusPlus) -> Self {
        let tracker = Tracker::with_count(
            walk.particles,
            channel(walk),
            motion(walk.least_sigma_db),
            &square(),
            &mut rng,
        );
        let tracker = tracker.expect("the number of particles is within bounds");
        Self { tracker, orbit: Orbit::new(height), rng, begun: false, effective: T::ZERO }
    }
}

/// The assumed motion of the user, with the standard deviation of the best measurements, dB.
fn motion<T: Scalar>(least_sigma_db: Option<f64>) -> Motion<T> {
    match least_sigma_db {
        Some(sigma) => Motion::people_measured_to(T::from_f64(sigma)),
        None => Motion::people(),
    }
}

impl<T: Scalar> Follower for Orbiting<T> {
    fn step(&mut self, from: Waypoint<f64>, loss_db: f64) -> ([f64; 2], Waypoint<f64>) {
        let interval = T::from_f64(INTERVAL_S);
        if self.begun {
            self.tracker.predict(interval, &mut self.rng).expect("an interval above zero");
        }
        self.begun = true;
        if let Some(measurement) = measurement(from, loss_db) {
            // A measurement that no particle explains leaves the cloud unchanged.
            let update = self.tracker.measure(&measurement, &mut self.rng);
            self.effective = update.map_or(T::ZERO, |update| update.effective);
        }
        let estimate = self.tracker.estimate();
        let next = self.orbit.next(&estimate, interval);
        let next = Waypoint { place: next.place.map(T::to_f64), height: next.height.to_f64() };
        (estimate.place.map(T::to_f64), next)
    }

    fn cloud(&self) -> Cloud {
        Cloud::of_particles(self.tracker.particles(), self.effective.to_f64())
    }
}

fn channel<T: Scalar>(walk: &Walk) -> Channel<T> {
    let channel = walk.environment.channel::<T>();
    let limited = walk.least_sigma_db.map(|sigma| channel.with_least_sigma(T::from_f64(sigma)));
    limited.and_then(Result::ok).unwrap_or(channel)
}

fn measurement<T: Scalar>(from: Waypoint<f64>, loss_db: f64) -> Option<Measurement<T>> {
    let number = T::from_f64;
    Measurement::new(from.place.map(number), number(from.height), number(loss_db)).ok()
}

/// The square in which the filters search for the user.
///
/// # Panics
/// Never: there is a square of this side.
pub fn square<T: Scalar>() -> Region<T, 2> {
    Region::new([T::ZERO; 2], [T::from_f64(SIDE_M); 2]).expect("a square")
}
