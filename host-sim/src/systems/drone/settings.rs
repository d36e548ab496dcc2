//! The settings of the search for a user, and of synthetic users and flights.

pub mod cell;
pub mod choices;
mod firmware;

use clap::ValueEnum;
use kestirim_air_to_ground::Channel;
use kestirim_replay::drone::{self, EnvironmentKind, Quantity, Stop};

use self::choices::{FilterKind, FlightKind, ResamplerKind, TrajectoryKind};
pub(super) use self::firmware::firmware;
use super::recording::Recording;
use super::simulate::moving_user::{Policy, Walk};
use super::simulate::static_user::{FilterSetting, Geometry, PublishedFilter};
use super::simulate::trajectory::Trajectory;
use crate::metrics::distance;
use crate::system::{Idle, Kind, Named, Setting, Settings};

/// The maximum number of steps of a synthetic walk.
const MOST_STEPS: f64 = 1000.0;
/// The maximum number of measurements of a stationary synthetic user.
const MOST_STOPS: f64 = 40.0;
/// The name of the environment over open ground.
const OPEN: &str = "open";

/// The available settings.
pub(super) fn table(recording: Option<&Recording>) -> Vec<Setting> {
    let (most, shown) = match recording {
        None => (10_000.0, 1.0),
        Some(Recording::Moving) => (MOST_STEPS, 500.0),
        Some(Recording::Staying) => (MOST_STOPS, 12.0),
        Some(Recording::Flight(recorded)) => {
            let most = recorded.flight.stops.len() as f64;
            (most, most)
        }
    };
    let (particles, height) = match recording {
        Some(Recording::Moving) => (1000.0, 500.0),
        _ => (500.0, 800.0),
    };
    vec![
        Setting::number(
            "step",
            "The measurement that is shown, counted from 1 [default: the last]",
            "",
            [1.0, most, 1.0],
            shown,
        )
        .undecided()
        .playable()
        .view(),
        environment(!matches!(recording, Some(Recording::Moving | Recording::Staying)))
            .flags(&[("free-space", OPEN)])
            .live(),
        Setting::number(
            "frequency",
            "Carrier frequency of path losses; what an environment adds to free space is that of 2000 MHz",
            "MHz",
            [30.0, 30_000.0, 10.0],
            2000.0,
        )
        .live(),
        Setting::number(
            "window",
            "Measurements of so many seconds count, for a user who moves [default: all]",
            "s",
            [1.0, 86_400.0, 1.0],
            60.0,
        )
        .undecided()
        .live(),
        Setting::one_of("flight", "What the drone does", &FlightKind::default()),
        filter(),
        resampler(),
        Setting::one_of("trajectory", "Where the drone measures", &TrajectoryKind::default()),
        radius([100.0, 1000.0, 10.0]),
        measurements(MOST_STOPS),
        self::particles(particles),
        self::height([100.0, 1500.0, 25.0], height),
        user_radius([0.0, 2000.0, 50.0]),
        end_time([20.0, MOST_STEPS, 20.0]),
        Setting::number(
            "noise",
            "Noise that the filter does not know of",
            "dB",
            [0.0, 5.0, 0.1],
            0.0,
        ),
        speed([20.0, 80.0, 5.0]).view(),
        Setting::number("seed", "Seed of all randomness", "", [0.0, 99.0, 1.0], 0.0),
    ]
}

/// The setting of the environment, with or without open ground.
fn environment(with_open: bool) -> Setting {
    let mut setting = Setting::one_of(
        "environment",
        "What is built on the ground: the thesis' channel; of synthetic users urban unless told otherwise",
        &EnvironmentKind::default(),
    );
    if let Kind::Choice { of, default } = &mut setting.kind
        && with_open
    {
        let label = "Nothing, and what antennas there are is unknown".to_owned();
        of.insert(0, Named { name: OPEN.to_owned(), label, aliases: Vec::new() });
        OPEN.clone_into(default);
    }
    setting
}

fn filter() -> Setting {
    Setting::one_of("filter", "Which filter finds the user", &FilterKind::default())
}

fn resampler() -> Setting {
    Setting::one_of("resampler", "How the thesis' filter resamples", &ResamplerKind::default())
}

fn radius(range: [f64; 3]) -> Setting {
    let help = "Radius of the drone's circle [default: 2000/3 m]";
    Setting::number("radius", help, "m", range, 2000.0 / 3.0).undecided()
}

fn measurements(most: f64) -> Setting {
    Setting::number(
        "measurements",
        "Measurements T of a user who stays",
        "",
        [1.0, most, 1.0],
        12.0,
    )
}

fn particles(initially: f64) -> Setting {
    let help = "Particles L, or points of the lattice [default: 500; of a moving user 1000]";
    Setting::number("particles", help, "", [1.0, 4096.0, 1.0], initially).undecided()
}

fn height(range: [f64; 3], initially: f64) -> Setting {
    let help = "Height of the drone [default: 800 m; of a moving user 500 m]";
    Setting::number("height", help, "m", range, initially).undecided()
}

fn user_radius(range: [f64; 3]) -> Setting {
    Setting::number("user-radius", "Radius of the circle that the user walks", "m", range, 1000.0)
}

fn end_time(range: [f64; 3]) -> Setting {
    let help = "Steps in which the user walks the circle";
    Setting::number("end-time", help, "", range, 500.0)
}

fn speed(range: [f64; 3]) -> Setting {
    Setting::number("speed", "Speed of the drone, which costs energy", "km/h", range, 40.0)
}

