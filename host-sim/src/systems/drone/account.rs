//! The results of a flight.

mod accuracy;

use kestirim_replay::drone::{Doubt, EnvironmentKind, Estimate, Next, Other, Track};
use serde::Serialize;

use self::accuracy::Accuracy;
use super::Drone;
use super::recording::Recording;
use super::recording::plane::Origin;
use super::settings::expected_loss_db;
use crate::Error;
use crate::metrics::mean;
use crate::system::{Account, HealthState, Reason, Settings, System, Table};
use crate::table::Found;
use crate::text::printable;

/// The report that a replay prints.
#[derive(Debug, Clone, Serialize)]
struct Report {
    system: &'static str,
    /// The number of measurements used.
    measurements: usize,
    /// The estimated position of the user.
    estimate: Place,
    /// The root mean square distance from the estimate that the filter expects (m).
    sd_m: f64,
    /// If the level was not known, the level that the transmitter sends in dB (received level = this − path loss); over
    /// open ground, the level received at one metre.
    level_db: Option<f64>,
    /// The place where one more measurement is expected to be most informative.
    #[serde(skip_serializing_if = "Option::is_none")]
    next_waypoint: Option<NextWaypoint>,
    /// The other transmitters of the same flight.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    others: Vec<OtherUser>,
    /// The conclusions about the format of the log.
    import: Vec<String>,
    warnings: Vec<String>,
    /// The error of the estimate, if the truth is known.
    accuracy: Option<Accuracy>,
}

/// A position (m).
#[derive(Debug, Clone, Copy, Serialize)]
struct Place {
    /// The x coordinate, as in the log.
    x: f64,
    /// The y coordinate, as in the log.
    y: f64,
    /// The latitude in degrees, if the log gave positions by latitude and longitude.
    #[serde(skip_serializing_if = "Option::is_none")]
    latitude: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    longitude: Option<f64>,
}

impl Place {
    fn of([x, y]: [f64; 2], origin: Option<Origin>) -> Self {
        let degrees = origin.map(|origin| origin.degrees([x, y]));
        Self { x, y, latitude: degrees.map(|it| it[0]), longitude: degrees.map(|it| it[1]) }
    }
}

/// The recommended place for the next measurement.
#[derive(Debug, Clone, Copy, Serialize)]
struct NextWaypoint {
    #[serde(flatten)]
    place: Place,
    height_m: f64,
    /// The standard deviation expected after that measurement (m).
    sd_m: f64,
}

/// Another transmitter and its position.
#[derive(Debug, Clone, Serialize)]
struct OtherUser {
    name: String,
    /// The estimated position; `None` if no position explains the measurements, or there are too few.
    estimate: Option<Place>,
    sd_m: Option<f64>,
    /// The error (m), if the truth is known.
    error_m: Option<f64>,
}

impl OtherUser {
    fn of(other: &Other, origin: Option<Origin>) -> Self {
        let estimate = other.estimate.as_ref();
        Self {
            name: other.name.clone(),
            estimate: estimate.map(|estimate| Place::of(estimate.place, origin)),
            sd_m: estimate.map(|estimate| estimate.sd_m),
            error_m: other.error_m(),
        }
    }

    fn in_words(&self) -> String {
        let (Some(Place { x, y, .. }), Some(sd_m)) = (&self.estimate, self.sd_m) else {
            return "not found".to_owned();
        };
        let error = self.error_m.map_or(String::new(), |error| format!(", error {error:.1} m"));
        format!("{x:.1} m, {y:.1} m, ± {sd_m:.1} m{error}")
    }
}

/// The name and the text of the fact about where to measure next.
pub(super) fn next_in_words(next: Next) -> (String, String) {
    let Next { place: [x, y], height, sd_m } = next;
    let words = format!("{x:.0} m, {y:.0} m, {height:.0} m high: ± {sd_m:.0} m expected then");
    ("measure next at".to_owned(), words)
}

