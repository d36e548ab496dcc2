//! A single cell of the experiment: a user who is stationary in 2000 m × 2000 m, or moves in 4000 m × 4000 m.

use kestirim_replay::drone::EnvironmentKind;

use super::choices::{FilterKind, ResamplerKind, name};
use super::{FilterSetting, Geometry, Policy, Walk};
use crate::output;
use crate::system::{Idle, Setting, Settings};

/// The range and step of lengths in a cell (m).
const METRES: [f64; 3] = [0.1, 10_000.0, 0.1];

/// The available settings.
pub fn table() -> Vec<Setting> {
    vec![
        super::filter(),
        super::resampler(),
        super::particles(500.0),
        super::height(METRES, 800.0),
        super::radius(METRES),
        super::measurements(400.0),
        super::environment(false),
        Setting::switch("moving", "The user walks a circle, and the drone follows", false),
        super::user_radius(METRES),
        super::end_time([1.0, 10_000.0, 1.0]),
        super::speed(METRES),
    ]
}

/// Why a setting has no effect given the others.
pub fn idle(cell: &Settings, name: &str) -> Option<Idle> {
    let is_moving = cell.is_on("moving");
    match name {
        "radius" | "measurements" if is_moving => {
            Some(Idle::foreign("is for a user who stays, not for --moving"))
        }
        "user-radius" | "end-time" if !is_moving => Some(Idle::foreign("is for --moving")),
        _ => None,
    }
}

/// The walk of a moving user.
pub fn walk(cell: &Settings) -> Walk {
    super::walk_of(
        cell,
        match cell.chosen("filter") {
            FilterKind::Published => {
                Policy::Hover(cell.chosen::<ResamplerKind>("resampler").into())
            }
            FilterKind::Best => Policy::Orbit,
        },
    )
}

/// The geometry of the measurements of a stationary user.
pub fn geometry(cell: &Settings) -> Geometry {
    super::geometry(cell)
}

/// The filter for a stationary user.
pub fn filter(cell: &Settings) -> FilterSetting {
    super::filter_of(cell)
}

/// The settings of a cell that are not numbers, as text.
pub fn described(cell: &Settings) -> String {
    let environment = name(&cell.chosen::<EnvironmentKind>("environment"));
    if cell.chosen::<FilterKind>("filter") == FilterKind::Published {
        return format!("{environment}, {}", cell.choice("resampler"));
    }
    if cell.is_given("resampler") {
        output::warn("warning: only --filter published resamples by --resampler");
    }
    environment
}
