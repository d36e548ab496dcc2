//! `host-sim replay drone`: a recorded flight becomes a place.

use std::fmt;
use std::path::{Path, PathBuf};

use kestirim_air_to_ground::{FreeSpace, LevelPrior, Measurement};
use kestirim_particle_filter::Region;
use kestirim_user_locator::{Beacon, Locator};
use serde::Serialize;

use super::area::Area;
use super::flight::{self, Flight, Quantity, Stop};
use super::scenario::{EnvironmentKind, WAVELENGTH_M};
use crate::metrics::distance;
use crate::text::printable_path;
use crate::{Error, output};

/// Points of a lattice.
const POINTS: usize = 2000;
/// Most measurements of a flight among buildings; of more as many are taken, evenly.
const MOST: usize = 400;
/// And over open ground, where what is measured close together says the same.
const MOST_OPEN: usize = 100;
/// How far beyond the flight the user may be if no area is given, m.
const BEYOND_M: f64 = 500.0;
/// From here on a drone hears nothing, m.
const FAR_M: f64 = 20_000.0;
/// Levels of the transmitter that are thought possible about the nominal one, dB.
const LEVELS_DB: f64 = 100.0;
/// How well a path loss is calibrated, dB.
const CALIBRATION_DB: f64 = 3.0;
/// Errors are told after each of these, s.
const MINUTE_S: f64 = 60.0;

/// Options of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Replay {
    /// The flight: CSV with columns t,x,y,h and `path_loss_db` or `rssi_db` (s, m, dB)
    #[arg(long, value_name = "FILE")]
    pub log: PathBuf,
    /// Where the user really is: CSV with columns x,y and one line (m); serves accuracy alone
    #[arg(long, value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// What is built on the ground: the thesis' channel at 2 GHz
    #[arg(long, value_name = "NAME", value_enum, conflicts_with = "free_space")]
    pub environment: Option<EnvironmentKind>,
    /// Nothing is built on the ground, and what antennas there are is unknown: the default
    #[arg(long)]
    pub free_space: bool,
    /// Where the user can be: CSV with columns x,y, the corners of a polygon (m)
    #[arg(long, value_name = "FILE")]
    pub area: Option<PathBuf>,
    /// Write t,x,y,sd of each measurement to this file
    #[arg(long, value_name = "OUT.csv")]
    pub track: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

/// Where the user is after some measurements.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Estimate {
    t: f64,
    place: [f64; 2],
    sd_m: f64,
    level_db: Option<f64>,
    /// Whether the 90 % region holds the true place, if that is known.
    covered: Option<bool>,
}

impl Replay {
    /// Reads, locates, compares, writes and prints.
    ///
    /// # Errors
    /// Whatever is wrong with the options or the files; then nothing is printed.
    pub fn run(&self) -> Result<(), Error> {
        let report = self.report()?;
        for warning in &report.warnings {
            output::warn(&format!("warning: {}: {warning}", printable_path(&self.log)));
        }
        output::show(&report, self.json)
    }