/// Evaluates a flight up to the measurement that is shown.
pub(super) fn account(
    recording: &Recording,
    settings: &Settings,
    track: &Track,
) -> Result<Account, Error> {
    let now = track.now(settings.number("step"));
    let so_far = &track.estimates[..=now];
    let shown = &so_far[now];
    let is_last = so_far.len() == track.estimates.len();
    let [x, y] = shown.place;
    let accuracy = Accuracy::of(track, so_far);
    let (found, origin) = match recording {
        Recording::Flight(recorded) => (recorded.found.clone(), recorded.flight.origin),
        Recording::Moving | Recording::Staying => (Found::default(), None),
    };
    let estimate = Place::of([x, y], origin);
    let next = shown.next.filter(|_| is_last);
    let report = Report {
        system: Drone::NAME,
        measurements: if is_last { track.stops.len() } else { shown.stop + 1 },
        estimate,
        sd_m: shown.sd_m,
        level_db: shown.level_db,
        next_waypoint: next.map(|Next { place, height, sd_m }| NextWaypoint {
            place: Place::of(place, origin),
            height_m: height,
            sd_m,
        }),
        others: track.others.iter().map(|other| OtherUser::of(other, origin)).collect(),
        import: found.import.clone(),
        warnings: found.warnings.iter().chain(&track.warnings).cloned().collect(),
        accuracy,
    };
    let mut account = Account::new(&report, report.warnings.clone())?;
    account.understood(&report.import);
    account.fact("measurements", report.measurements.to_string());
    account.fact("place", format!("{x:.1} m, {y:.1} m"));
    if let Some((latitude, longitude)) = estimate.latitude.zip(estimate.longitude) {
        account.fact("latitude, longitude", format!("{latitude:.6}°, {longitude:.6}°"));
    }
    account.fact("standard deviation", format!("{:.1} m", shown.sd_m));
    match recording {
        Recording::Flight(recorded) => {
            for doubt in doubts(settings, track, shown) {
                let environment = settings.choice("environment");
                account.warn(doubt.sentence(&environment, recorded.flight.quantity));
                account.doubt(Reason::Innovations);
            }
            account.about = Some(recorded.log.clone());
            if let Some(level) = shown.level_db {
                let what = if super::settings::channel(settings).is_none() {
                    "level at one metre"
                } else {
                    "level of the transmitter"
                };
                account.fact(what, format!("{level:.1} dB"));
            }
            for (name, value) in report.accuracy.iter().flat_map(Accuracy::in_words) {
                account.fact(name, value);
            }
            if let Some((name, value)) = next.map(next_in_words) {
                account.fact(name, value);
            }
            for other in &report.others {
                account.fact(format!("transmitter {}", printable(&other.name)), other.in_words());
            }
        }
        Recording::Moving | Recording::Staying => {
            synthetic_facts(&mut account, settings, track, shown);
        }
    }
    Ok(account)
}

/// Adds facts about a synthetic flight, whose user and channel are known.
fn synthetic_facts(account: &mut Account, settings: &Settings, track: &Track, shown: &Estimate) {
    let errors = track.estimates.iter().filter_map(|estimate| track.error_m(estimate));
    if let Some(error) = track.error_m(shown) {
        account.fact("error", format!("{error:.1} m"));
    }
    let mean_error = mean(&errors.collect::<Vec<_>>());
    account.fact("mean error of all steps", format!("{mean_error:.1} m"));
    if let Some(effective) = shown.effective() {
        account.fact("effective particles", format!("{effective:.0}"));
    }
    let stop = track.stop(shown);
    account.fact("loss measured", format!("{:.1} dB", stop.loss));
    let environment: EnvironmentKind = settings.chosen("environment");
    if let Some(expected) = expected_loss_db(&environment.channel(), &stop, shown.place) {
        account.fact("loss expected at the estimate", format!("{expected:.1} dB"));
    }
    if let Some(flown) = &track.flown {
        let speed = settings.decided("speed");
        let energy = flown.energy_j(speed) / 1e3;
        account.fact("path of the drone", format!("{:.1} km", flown.path_m / 1e3));
        account.fact("energy of the flight", format!("{energy:.0} kJ at {speed} km/h"));
    }
}

/// The doubts about the flight up to `shown`.
fn doubts(settings: &Settings, track: &Track, shown: &Estimate) -> Vec<Doubt> {
    let channel = super::settings::channel(settings);
    Doubt::all(&track.stops, shown, channel.as_ref(), track.moved_m).collect()
}

/// The table of time, position and expected distance after each measurement. Doubts about the whole flight apply to
/// every row.
pub(super) fn table(recording: &Recording, settings: &Settings, track: &Track) -> Table {
    let row = |estimate: &Estimate| {
        let [x, y] = estimate.place;
        let numbers = [track.stop(estimate).t, x, y, estimate.sd_m];
        numbers.map(|number| format!("{number:.3}")).to_vec()
    };
    let doubted = match (recording, track.estimates.last()) {
        (Recording::Flight(_), Some(last)) => !doubts(settings, track, last).is_empty(),
        _ => false,
    };
    let health = if doubted { Reason::Innovations.state() } else { HealthState::Good };
    Table {
        rows: track.estimates.iter().map(row).collect(),
        health: vec![health; track.estimates.len()],
        ..Table::new(&["t", "x", "y", "sd"])
    }
}
