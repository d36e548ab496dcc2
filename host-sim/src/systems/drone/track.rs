//! Feeds a flight to the filters, recorded or synthetic.

use kestirim_replay::drone::{
    Area, BEYOND_M, EnvironmentKind, MOST_DRAWN, Search, Stop, Track, thinned,
};

use super::recording::{Recorded, Recording};
use super::settings::{built, filter_of, geometry, walk, wavelength_m};
use super::simulate::{moving_user, static_user};
use crate::Error;
use crate::system::{Detail, Settings};

/// From here on a drone hears nothing, m.
const FAR_M: f64 = 20_000.0;
/// Estimates on the way that are held against the truth, and not drawn.
const MOST_JUDGED: usize = 10;
/// A drone that searches an area is not beside it for a larger share of its measurements.
const MOST_OUTSIDE: f64 = 0.25;

/// Tracks a user.
///
/// # Errors
/// [`Error::File`] if no place explains a recorded flight.
pub(super) fn track(
    recording: &Recording,
    settings: &Settings,
    detail: Detail,
) -> Result<Track, Error> {
    let seed = settings.decided("seed") as u64;
    match recording {
        Recording::Flight(recorded) => find(recorded, settings, detail),
        Recording::Moving => Ok(moving_user::track(&walk(settings), seed, 0)),
        Recording::Staying => {
            Ok(static_user::track(&geometry(settings), filter_of(settings), seed, 0))
        }
    }
}

/// Finds the user of a recorded flight.
fn find(recorded: &Recorded, settings: &Settings, detail: Detail) -> Result<Track, Error> {
    let Recorded { flight, truth, area, .. } = recorded;
    let environment = built(settings);
    let area = area.as_deref();
    let (stops, mut warnings) = used(recorded, environment);
    // What comes in between takes as long as the end, each time.
    let most = match (detail, truth) {
        (Detail::Every, _) => MOST_DRAWN,
        (Detail::Result, Some(_)) => MOST_JUDGED,
        (Detail::Result, None) => 1,
    };
    let search = Search::new(&stops, area, *truth, most, detail == Detail::Every);
    let search = search.map_err(|error| recorded.refused(&error.to_string()))?;
    let search = search.at_wavelength(wavelength_m(settings));
    let estimates = search.find(environment, flight.quantity);
    if estimates.is_empty() {
        return Err(recorded.refused("no place explains the measurements"));
    }
    // Over open ground every measurement counts, and there is an estimate after one in several.
    if environment.is_some() && estimates.len() < stops.len() {
        warnings.push("some measurements are explained by no place: left out".to_owned());
    }
    let truth = truth.map_or_else(Vec::new, |truth| vec![truth; stops.len()]);
    Ok(Track { stops, truth, estimates, warnings, flown: None })
}

/// As many measurements as can be remembered, and what a reader should know.
fn used(recorded: &Recorded, environment: Option<EnvironmentKind>) -> (Vec<Stop>, Vec<String>) {
    let Recorded { flight, area, .. } = recorded;
    let mut warnings = Vec::new();
    if flight.unusable > 0 {
        let count = flight.unusable;
        warnings.push(format!(
            "rows left out: {count} (a height is above 0 and below 20000 m, a measurement within \
             ±300 dB)"
        ));
    }
    let stops = thinned(&flight.stops, environment);
    let (most, count) = (stops.len(), flight.stops.len());
    if count > most {
        warnings.push(format!("of {count} measurements {most} are used, evenly"));
    }
    match area {
        None => warnings
            .push(format!("the user is looked for up to {BEYOND_M} m beyond the flight (--area)")),
        Some(area) if far(area, &stops) => {
            warnings.push("no measurement was made within 20 km of the area".to_owned());
        }
        Some(area) => {
            let share = outside(area, &stops);
            if share > MOST_OUTSIDE {
                warnings.push(format!(
                    "{:.0} % of the measurements were made outside of the area: places and area must be in metres and of one \
                     origin",
                    100.0 * share
                ));
            }
        }
    }
    (stops, warnings)
}

/// Share of the stops that are beyond an area's corners.
fn outside(area: &Area, stops: &[Stop]) -> f64 {
    let (low, high) = (area.region().low(), area.region().high());
    let is_beyond = |at: f64, axis: usize| at < low[axis] || at > high[axis];
    let beyond = |stop: &&Stop| is_beyond(stop.place[0], 0) || is_beyond(stop.place[1], 1);
    stops.iter().filter(beyond).count() as f64 / stops.len().max(1) as f64
}

/// Whether no stop is anywhere near an area.
fn far(area: &Area, stops: &[Stop]) -> bool {
    let (low, high) = (area.region().low(), area.region().high());
    let beside = |axis: usize, at: f64| at < low[axis] - FAR_M || at > high[axis] + FAR_M;
    stops.iter().all(|stop| beside(0, stop.place[0]) || beside(1, stop.place[1]))
}