    /// What [`Replay::run`] prints.
    ///
    /// # Errors
    /// As there.
    pub fn report(&self) -> Result<Report, Error> {
        let inputs = [Some(&self.log), self.truth.as_ref(), self.area.as_ref()];
        output::refuse_overwriting("--track", self.track.as_deref(), inputs.into_iter().flatten())?;
        let mut flight = flight::read(&self.log)?;
        let truth = self.truth.as_deref().map(flight::read_truth).transpose()?;
        let area = self.area.as_deref().map(Area::read).transpose()?;
        let mut warnings = Vec::new();
        if flight.unusable > 0 {
            let count = flight.unusable;
            warnings.push(format!(
                "rows left out: {count} (a height is above 0 and below 20000 m, a measurement within \
                 ±300 dB)"
            ));
        }
        let most = if self.environment.is_some() { MOST } else { MOST_OPEN };
        thin_out(&mut flight.stops, most, &mut warnings);
        if flight.stops.len() < 3 {
            return Err(Error::File {
                path: self.log.clone(),
                problem:
                    "expected at least three measurements within ±300 dB, from above the ground"
                        .to_owned(),
            });
        }
        if area.is_none() {
            warnings.push(format!(
                "the user is looked for up to {BEYOND_M} m beyond the flight (--area)"
            ));
        }
        if area.as_ref().is_some_and(|area| far(area, &flight.stops)) {
            warnings.push("no measurement was made within 20 km of the area".to_owned());
        }
        let mut search = Search::new(&flight, area.as_ref(), truth);
        // What comes in between takes as long as the end, each time.
        search.only_last = truth.is_none() && self.track.is_none();
        let estimates = match self.environment {
            None => search.in_free_space(flight.quantity),
            Some(environment) => search.among_buildings(environment, flight.quantity),
        };
        let Some(last) = estimates.last() else {
            return Err(Error::File {
                path: self.log.clone(),
                problem: "no place explains the measurements".to_owned(),
            });
        };
        let every = self.environment.is_some() || !search.only_last;
        if every && estimates.len() < flight.stops.len() {
            warnings.push("some measurements are explained by no place: left out".to_owned());
        }
        if let Some(path) = &self.track {
            write_track(path, &estimates)?;
        }
        Ok(Report {
            system: "drone",
            measurements: flight.stops.len(),
            estimate: Place { x: last.place[0], y: last.place[1] },
            sd_m: last.sd_m,
            level_db: last.level_db,
            level_name: if self.environment.is_some() {
                "level of the transmitter"
            } else {
                "level at one metre"
            },
            warnings,
            accuracy: truth.map(|truth| Accuracy::of(&estimates, truth)),
        })
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

/// Where a user is looked for.
struct Search<'a> {
    stops: &'a [Stop],
    area: Option<&'a Area>,
    /// Coordinates are counted from here, so that they stay small.
    origin: [f64; 2],
    high: [f64; 2],
    truth: Option<[f64; 2]>,
    /// Whether only the last estimate is wanted.
    only_last: bool,
}

impl<'a> Search<'a> {
    fn new(flight: &'a Flight, area: Option<&'a Area>, truth: Option<[f64; 2]>) -> Self {
        let (low, high) = area.map_or_else(|| surroundings(&flight.stops), Area::bounds);
        Self { stops: &flight.stops, area, origin: low, high, truth, only_last: false }
    }

    fn inside(&self, place: [f64; 2]) -> bool {
        self.area.is_none_or(|area| area.contains(self.outward(place)))
    }

