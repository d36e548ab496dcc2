//! Experiments beyond the thesis: those it names as future work, and those with realistic measurements.

use kestirim_air_to_ground::{Contaminated, Likelihood, Measurement};
use kestirim_particle_filter::{Region, Resampler, Xoshiro128PlusPlus};
use kestirim_replay::drone::EnvironmentKind;
use kestirim_replay::metrics::{distance, mean};
use kestirim_user_locator::{Height, Locator, Motion, Orbit, Tracker, Waypoint};
use rand_core::{Rng, SeedableRng};

use super::moving_user::{self, Policy, Walk};
use super::scenario::measure;
use super::trajectory::{SIDE_M, Trajectory};
use crate::random::{stream, uniform};

/// The number of points of a lattice over positions and levels.
const POINTS: usize = 1500;
/// The number of points of a lattice over positions.
const PLACES: usize = 500;
/// The number of measurements of a stationary user.
const STOPS: u32 = 12;
/// The height of the drone, m.
const HEIGHT_M: f64 = 800.0;
/// The number of users that one drone follows.
const USERS: usize = 3;

/// An experiment with a stationary user, who is measured twelve times from the circle at 800 m.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stay {
    /// Every twentieth measurement is off by anything within ±40 dB; the filter does not know.
    WildPlain,
    /// Every twentieth measurement is off by anything within ±40 dB; the filter has a robust likelihood.
    WildRobust,
    /// The transmitter's level is only known to ±10 dB, but the filter takes it for known.
    LevelIgnored,
    /// The transmitter's level is only known to ±10 dB; the filter estimates it as a third coordinate.
    LevelEstimated,
}

impl Stay {
    /// All experiments.
    pub const ALL: [Self; 4] =
        [Self::WildPlain, Self::WildRobust, Self::LevelIgnored, Self::LevelEstimated];

    /// A short description for tables.
    pub fn description(self) -> &'static str {
        match self {
            Self::WildPlain => "5 % wild measurements",
            Self::WildRobust => "5 % wild measurements, robust likelihood",
            Self::LevelIgnored => "level off by up to 10 dB",
            Self::LevelEstimated => "level off by up to 10 dB, estimated too",
        }
    }

    /// The position error of one trial, m.
    ///
    /// # Panics
    /// Never: shares are below one, and regions are boxes.
    pub fn trial(self, seed: u64, index: u64) -> f64 {
        let mut rng = stream(seed, index);
        let user = [SIDE_M * uniform(&mut rng), SIDE_M * uniform(&mut rng)];
        let channel = EnvironmentKind::Urban.channel::<f64>();
        let level = match self {
            Self::LevelIgnored | Self::LevelEstimated => 20.0 * uniform(&mut rng) - 10.0,
            Self::WildPlain | Self::WildRobust => 0.0,
        };
        let wild = matches!(self, Self::WildPlain | Self::WildRobust);
        let mut measurements = Vec::new();
        for place in Trajectory::CIRCLE.points(STOPS) {
            let mut loss = measure(&channel, user, place, HEIGHT_M, &mut rng) + level;
            if wild && uniform(&mut rng) < 0.05 {
                loss += 80.0 * uniform(&mut rng) - 40.0;
            }
            measurements.extend(Measurement::new(place, HEIGHT_M, loss));
        }
        let found = match self {
            Self::WildRobust => {
                let robust = Contaminated::new(channel, 0.05).expect("a share below one");
                locate::<_, PLACES, 2>(robust, [SIDE_M; 2], [0.0; 2], &measurements)
            }
            Self::LevelEstimated => {
                let (low, high) = ([0.0, 0.0, -10.0], [SIDE_M, SIDE_M, 10.0]);
                let [x, y, _] = locate::<_, POINTS, 3>(channel, high, low, &measurements);
                [x, y]
            }
            Self::WildPlain | Self::LevelIgnored => {
                locate::<_, PLACES, 2>(channel, [SIDE_M; 2], [0.0; 2], &measurements)
            }
        };
        distance(user, found)
    }
}

