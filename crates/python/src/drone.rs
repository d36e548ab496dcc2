//! Where the user of a drone is, from path losses or levels alone.

use kestirim_air_to_ground::{Channel, Environment, FreeSpace, LevelPrior, Measurement};
use kestirim_health::{Health, Reason};
use kestirim_particle_filter::Region;
use kestirim_user_locator::{Area, BeaconSearch, LevelStep, Locator, Within};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Line, Results, Table, reasons, rows, values};
use crate::error::{KestirimError, refused, unknown};

/// Points of a lattice.
const POINTS: usize = 2000;
/// Most measurements among buildings; of more as many are taken, evenly.
const MOST: usize = 400;
/// And over open ground, where what is measured close together says the same.
const MOST_OPEN: usize = 100;
/// Most corners of an area.
const MOST_CORNERS: usize = 4096;
/// How far beyond the flight the user may be if no area is given, m.
const BEYOND_M: f64 = 500.0;
/// Levels of the transmitter that are thought possible about the nominal one, dB.
const LEVELS_DB: f64 = 100.0;
/// How well a path loss is calibrated, dB.
const CALIBRATION_DB: f64 = 3.0;
/// Wavelength of 2 GHz with the thesis' speed of light, m.
const WAVELENGTH_M: f64 = 0.15;
/// Heights above which no drone flies, m, and the largest loss or level that a radio measures, dB.
const HIGHEST_M: f64 = 20_000.0;
const LARGEST_DB: f64 = 300.0;
/// Stack of a thread that estimates: lattices of thousands of points are moved about before they lie on the heap.
const STACK_BYTES: usize = 16 << 20;

type Corners = Area<f64, MOST_CORNERS>;
type ChannelWithin<'a> = Within<'a, f64, Channel<f64>, MOST_CORNERS>;

/// A flight: t (n,), place (n, 2), height (n,), and what was measured (n,): losses, or levels if `levels`.
#[pyfunction]
#[pyo3(signature = (t, place, height, value, levels, area, environment, every))]
pub(crate) fn drone<'py>(
    py: Python<'py>,
    t: Line<'py>,
    place: Table<'py>,
    height: Line<'py>,
    value: Line<'py>,
    levels: bool,
    area: Option<Table<'py>>,
    environment: Option<&str>,
    every: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let channel = environment.map(channel).transpose()?;
    let stops = stops(values(&t)?, rows(&place)?, values(&height)?, values(&value)?, levels)?;
    let area = area.as_ref().map(rows::<2>).transpose()?.map(<[[f64; 2]]>::to_vec);
    let found = py.detach(|| {
        let search = move || -> PyResult<Found> {
            let most = if channel.is_some() { MOST } else { MOST_OPEN };
            let count = stops.len();
            let stops = if count > most {
                (0..most).map(|k| stops[k * count / most]).collect()
            } else {
                stops
            };
            let search = Search::new(stops, area.as_deref(), every)?;
            Ok(search.find(channel, levels))
        };
        let thread = std::thread::Builder::new().stack_size(STACK_BYTES).spawn(search);
        let thread = thread.map_err(|error| refused(format!("no thread: {error}")))?;
        thread.join().map_err(|_| refused("the search ended unexpectedly"))?
    })?;
    if found.estimates.is_empty() {
        return Err(refused("no place explains the measurements"));
    }
    let doubts = found.doubts();
    let of = |number: fn(&Estimate) -> f64| found.estimates.iter().map(number).collect::<Vec<_>>();
    let results = Results::new(py)
        .line("t", of(|estimate| estimate.t))?
        .table("position", found.estimates.iter().map(|estimate| estimate.place).collect())?
        .line("sigma", of(|estimate| estimate.sigma))?
        .line("level", of(|estimate| estimate.level))?
        .line("health", vec![0_u8; found.estimates.len()])?
        .with("measurements", found.stops.len())?
        .with("reasons", reasons(doubts))?;
    Ok(results.done())
}