/// Why a setting has no effect given the recording and the other settings.
pub(super) fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
    let synthetic = [&Recording::Moving, &Recording::Staying];
    match recording {
        Some(recording) => idle_of(recording, settings, name),
        // The recording may be of some synthetic user or a recorded flight.
        None if ["environment", "frequency", "step", "window"].contains(&name) => None,
        None => synthetic
            .map(|recording| idle_of(recording, settings, name))
            .into_iter()
            .reduce(Option::and)
            .flatten(),
    }
}

fn idle_of(recording: &Recording, settings: &Settings, name: &str) -> Option<Idle> {
    let flight: FlightKind = settings.chosen("flight");
    let filter: FilterKind = settings.chosen("filter");
    let trajectory: TrajectoryKind = settings.chosen("trajectory");
    let is_of = |recordings: &str| {
        Some(Idle::foreign(format!("is for a synthetic recording: --synthetic {recordings}")))
    };
    match (recording, name) {
        (_, "step") | (Recording::Flight(_), "environment" | "window") => None,
        (Recording::Flight(recorded), "frequency") => {
            // In built-up environments the level reported is the transmitter's, which depends on the loss of the first
            // metre.
            let is_level = recorded.flight.quantity == Quantity::Level && built(settings).is_none();
            is_level
                .then(|| Idle::implied("levels of unknown offset tell the same at any frequency"))
        }
        (_, "frequency" | "window") => Some(Idle::foreign("is for a recorded flight")),
        (_, "environment") => {
            let is_open = settings.is_given(name) && settings.choice(name) == OPEN;
            is_open.then(|| Idle::foreign("open is for a recorded flight"))
        }
        (
            Recording::Flight(_) | Recording::Moving,
            "filter" | "trajectory" | "radius" | "measurements",
        ) => is_of("staying"),
        (
            Recording::Flight(_) | Recording::Staying,
            "flight" | "user-radius" | "end-time" | "noise",
        ) => is_of("moving"),
        (Recording::Flight(_), _) => is_of("moving or staying"),
        (Recording::Moving, "resampler") if flight != FlightKind::Hover => {
            Some(Idle::foreign("is for --flight hover"))
        }
        (Recording::Staying, "resampler") if filter != FilterKind::Published => {
            Some(Idle::foreign("is for --filter published"))
        }
        (Recording::Moving, "height") if flight == FlightKind::Low => {
            Some(Idle::foreign("is for --flight orbit or hover"))
        }
        (Recording::Staying, "radius") if trajectory != TrajectoryKind::Circle => {
            Some(Idle::foreign("is for --trajectory circle"))
        }
        _ => None,
    }
}

/// The environment of a recorded flight; `None` over open ground.
pub(super) fn built(settings: &Settings) -> Option<EnvironmentKind> {
    EnvironmentKind::from_str(&settings.choice("environment"), false).ok()
}

/// The wavelength of the transmitter (m).
pub(super) fn wavelength_m(settings: &Settings) -> f64 {
    drone::wavelength_m(1e6 * settings.decided("frequency"))
}

/// The channel model of a recorded flight; `None` over open ground.
pub(super) fn channel(settings: &Settings) -> Option<Channel<f64>> {
    built(settings)?.channel_at(wavelength_m(settings)).ok()
}

/// A synthetic moving user, and the policy by which the drone follows.
pub(super) fn walk(settings: &Settings) -> Walk {
    let policy = match settings.chosen("flight") {
        FlightKind::Hover => Policy::Hover(settings.chosen::<ResamplerKind>("resampler").into()),
        FlightKind::Low => Policy::OrbitLow,
        FlightKind::Orbit => Policy::Orbit,
    };
    Walk { unknown_noise_db: settings.decided("noise"), ..walk_of(settings, policy) }
}

/// A walk with the settings that an experiment has as well.
fn walk_of(settings: &Settings, policy: Policy) -> Walk {
    let thesis = Walk::thesis(policy);
    let count = settings.number("particles").map(|count| count as usize);
    Walk {
        particles: count.unwrap_or(thesis.particles),
        height_m: settings.number("height").unwrap_or(thesis.height_m),
        user_radius_m: settings.decided("user-radius"),
        end_time: settings.decided("end-time") as u32,
        environment: settings.chosen("environment"),
        ..thesis
    }
}

/// The geometry of the measurements of a stationary synthetic user.
pub(super) fn geometry(settings: &Settings) -> Geometry {
    let stops = settings.decided("measurements") as u32;
    let trajectory = match settings.chosen("trajectory") {
        TrajectoryKind::Grid => Trajectory::grid(stops),
        TrajectoryKind::SmallGrid => Trajectory::small_grid(stops),
        TrajectoryKind::Circle => match settings.number("radius") {
            Some(radius_m) => Trajectory::Circle { radius_m },
            None => Trajectory::CIRCLE,
        },
    };
    let height_m = settings.number("height").unwrap_or(800.0);
    let environment = settings.chosen("environment");
    Geometry { stops, per_stop: 1, height_m, trajectory, environment }
}

/// The filter for a stationary user.
pub(super) fn filter_of(settings: &Settings) -> FilterSetting {
    let particles = settings.number("particles").map_or(500, |count| count as usize);
    match settings.chosen("filter") {
        FilterKind::Best => FilterSetting::Best(particles),
        FilterKind::Published => {
            let resampler = settings.chosen::<ResamplerKind>("resampler").into();
            FilterSetting::Published(PublishedFilter { particles, resampler })
        }
    }
}

/// The path loss that a channel expects for a user at a position (dB); `None` unless the height of the stop is
/// positive.
pub(super) fn expected_loss_db(
    channel: &Channel<f64>,
    stop: &Stop,
    place: [f64; 2],
) -> Option<f64> {
    let loss = channel.path_loss(distance(stop.place, place), stop.height);
    loss.ok().map(|loss| loss.mean())
}