fn locate<C: Likelihood<f64>, const L: usize, const D: usize>(
    channel: C,
    high: [f64; D],
    low: [f64; D],
    measurements: &[Measurement<f64>],
) -> [f64; D] {
    let region = Region::new(low, high).expect("a box");
    let mut locator = Box::new(Locator::<f64, L, { STOPS as usize }, D, C>::new(channel, &region));
    for measurement in measurements {
        // A measurement that no point explains is left out.
        let _ = locator.measure(measurement);
    }
    locator.moments().mean()
}

/// Walks of one user with policies other than the thesis', or with a channel that differs slightly from the filter's.
pub fn walks() -> Vec<(&'static str, Walk)> {
    let hover = Walk::thesis(Policy::Hover(Resampler::Systematic));
    let orbit = Walk::thesis(Policy::Orbit);
    let low = Walk::thesis(Policy::OrbitLow);
    let noisy = |walk: Walk| Walk { unknown_noise_db: 1.0, ..walk };
    let careful = |walk: Walk| Walk { least_sigma_db: Some(1.0), ..noisy(walk) };
    vec![
        ("thesis: hovering over the estimate", hover),
        ("orbit, velocity marginalised", orbit),
        ("the same, 100 to 1000 m high", low),
        ("1 dB unknown noise: orbit", noisy(orbit)),
        ("1 dB unknown noise: orbit, no σ below 1 dB", careful(orbit)),
        ("1 dB unknown noise: 100 to 1000 m high, no σ below 1 dB", careful(low)),
    ]
}

/// Follows three users on circles of their own with one drone and one filter each; the drone orbits the user whose
/// position is least certain. Returns the mean error over all users, m.
///
/// # Panics
/// Never: its intervals are above zero.
pub fn several_users(seed: u64, index: u64) -> f64 {
    let mut world = stream(seed, index);
    let channel = EnvironmentKind::Urban.channel::<f64>();
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(world.next_u64());
    let region = moving_user::square::<f32>();
    let filter = |rng: &mut Xoshiro128PlusPlus| {
        Tracker::<f32, 1000>::new(EnvironmentKind::Urban.channel(), Motion::people(), &region, rng)
    };
    let mut filters: Vec<_> = (0..USERS).map(|_| filter(&mut rng)).collect();
    let phases: Vec<f64> =
        (0..USERS).map(|_| std::f64::consts::TAU * uniform(&mut world)).collect();
    let mut orbit = Orbit::new(Height::Fixed(500.0));
    let mut waypoint = Waypoint { place: [2000.0; 2], height: 500.0_f32 };
    let mut errors = Vec::new();
    for step in 0..500 {
        for (number, (filter, phase)) in filters.iter_mut().zip(&phases).enumerate() {
            let (sine, cosine) =
                (phase + f64::from(step) * std::f64::consts::TAU / 500.0).sin_cos();
            let radius = 600.0 + 200.0 * number as f64;
            let user = [2000.0 + radius * cosine, 2000.0 + radius * sine];
            let place = waypoint.place.map(f64::from);
            let loss = measure(&channel, user, place, waypoint.height.into(), &mut world);
            if step > 0 {
                let interval = moving_user::INTERVAL_S as f32;
                filter.predict(interval, &mut rng).expect("an interval above zero");
            }
            if let Ok(measurement) = Measurement::new(waypoint.place, waypoint.height, loss as f32)
            {
                // A measurement that no particle explains leaves the cloud unchanged.
                let _ = filter.measure(&measurement, &mut rng);
            }
            errors.push(distance(user, filter.estimate().place.map(f64::from)));
        }
        let estimates = filters.iter().map(Tracker::estimate);
        let widest = estimates.max_by(|a, b| a.spread.total_cmp(&b.spread));
        if let Some(estimate) = widest {
            waypoint = orbit.next(&estimate, moving_user::INTERVAL_S as f32);
        }
    }
    mean(&errors)
}
