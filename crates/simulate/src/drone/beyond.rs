//! Beyond the thesis: what it names as future work, and what real measurements are like.

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

/// Points of a lattice of places and levels.
const POINTS: usize = 1500;
/// Points of a lattice of places.
const PLACES: usize = 500;
/// Measurements of a user who stays.
const STOPS: u32 = 12;
/// From where, m.
const HEIGHT_M: f64 = 800.0;
/// Users that one drone follows.
const USERS: usize = 3;

/// An experiment with a user who stays, measured twelve times from the circle at 800 m.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stay {
    /// Every twentieth measurement is anything within ±40 dB; the filter does not know.
    WildPlain,
    /// The same with a robust likelihood.
    WildRobust,
    /// The transmitter's level is known to ±10 dB only, and the filter takes it for known.
    LevelIgnored,
    /// The same with the level as third coordinate.
    LevelEstimated,
}

impl Stay {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::WildPlain, Self::WildRobust, Self::LevelIgnored, Self::LevelEstimated];

    /// What it shows.
    pub fn description(self) -> &'static str {
        match self {
            Self::WildPlain => "5 % wild measurements",
            Self::WildRobust => "5 % wild measurements, robust likelihood",
            Self::LevelIgnored => "level off by up to 10 dB",
            Self::LevelEstimated => "level off by up to 10 dB, estimated too",
        }
    }

    /// Error of one trial, m.
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
        // What nothing explains is left out.
        let _ = locator.measure(measurement);
    }
    locator.moments().mean()
}

/// Walks of one user with other policies than the thesis' or with a channel that is not quite the filter's.
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

/// Three users on circles of their own, one filter each, one drone: it goes round the user of whom least is known.
/// Mean error of all users, m.
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
                // What no particle explains leaves the cloud as it was.
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