    fn inward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x - self.origin[0], y - self.origin[1]]
    }

    fn outward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x + self.origin[0], y + self.origin[1]]
    }

    fn measurement(&self, stop: &Stop) -> Option<Measurement<f64>> {
        Measurement::new(self.inward(stop.place), stop.height, stop.loss).ok()
    }

    fn region(&self) -> Region<f64, 2> {
        Region::new([0.0; 2], self.inward(self.high)).expect("a box of finite corners")
    }

    /// Over open ground.
    fn in_free_space(&self, quantity: Quantity) -> Vec<Estimate> {
        let level = match quantity {
            Quantity::Level => None,
            // What 2 GHz loses on the first metre.
            Quantity::PathLoss => Some(LevelPrior {
                mean: -20.0 * (4.0 * std::f64::consts::PI / WAVELENGTH_M).log10(),
                sigma: CALIBRATION_DB,
            }),
        };
        let mut beacon = Box::new(Beacon::<f64, MOST_OPEN>::new(FreeSpace::new(level)));
        let mut estimates = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let taken = self.measurement(stop).is_some_and(|m| beacon.measure(&m).is_ok());
            if !taken || (self.only_last && number + 1 < self.stops.len()) {
                continue;
            }
            let found = beacon.estimate::<POINTS>(&self.region(), |place| self.inside(place));
            let Ok(found) = found else { continue };
            let covered = self.truth.map(|truth| beacon.credible(&found, self.inward(truth), 0.9));
            estimates.push(Estimate {
                t: stop.t,
                place: self.outward(found.place),
                sd_m: found.moments().spread(),
                level_db: (quantity == Quantity::Level).then_some(found.level),
                covered,
            });
        }
        estimates
    }

    /// Through the thesis' channel.
    fn among_buildings(&self, environment: EnvironmentKind, quantity: Quantity) -> Vec<Estimate> {
        let channel = Fenced { channel: environment.channel(), search: self };
        match quantity {
            Quantity::PathLoss => {
                let region = self.region();
                self.follow::<2>(Locator::new(channel, &region))
            }
            Quantity::Level => {
                let [width, height] = self.inward(self.high);
                let corners = ([0.0, 0.0, -LEVELS_DB], [width, height, LEVELS_DB]);
                let region = Region::new(corners.0, corners.1).expect("a box of finite corners");
                self.follow::<3>(Locator::new(channel, &region))
            }
        }
    }

    /// Whether the 90 % region of places holds the true one. The level, where it is a third coordinate, is
    /// integrated over: nobody knows the true one.
    fn covered<const D: usize>(
        &self,
        locator: &Locator<f64, POINTS, MOST, D, Fenced<'_>>,
        truth: [f64; 2],
    ) -> Option<bool> {
        let truth = self.inward(truth);
        if D == 2 {
            let state = std::array::from_fn(|axis| truth[axis]);
            return locator.credible(&state, 0.9);
        }
        let moments = locator.moments();
        let (level, deviation) = (moments.mean()[D - 1], moments.deviation()[D - 1]);
        let levels = (0..LEVELS)
            .map(|k| level + deviation * (8.0 * f64::from(k) / f64::from(LEVELS - 1) - 4.0));
        let density = |[x, y]: [f64; 2]| {
            log_sum(levels.clone().map(|level| {
                let state = std::array::from_fn(|axis| [x, y, level][axis]);
                locator.log_posterior(&state)
            }))
        };
        let posterior = locator.posterior();
        let mut points: Vec<(f64, f64)> = (0..posterior.len())
            .filter_map(|index| {
                Some((posterior.point(index)?, posterior.log_weights().get(index)?))
            })
            .filter(|(_, log_weight)| **log_weight > -12.0)
            .map(|(state, log_weight)| (density([state[0], state[1]]), log_weight.exp()))
            .collect();
        points.sort_by(|a, b| b.0.total_cmp(&a.0));
        let all: f64 = points.iter().map(|(_, weight)| weight).sum();
        let mut sum = 0.0;
        let border = points.iter().find(|(_, weight)| {
            sum += weight;
            sum >= 0.9 * all
        });
        border.map(|(least, _)| density(truth) >= *least)
    }

    fn follow<const D: usize>(
        &self,
        locator: Locator<f64, POINTS, MOST, D, Fenced<'_>>,
    ) -> Vec<Estimate> {
        let mut locator = Box::new(locator);
        let mut estimates = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let Some(measurement) = self.measurement(stop) else { continue };
            if locator.measure(&measurement).is_err() {
                continue;
            }
            let moments = locator.moments();
            let (mean, deviation) = (moments.mean(), moments.deviation());
            let last = number + 1 == self.stops.len();
            let covered =
                self.truth.filter(|_| last).and_then(|truth| self.covered(&locator, truth));
            estimates.push(Estimate {
                t: stop.t,
                place: self.outward([mean[0], mean[1]]),
                sd_m: deviation[0].hypot(deviation[1]),
                // A level received is the negative loss: the more the transmitter sends, the less.
                level_db: mean.get(2).map(|loss| -loss),
                covered,
            });
        }
        estimates
    }
}

/// How many levels stand for all.
const LEVELS: u32 = 41;

/// Adds up exponentials of logarithms, as a logarithm.
fn log_sum(logs: impl Iterator<Item = f64>) -> f64 {
    let logs: Vec<f64> = logs.collect();
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest + logs.iter().map(|log| (log - largest).exp()).sum::<f64>().ln()
}

/// A channel to users within the area only.
struct Fenced<'a> {
    channel: kestirim_air_to_ground::Channel<f64>,
    search: &'a Search<'a>,
}

impl kestirim_air_to_ground::Likelihood<f64> for Fenced<'_> {
    fn log_likelihood(&self, measurement: &Measurement<f64>, user: [f64; 2]) -> f64 {
        if self.search.inside(user) {
            self.channel.log_likelihood(measurement, user)
        } else {
            f64::NEG_INFINITY
        }
    }
}