fn channel(environment: &str) -> PyResult<Channel<f64>> {
    let environment = match environment {
        "suburban" => Environment::suburban(),
        "urban" => Environment::urban(),
        "dense-urban" => Environment::dense_urban(),
        "high-rise" => Environment::high_rise(),
        _ => {
            let expected = "'open', 'suburban', 'urban', 'dense-urban' or 'high-rise'";
            return Err(unknown("environment", environment, expected));
        }
    };
    Channel::new(&environment, WAVELENGTH_M).map_err(refused)
}

/// One measurement.
#[derive(Clone, Copy)]
struct Stop {
    t: f64,
    place: [f64; 2],
    height: f64,
    loss: f64,
}

/// Those that a channel can use, in the order of their times.
fn stops(
    t: &[f64],
    place: &[[f64; 2]],
    height: &[f64],
    value: &[f64],
    levels: bool,
) -> PyResult<Vec<Stop>> {
    let lines = t.iter().zip(place).zip(height).zip(value);
    let stop = |(((&t, &place), &height), &value): (((&f64, &[f64; 2]), &f64), &f64)| {
        // As logs are read, to the microsecond.
        let t = crate::arrays::microseconds(t) as f64 * 1e-6;
        Stop { t, place, height, loss: if levels { -value } else { value } }
    };
    let is_usable = |stop: &Stop| {
        let is_place = stop.place.iter().all(|axis| axis.is_finite());
        is_place && stop.height > 0.0 && stop.height < HIGHEST_M && stop.loss.abs() <= LARGEST_DB
    };
    let mut stops: Vec<Stop> = lines.map(stop).filter(is_usable).collect();
    if stops.len() < 3 {
        let found = stops.len();
        return Err(KestirimError::new_err(format!(
            "expected at least three measurements within ±300 dB, from above the ground, found {found}"
        )));
    }
    stops.sort_by(|a, b| a.t.total_cmp(&b.t));
    Ok(stops)
}

/// Where the user is after a measurement.
struct Estimate {
    t: f64,
    place: [f64; 2],
    sigma: f64,
    level: f64,
}

struct Found {
    stops: Vec<Stop>,
    estimates: Vec<Estimate>,
}

impl Found {
    /// Levels that step, as seen from the estimated place.
    fn doubts(&self) -> Health {
        let measured = |stop: &Stop| Measurement::new(stop.place, stop.height, stop.loss).ok();
        let measurements: Vec<_> = self.stops.iter().filter_map(measured).collect();
        let place = self.estimates.last().map(|estimate| estimate.place);
        let step = place.and_then(|place| LevelStep::find(&measurements, place));
        Health::GOOD.with(Reason::Innovations, step.is_some())
    }
}

/// Where a user is looked for.
struct Search {
    stops: Vec<Stop>,
    /// Coordinates are counted from here, so that they stay small.
    origin: [f64; 2],
    area: Box<Corners>,
    every: bool,
}

impl Search {
    fn new(stops: Vec<Stop>, corners: Option<&[[f64; 2]]>, every: bool) -> PyResult<Self> {
        let (origin, area) = match corners {
            Some(corners) => {
                let area = Corners::new(corners).ok().filter(|area| area.size() >= 1.0);
                let area = area.ok_or_else(|| {
                    refused("area: expected the corners of an area of a square metre at least, one after the other")
                })?;
                let origin = *area.region().low();
                (origin, area.relative_to(origin))
            }
            None => surroundings(&stops)?,
        };
        Ok(Self { stops, origin, area: Box::new(area.map_err(refused)?), every })
    }

    fn find(self, channel: Option<Channel<f64>>, levels: bool) -> Found {
        let estimates = match channel {
            None => self.in_free_space(levels),
            Some(channel) => self.among_buildings(channel, levels),
        };
        Found { stops: self.stops, estimates }
    }

