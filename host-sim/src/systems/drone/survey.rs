//! A recorded flight, and where the user is looked for.

use std::path::{Path, PathBuf};

use super::area::{self, Area};
use super::flight::{self, Flight, Stop};
use super::scenario::EnvironmentKind;
use super::search::{BEYOND_M, Estimate, MOST, MOST_OPEN, Search};
use crate::Error;

/// From here on a drone hears nothing, m.
const FAR_M: f64 = 20_000.0;

/// What was read, as far as it is used.
#[derive(Debug)]
pub(super) struct Survey {
    log: PathBuf,
    /// As many measurements as can be remembered.
    pub(super) flight: Flight,
    /// Where the user really is.
    pub(super) truth: Option<[f64; 2]>,
    /// Where the user can be.
    pub(super) area: Option<Box<Area>>,
    /// What is built there; none: open ground.
    pub(super) environment: Option<EnvironmentKind>,
    /// What a reader should know.
    pub(super) warnings: Vec<String>,
}

impl Survey {
    /// Reads the files.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub(super) fn read(
        log: &Path,
        truth: Option<&Path>,
        area: Option<&Path>,
        environment: Option<EnvironmentKind>,
    ) -> Result<Self, Error> {
        let flight = flight::read(log)?;
        let truth = truth.map(flight::read_truth).transpose()?;
        let area = area.map(area::read).transpose()?;
        Self::new(log, flight, truth, area, environment)
    }

    /// From what was read.
    ///
    /// # Errors
    /// [`Error::File`] if there is too little.
    pub(super) fn new(
        log: &Path,
        mut flight: Flight,
        truth: Option<[f64; 2]>,
        area: Option<Box<Area>>,
        environment: Option<EnvironmentKind>,
    ) -> Result<Self, Error> {
        let mut warnings = Vec::new();
        if flight.unusable > 0 {
            let count = flight.unusable;
            warnings.push(format!(
                "rows left out: {count} (a height is above 0 and below 20000 m, a measurement within \
                 ±300 dB)"
            ));
        }
        let most = if environment.is_some() { MOST } else { MOST_OPEN };
        thin_out(&mut flight.stops, most, &mut warnings);
        let log = log.to_path_buf();
        if flight.stops.len() < 3 {
            let problem =
                "expected at least three measurements within ±300 dB, from above the ground";
            return Err(Error::File { path: log, problem: problem.to_owned() });
        }
        if area.is_none() {
            warnings.push(format!(
                "the user is looked for up to {BEYOND_M} m beyond the flight (--area)"
            ));
        }
        if area.as_deref().is_some_and(|area| far(area, &flight.stops)) {
            warnings.push("no measurement was made within 20 km of the area".to_owned());
        }
        Ok(Self { log, flight, truth, area, environment, warnings })
    }

    /// Where the user is looked for.
    pub(super) fn search(&self, only_last: bool) -> Search<'_> {
        Search::new(&self.flight, self.area.as_deref(), self.truth, only_last)
    }

    /// Where the user is after each measurement that some place explains.
    pub(super) fn find(&self, search: &Search<'_>) -> Vec<Estimate> {
        let quantity = self.flight.quantity;
        match self.environment {
            None => search.in_free_space(quantity),
            Some(environment) => search.among_buildings(environment, quantity),
        }
    }

    /// That no place explains the measurements.
    pub(super) fn nowhere(&self) -> Error {
        let problem = "no place explains the measurements".to_owned();
        Error::File { path: self.log.clone(), problem }
    }
}

/// Keeps as many stops as can be remembered.
fn thin_out(stops: &mut Vec<Stop>, most: usize, warnings: &mut Vec<String>) {
    let count = stops.len();
    if count <= most {
        return;
    }
    warnings.push(format!("of {count} measurements {most} are used, evenly"));
    *stops = (0..most).map(|k| stops[k * count / most]).collect();
}

/// Whether no stop is anywhere near an area.
fn far(area: &Area, stops: &[Stop]) -> bool {
    let (low, high) = (area.region().low(), area.region().high());
    let beside = |axis: usize, at: f64| at < low[axis] - FAR_M || at > high[axis] + FAR_M;
    stops.iter().all(|stop| beside(0, stop.place[0]) || beside(1, stop.place[1]))
}