/// Whether no stop is anywhere near an area.
fn far(area: &Area, stops: &[Stop]) -> bool {
    let (low, high) = area.bounds();
    let beside = |axis: usize, at: f64| at < low[axis] - FAR_M || at > high[axis] + FAR_M;
    stops.iter().all(|stop| beside(0, stop.place[0]) || beside(1, stop.place[1]))
}

/// The box around a flight, and some more.
fn surroundings(stops: &[Stop]) -> ([f64; 2], [f64; 2]) {
    let bound = |axis: usize, sign: f64| {
        let outermost = stops.iter().map(|stop| sign * stop.place[axis]).fold(f64::MIN, f64::max);
        sign * (outermost + BEYOND_M)
    };
    ([bound(0, -1.0), bound(1, -1.0)], [bound(0, 1.0), bound(1, 1.0)])
}

fn write_track(path: &Path, estimates: &[Estimate]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["t", "x", "y", "sd"])?;
        for Estimate { t, place: [x, y], sd_m, .. } in estimates {
            table.write_record([t, x, y, sd_m].map(|number| format!("{number:.3}")))?;
        }
        table.flush()
    })
}

/// What the command prints.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Always `drone`.
    pub system: &'static str,
    /// How many were used.
    pub measurements: usize,
    /// Where the user is.
    pub estimate: Place,
    /// Root mean square distance from the estimate that the filter expects, m.
    pub sd_m: f64,
    /// Where the level was not known, what the transmitter sends, dB (received level = this − path loss); over
    /// open ground, where no frequency is known either, what is received at one metre.
    pub level_db: Option<f64>,
    #[serde(skip)]
    level_name: &'static str,
    /// What a reader should know.
    pub warnings: Vec<String>,
    /// How far that is from the truth, if it is known.
    pub accuracy: Option<Accuracy>,
}

/// A place, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Place {
    /// As x in the log.
    pub x: f64,
    /// As y in the log.
    pub y: f64,
}

/// How good an estimate is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Accuracy {
    /// Distance of the last estimate from the truth, m.
    pub error_m: f64,
    /// The same after each minute since the first measurement.
    pub error_after_s: Vec<ErrorAfter>,
    /// Whether the last 90 % region holds the truth.
    pub in_90_percent_region: Option<bool>,
}

/// An error at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ErrorAfter {
    /// Time since the first measurement, s.
    pub s: f64,
    /// Distance of the estimate from the truth, m.
    pub error_m: f64,
}

impl Accuracy {
    fn of(estimates: &[Estimate], truth: [f64; 2]) -> Self {
        let error = |estimate: &Estimate| distance(estimate.place, truth);
        let begin = estimates.first().map_or(0.0, |first| first.t);
        let end = estimates.last().map_or(0.0, |last| last.t);
        let minutes = ((end - begin) / MINUTE_S).ceil().clamp(1.0, 1000.0) as u32;
        let error_after_s = (1..=minutes)
            .filter_map(|minute| {
                let s = f64::from(minute) * MINUTE_S;
                let last = estimates.iter().rev().find(|estimate| estimate.t - begin <= s)?;
                Some(ErrorAfter { s, error_m: error(last) })
            })
            .collect();
        Self {
            error_m: estimates.last().map_or(f64::NAN, error),
            error_after_s,
            in_90_percent_region: estimates.last().and_then(|last| last.covered),
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        row("measurements", self.measurements.to_string());
        row("place", format!("{:.1} m, {:.1} m", self.estimate.x, self.estimate.y));
        row("standard deviation", format!("{:.1} m", self.sd_m));
        if let Some(level) = self.level_db {
            row(self.level_name, format!("{level:.1} dB"));
        }
        if let Some(accuracy) = &self.accuracy {
            row("error", format!("{:.1} m", accuracy.error_m));
            for ErrorAfter { s, error_m } in &accuracy.error_after_s {
                row(&format!("error after {s} s"), format!("{error_m:.1} m"));
            }
            if let Some(inside) = accuracy.in_90_percent_region {
                row("in the 90 % region", if inside { "yes" } else { "no" }.to_owned());
            }
        }
        table.fmt(f)
    }
}