    fn outward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x + self.origin[0], y + self.origin[1]]
    }

    fn measurement(&self, stop: &Stop) -> Option<Measurement<f64>> {
        let inward = [stop.place[0] - self.origin[0], stop.place[1] - self.origin[1]];
        Measurement::new(inward, stop.height, stop.loss).ok()
    }

    fn is_wanted(&self, number: usize) -> bool {
        self.every || number + 1 == self.stops.len()
    }

    /// Over open ground.
    fn in_free_space(&self, levels: bool) -> Vec<Estimate> {
        // What 2 GHz loses on the first metre; of a level nothing is known.
        let prior = (!levels).then(|| LevelPrior {
            mean: -20.0 * (4.0 * std::f64::consts::PI / WAVELENGTH_M).log10(),
            sigma: CALIBRATION_DB,
        });
        // One place is that of the last measurement: all of them are kept.
        let mut search = Box::new(BeaconSearch::<f64, { MOST_OPEN + 1 }, MOST_CORNERS>::new(
            FreeSpace::new(prior),
            (*self.area).clone(),
        ));
        let mut estimates = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let Some(measurement) = self.measurement(stop) else { continue };
            search.measure(&measurement);
            if !self.is_wanted(number) {
                continue;
            }
            let Ok(found) = search.estimate::<POINTS>() else { continue };
            estimates.push(Estimate {
                t: stop.t,
                place: self.outward(found.place),
                sigma: found.moments().spread(),
                level: if levels { found.level } else { f64::NAN },
            });
        }
        estimates
    }

    /// Through the thesis' channel.
    fn among_buildings(&self, channel: Channel<f64>, levels: bool) -> Vec<Estimate> {
        let channel = Within::new(channel, &*self.area);
        let region = self.area.region();
        if !levels {
            return self.follow::<2>(Locator::new(channel, region));
        }
        let [width, height] = *region.high();
        let corners = ([0.0, 0.0, -LEVELS_DB], [width, height, LEVELS_DB]);
        match Region::new(corners.0, corners.1) {
            Ok(region) => self.follow::<3>(Locator::new(channel, &region)),
            Err(_) => Vec::new(),
        }
    }

    fn follow<const D: usize>(
        &self,
        locator: Locator<f64, POINTS, MOST, D, ChannelWithin<'_>>,
    ) -> Vec<Estimate> {
        let mut locator = Box::new(locator);
        let mut estimates = Vec::new();
        for (number, stop) in self.stops.iter().enumerate() {
            let Some(measurement) = self.measurement(stop) else { continue };
            if locator.measure(&measurement).is_err() || !self.is_wanted(number) {
                continue;
            }
            let moments = locator.moments();
            let (mean, deviation) = (moments.mean(), moments.deviation());
            estimates.push(Estimate {
                t: stop.t,
                place: self.outward([mean[0], mean[1]]),
                sigma: deviation[0].hypot(deviation[1]),
                // A level received is the negative loss: the more the transmitter sends, the less.
                level: mean.get(2).map_or(f64::NAN, |loss| -loss),
            });
        }
        estimates
    }
}

/// The box around a flight, and some more: its lower corner, and the area as seen from there.
type Surroundings = ([f64; 2], Result<Corners, kestirim_user_locator::Error>);

fn surroundings(stops: &[Stop]) -> PyResult<Surroundings> {
    let bound = |axis: usize, sign: f64| {
        let outermost = stops.iter().map(|stop| sign * stop.place[axis]).fold(f64::MIN, f64::max);
        sign * (outermost + BEYOND_M)
    };
    let origin = [bound(0, -1.0), bound(1, -1.0)];
    let size = [bound(0, 1.0) - origin[0], bound(1, 1.0) - origin[1]];
    let region = Region::new([0.0; 2], size).map_err(refused)?;
    Ok((origin, Area::rectangle(&region)))
}
