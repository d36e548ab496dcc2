//! Runs the filters over a flight, recorded or synthetic.

use kestirim_replay::drone::{
    Area, BEYOND_M, EnvironmentKind, MOST_DRAWN, Other, Search, Stop, Track, thinned,
};
use rayon::prelude::*;

use super::recording::flight::Heard;
use super::recording::{FEWEST_STOPS, Recorded, Recording};
use super::settings::{built, filter_of, geometry, walk, wavelength_m};
use super::simulate::{moving_user, static_user};
use crate::Error;
use crate::system::{Detail, Settings};

/// The distance beyond which a drone receives nothing (m).
const FAR_M: f64 = 20_000.0;
/// The number of intermediate estimates that are compared with the truth but not drawn.
const MOST_JUDGED: usize = 10;
/// The largest plausible share of measurements outside the area, for a drone that searches it.
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

/// Finds the users of a recorded flight.
fn find(recorded: &Recorded, settings: &Settings, detail: Detail) -> Result<Track, Error> {
    let Recorded { flight, truth, area, .. } = recorded;
    let environment = built(settings);
    let (stops, mut warnings) = used(recorded, environment);
    let name = flight.transmitter.as_deref();
    let truth = stops.iter().map(|stop| truth.of(name, stop.t)).collect::<Option<Vec<_>>>();
    let truth = truth.unwrap_or_default();
    // Each intermediate estimate takes as long as the final one.
    let most = match detail {
        Detail::Every => MOST_DRAWN,
        Detail::Result if truth.is_empty() => 1,
        Detail::Result => MOST_JUDGED,
    };
    let search = Search::new(&stops, area.as_deref(), &truth, most, detail == Detail::Every);
    let search = search.map_err(|error| recorded.refused(&error.to_string()))?;
    let window_s = settings.number("window");
    let search = search.at_wavelength(wavelength_m(settings)).within(window_s);
    let estimates = search.find(environment, flight.quantity);
    if estimates.is_empty() {
        return Err(recorded.refused("no place explains the measurements"));
    }
    // Over open ground, and with a window, there is only one estimate per several measurements.
    if environment.is_some() && window_s.is_none() && estimates.len() < stops.len() {
        warnings.push("some measurements are explained by no place: left out".to_owned());
    }
    let moved_m = search.moved(environment, flight.quantity);
    let others = flight.others.par_iter().map(|heard| other(heard, recorded, settings)).collect();
    Ok(Track { stops, truth, estimates, warnings, moved_m, flown: None, others })
}

/// Finds another transmitter of a recorded flight.
fn other(heard: &Heard, recorded: &Recorded, settings: &Settings) -> Other {
    let environment = built(settings);
    let stops = thinned(&heard.stops, environment);
    let truth = stops.last().and_then(|stop| recorded.truth.of(Some(&heard.name), stop.t));
    let search = Search::new(&stops, recorded.area.as_deref(), &[], 1, false).ok();
    let estimate = search.filter(|_| stops.len() >= FEWEST_STOPS).and_then(|search| {
        let search = search.at_wavelength(wavelength_m(settings));
        search.within(settings.number("window")).find(environment, recorded.flight.quantity).pop()
    });
    Other { name: heard.name.clone(), estimate, truth }
}

/// The measurements, thinned to as many as can be stored, and warnings for the user.
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

/// The share of the stops that lie outside an area's bounding box.
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
