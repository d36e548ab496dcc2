//! The position of a drone's user, from path losses or levels alone.

use kestirim_health::Reason;
use kestirim_replay::Finding;
use kestirim_replay::drone::{
    Area, Doubt, EnvironmentKind, Estimate, MOST_DRAWN, Next, Quantity, Search, Stop, check,
    thinned, wavelength_m,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Line, Results, Table, code, microseconds, reasons, rows, sentences, values};
use crate::error::{KestirimError, refused, unknown};
use crate::stack;

/// The range of transmitter frequencies, Hz.
const LOWEST_HZ: f64 = 30e6;
const HIGHEST_HZ: f64 = 30e9;

/// Locates the user from a flight: t (n,), place (n, 2), height (n,), and the measured value (n,), which is a path
/// loss, or a level if `levels`; at a frequency, Hz.
#[pyfunction]
#[pyo3(signature = (t, place, height, value, heading, levels, area, environment, frequency, window, every))]
pub(crate) fn drone<'py>(
    py: Python<'py>,
    t: Line<'py>,
    place: Table<'py>,
    height: Line<'py>,
    value: Line<'py>,
    heading: Option<Line<'py>>,
    levels: bool,
    area: Option<Table<'py>>,
    environment: Option<&str>,
    frequency: f64,
    window: Option<f64>,
    every: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let name = environment.unwrap_or("open").to_owned();
    let environment = environment.map(self::environment).transpose()?;
    if !(LOWEST_HZ..=HIGHEST_HZ).contains(&frequency) {
        return Err(refused(format!(
            "frequency: expected {LOWEST_HZ:e} to {HIGHEST_HZ:e} Hz, found {frequency:e}"
        )));
    }
    if let Some(window) = window.filter(|window| window.is_nan() || *window <= 0.0) {
        return Err(refused(format!("window: expected more than 0 s, found {window}")));
    }
    let wavelength_m = wavelength_m(frequency);
    let quantity = if levels { Quantity::Level } else { Quantity::PathLoss };
    let heading = heading.as_ref().map(values).transpose()?;
    let places = (rows(&place)?, values(&height)?, heading);
    let measured = values(&value)?;
    let stops = stops(values(&t)?, places, measured, quantity)?;
    let findings = check(&stops, quantity, measured.len() - stops.len());
    let area = area.as_ref().map(|area| rows::<2>(area).and_then(polygon)).transpose()?;
    let found = py.detach(|| {
        let search = move || -> PyResult<Found> {
            let stops = thinned(&stops, environment);
            let most = if every { MOST_DRAWN } else { 1 };
            let search = Search::new(&stops, area.as_deref(), &[], most, false);
            let search = search.map_err(refused)?.at_wavelength(wavelength_m).within(window);
            let estimates = search.find(environment, quantity);
            let channel = environment.and_then(|it| it.channel_at(wavelength_m).ok());
            let moved_m = search.moved(environment, quantity);
            let doubts = estimates
                .last()
                .into_iter()
                .flat_map(|last| Doubt::all(&stops, last, channel.as_ref(), moved_m));
            let doubts = doubts.map(|doubt| doubt.sentence(&name, quantity)).collect();
            Ok(Found { stops, estimates, doubts, findings })
        };
        stack::with_much(search)
    })?;
    found.results(py)
}

fn environment(name: &str) -> PyResult<EnvironmentKind> {
    match name {
        "suburban" => Ok(EnvironmentKind::Suburban),
        "urban" => Ok(EnvironmentKind::Urban),
        "dense-urban" => Ok(EnvironmentKind::DenseUrban),
        "high-rise" => Ok(EnvironmentKind::HighRise),
        _ => {
            let expected = "'open', 'suburban', 'urban', 'dense-urban' or 'high-rise'";
            Err(unknown("environment", name, expected))
        }
    }
}

fn polygon(corners: &[[f64; 2]]) -> PyResult<Box<Area>> {
    let area = Area::new(corners).ok().filter(|area| area.size() >= 1.0);
    area.map(Box::new).ok_or_else(|| {
        refused(
            "area: expected the corners of an area of a square metre at least, one after the other",
        )
    })
}

/// A measurement: time, position, height, and the measured value.
type Numbers<'a> = (((&'a f64, &'a [f64; 2]), &'a f64), &'a f64);

/// The measurements that a channel can use, in order of time.
fn stops(
    t: &[f64],
    (place, height, heading): (&[[f64; 2]], &[f64], Option<&[f64]>),
    value: &[f64],
    quantity: Quantity,
) -> PyResult<Vec<Stop>> {
    let lines = t.iter().zip(place).zip(height).zip(value).enumerate();
    let stop = |(line, (((&t, &place), &height), &value)): (usize, Numbers<'_>)| {
        // Rounded to the microsecond, as the readers of logs do.
        let t = microseconds(t) as f64 * 1e-6;
        let heading = heading.and_then(|all| all.get(line).copied()).filter(|it| it.is_finite());
        let loss = if quantity == Quantity::Level { -value } else { value };
        Stop { t, place, height, loss, heading: heading.map(f64::to_radians) }
    };
    let is_place = |stop: &Stop| stop.place.iter().all(|axis| axis.is_finite());
    let mut stops: Vec<Stop> =
        lines.map(stop).filter(|stop| is_place(stop) && stop.is_usable()).collect();
    if stops.len() < 3 {
        let found = stops.len();
        return Err(KestirimError::new_err(format!(
            "expected at least three measurements within ±300 dB, from above the ground, found {found}"
        )));
    }
    stops.sort_by(|a, b| a.t.total_cmp(&b.t));
    Ok(stops)
}

struct Found {
    /// The measurements that were used.
    stops: Vec<Stop>,
    estimates: Vec<Estimate>,
    /// The reasons against the explanation of the flight, one sentence each.
    doubts: Vec<String>,
    /// The findings about the measurements before the search for the user.
    findings: Vec<Finding>,
}

impl Found {
    fn results(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let Self { stops, estimates, doubts: warnings, findings } = self;
        let Some(last) = estimates.last() else {
            return Err(refused("no place explains the measurements"));
        };
        let doubts = Finding::doubts(&findings).with(Reason::Innovations, !warnings.is_empty());
        let next = last.next.map(|Next { place: [x, y], height, sd_m }| (x, y, height, sd_m));
        let level = |estimate: &Estimate| estimate.level_db.unwrap_or(f64::NAN);
        Ok(Results::new(py)
            .line("t", estimates.iter().map(|estimate| stops[estimate.stop].t).collect())?
            .table("position", estimates.iter().map(|estimate| estimate.place).collect())?
            .line("sigma", estimates.iter().map(|estimate| estimate.sd_m).collect())?
            .line("level", estimates.iter().map(level).collect())?
            .line("health", vec![code(doubts.state()); estimates.len()])?
            .with("measurements", stops.len())?
            .with("next_waypoint", next)?
            .words("warnings", warnings.into_iter().chain(sentences(&findings)))?
            .words("reasons", reasons(doubts))?
            .done())
    }
}
