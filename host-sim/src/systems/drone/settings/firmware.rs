//! The equivalent configuration of firmware.

use kestirim_replay::drone::{
    EnvironmentKind, MOST, MOST_PLACES, POINTS, Quantity, WAVELENGTH_M, level_prior,
};

use super::choices::{FlightKind, ResamplerKind};
use super::{Recording, Settings, built, filter_of, geometry, walk, wavelength_m};
use crate::system::{Literal, ScalarKind};
use crate::systems::drone::simulate::moving_user::{Policy, Walk};
use crate::systems::drone::simulate::static_user::FilterSetting;

const CHANNELS: &str = "kestirim_air_to_ground";
const FILTERS: &str = "kestirim_particle_filter";
const LOCATORS: &str = "kestirim_user_locator";

/// The configuration of firmware, in single precision.
pub(in crate::systems::drone) fn firmware(
    recording: Option<&Recording>,
    settings: &Settings,
) -> String {
    let literal = match recording {
        Some(Recording::Moving) => moving(settings, &walk(settings)),
        Some(Recording::Staying) => staying(settings),
        Some(Recording::Flight(recorded)) => {
            forgetting(settings, recorded_flight(settings, recorded.flight.quantity))
        }
        None => forgetting(settings, recorded_flight(settings, Quantity::Level)),
    };
    literal.to_string()
}

/// Adds a line about the measurements that a search does not forget by itself.
fn forgetting(settings: &Settings, literal: Literal) -> Literal {
    match settings.number("window") {
        Some(window_s) => literal.then(format!(
            "// The user moves: a search of its own from the measurements of each {window_s} s."
        )),
        None => literal,
    }
}

/// The search for the user of a recorded flight.
fn recorded_flight(settings: &Settings, quantity: Quantity) -> Literal {
    let wavelength_m = wavelength_m(settings);
    if let Some(environment) = built(settings) {
        let dimensions = if quantity == Quantity::Level { 3 } else { 2 };
        let channel = through(environment, wavelength_m);
        return lattice(&channel, POINTS, MOST, dimensions);
    }
    let level = level_prior(quantity, wavelength_m);
    let base = level.map_or_else(
        || "OpenGround::new(None)".to_owned(),
        |level| {
            let (mean, sigma) = (level.mean, level.sigma);
            format!("OpenGround::new(Some(LevelPrior {{ mean: {mean:?}, sigma: {sigma:?} }}))")
        },
    );
    let literal = literal(&format!("{CHANNELS}::OpenGround"), "OpenGround::<f32>", &base);
    let literal = match level {
        Some(_) => literal.import(&format!("{CHANNELS}::LevelPrior")),
        None => literal,
    };
    literal.import(&format!("{LOCATORS}::{{Area, GroundSearch}}")).then(format!(
        "let search = |area: Area<f32, 8>| GroundSearch::<f32, {MOST_PLACES}, 8>::new(config, area);"
    ))
}

/// The filter for a stationary synthetic user.
fn staying(settings: &Settings) -> Literal {
    match filter_of(settings) {
        FilterSetting::Best(points) => {
            let geometry = geometry(settings);
            let channel = through(geometry.environment, WAVELENGTH_M);
            lattice(&channel, points, geometry.stops as usize, 2)
        }
        FilterSetting::Published(filter) => {
            published(settings, filter.particles, geometry(settings).environment, None)
        }
    }
}

/// The filter for a moving synthetic user, and the drone's flight plan.
fn moving(settings: &Settings, walk: &Walk) -> Literal {
    let Walk { particles, environment, .. } = *walk;
    if let Policy::Hover(_) = walk.policy {
        return published(settings, particles, environment, Some(walk.jitter_m()));
    }
    let height = match settings.chosen("flight") {
        FlightKind::Low => "Height::Between(100.0, 1000.0)".to_owned(),
        _ => format!("Height::Fixed({:?})", walk.height_m),
    };
    literal(&format!("{LOCATORS}::Motion"), "Motion::<f32>", "Motion::people()")
        .import(&format!("{CHANNELS}::{{Channel, Environment}}"))
        .import(&format!("{FILTERS}::{{Region, Xoshiro128PlusPlus}}"))
        .import(&format!("{LOCATORS}::{{Height, Orbit, Tracker}}"))
        .then(channel(environment))
        .then(format!(
            "let tracker = |region: &Region<f32, 2>, rng: &mut Xoshiro128PlusPlus| {{\n    \
             Tracker::<f32, {particles}>::new(channel, config, region, rng)\n}};"
        ))
        .then(format!("let orbit = Orbit::<f32>::new({height});"))
}

/// The thesis' filter, with a jitter (m) if it differs from the thesis' own.
fn published(
    settings: &Settings,
    particles: usize,
    environment: EnvironmentKind,
    jitter_m: Option<f64>,
) -> Literal {
    let config = format!("{LOCATORS}::{{PublishedLocator, PublishedSettings}}");
    let mut literal = literal(&config, "PublishedSettings::<f32>", "PublishedSettings::thesis()")
        .number_field("jitter", jitter_m);
    let resampler: ResamplerKind = settings.chosen("resampler");
    if resampler != ResamplerKind::default() {
        literal = literal
            .import(&format!("{FILTERS}::Resampler"))
            .field("resampler", format!("Resampler::{resampler:?}"));
    }
    literal
        .import(&format!("{CHANNELS}::{{Channel, Environment}}"))
        .import(&format!("{FILTERS}::{{Region, Xoshiro128PlusPlus}}"))
        .then(channel(environment))
        .then(format!(
            "let locator = |region: &Region<f32, 2>, rng: &mut Xoshiro128PlusPlus| {{\n    \
             PublishedLocator::<f32, {particles}>::new(channel, region, config, rng)\n}};"
        ))
}

/// A lattice that is laid anew over the posterior; with three dimensions, the level is one of them.
fn lattice(channel: &str, points: usize, measurements: usize, dimensions: usize) -> Literal {
    literal(&format!("{CHANNELS}::{{Channel, Environment}}"), "Channel::<f32>", channel)
        .import(&format!("{FILTERS}::Region"))
        .import(&format!("{LOCATORS}::Locator"))
        .then(format!(
            "let locator = |region: &Region<f32, {dimensions}>| {{\n    \
         Locator::<f32, {points}, {measurements}, {dimensions}>::new(config, region)\n}};"
        ))
}

fn literal(imports: &str, config: &str, base: &str) -> Literal {
    Literal::new(imports, ScalarKind::F32, config, base)
}

fn channel(environment: EnvironmentKind) -> String {
    format!(
        "let channel = {};",
        through(environment, WAVELENGTH_M).replace("Channel::new", "Channel::<f32>::new")
    )
}

fn through(environment: EnvironmentKind, wavelength_m: f64) -> String {
    let environment = match environment {
        EnvironmentKind::Suburban => "suburban",
        EnvironmentKind::Urban => "urban",
        EnvironmentKind::DenseUrban => "dense_urban",
        EnvironmentKind::HighRise => "high_rise",
    };
    format!(
        "Channel::new(&Environment::{environment}(), {wavelength_m:?}).expect(\"a wavelength above zero\")"
    )
}
