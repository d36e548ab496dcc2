//! Where a user is looked for: over open ground, or through the thesis' channel.

use kestirim_air_to_ground::{Channel, LevelPrior, Measurement};
use kestirim_particle_filter::Region;
use kestirim_user_locator::{Locator, Within};

use super::{
    Area, Cloud, EnvironmentKind, Error, Estimate, MOST_CORNERS, Quantity, Stop, WAVELENGTH_M,
};

/// Points of a lattice.
pub const POINTS: usize = 2000;
/// Most measurements of a flight among buildings; of more as many are taken, evenly.
pub const MOST: usize = 400;
/// How far beyond the flight the user may be if no area is given, m.
pub const BEYOND_M: f64 = 500.0;
/// Levels of the transmitter that are thought possible about the nominal one, dB.
const LEVELS_DB: f64 = 100.0;
/// How many levels stand for all.
const LEVELS: u32 = 41;
/// How well a path loss is calibrated, dB.
const CALIBRATION_DB: f64 = 3.0;
/// Path losses that are off by no more than so many of these are thought possible.
const LIKELY: f64 = 2.0;

/// The thesis' channel to users within an area.
type ChannelWithin<'a> = Within<'a, f64, Channel<f64>, MOST_CORNERS>;
/// A user in the plane, and by how many dB all path losses are off.
type UserLocator<'a> = Locator<f64, POINTS, MOST, 3, ChannelWithin<'a>>;

/// As many measurements as can be remembered, evenly chosen; over open ground, where they are thinned by place, all.
pub fn thinned(stops: &[Stop], environment: Option<EnvironmentKind>) -> Vec<Stop> {
    let count = stops.len();
    if environment.is_some() && count > MOST {
        (0..MOST).map(|k| stops[k * count / MOST]).collect()
    } else {
        stops.to_vec()
    }
}

/// What is known of the level received at one metre over open ground, at a wavelength (m); none if nothing is.
pub fn level_prior(quantity: Quantity, wavelength_m: f64) -> Option<LevelPrior<f64>> {
    match quantity {
        Quantity::Level => None,
        // What is lost on the first metre.
        Quantity::PathLoss => Some(LevelPrior {
            mean: -20.0 * (4.0 * std::f64::consts::PI / wavelength_m).log10(),
            sigma: CALIBRATION_DB,
        }),
    }
}

/// Where a user is looked for.
#[derive(Debug)]
pub struct Search<'a> {
    pub(super) stops: &'a [Stop],
    /// Coordinates are counted from here, so that they stay small.
    pub(super) origin: [f64; 2],
    pub(super) area: Box<Area>,
    /// Where the user really was at each measurement; empty if nobody knows.
    pub(super) truth: &'a [[f64; 2]],
    /// How many estimates are wanted at the most, the last among them, where each takes long.
    pub(super) most: usize,
    /// Whether all that is believed is wanted.
    pub(super) with_clouds: bool,
    /// Of what the transmitter sends, m.
    pub(super) wavelength_m: f64,
    /// Measurements of so many seconds count, if not all do.
    pub(super) window_s: Option<f64>,
    /// Whether fewer points will do.
    pub(super) is_rough: bool,
}

impl<'a> Search<'a> {
    /// In an area, or about the measurements if none is given.
    ///
    /// # Errors
    /// [`Error::Area`] if the measurements have no surroundings.
    pub fn new(
        stops: &'a [Stop],
        area: Option<&Area>,
        truth: &'a [[f64; 2]],
        most: usize,
        with_clouds: bool,
    ) -> Result<Self, Error> {
        let (origin, area) = match area {
            Some(area) => {
                let origin = *area.region().low();
                (origin, area.relative_to(origin)?)
            }
            None => surroundings(stops)?,
        };
        let area = Box::new(area);
        let wavelength_m = WAVELENGTH_M;
        let (window_s, is_rough) = (None, false);
        Ok(Self { stops, origin, area, truth, most, with_clouds, wavelength_m, window_s, is_rough })
    }

    /// The same at another wavelength than that of 2 GHz, m.
    pub fn at_wavelength(self, wavelength_m: f64) -> Self {
        Self { wavelength_m, ..self }
    }

    /// The same from the measurements of the last `window_s` seconds alone, for a user who moves.
    pub fn within(self, window_s: Option<f64>) -> Self {
        Self { window_s, ..self }
    }

    /// Where the user is after each measurement that some place explains: through the channel of an environment, or
    /// over open ground if there is none. If only those of some seconds count, after as many as are wanted at the most.
    pub fn find(&self, environment: Option<EnvironmentKind>, quantity: Quantity) -> Vec<Estimate> {
        match environment {
            _ if self.window_s.is_some() => self.while_moving(environment, quantity),
            None => self.over_open_ground(quantity),
            Some(environment) => self.among_buildings(environment, quantity),
        }
    }

    /// Whether an estimate is wanted after the measurement of this number: after one in several, counted from the end, so that
    /// the last is one of them.
    pub(super) fn is_asked(&self, number: usize) -> bool {
        let count = self.stops.len();
        (count - 1 - number).is_multiple_of(count.div_ceil(self.most.max(1)))
    }

    pub(super) fn inward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x - self.origin[0], y - self.origin[1]]
    }

    pub(super) fn outward(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [x + self.origin[0], y + self.origin[1]]
    }

    pub(super) fn measurement(&self, stop: &Stop) -> Option<Measurement<f64>> {
        Measurement::new(self.inward(stop.place), stop.height, stop.loss).ok()
    }

    /// Through the thesis' channel.
    fn among_buildings(&self, environment: EnvironmentKind, quantity: Quantity) -> Vec<Estimate> {
        let Ok(channel) = environment.channel_at(self.wavelength_m) else { return Vec::new() };
        let channel = Within::new(channel, &*self.area);
        let region = self.area.region();
        let within = match quantity {
            Quantity::PathLoss => LIKELY * CALIBRATION_DB,
            Quantity::Level => LEVELS_DB,
        };
        let [width, height] = *region.high();
        let corners = ([0.0, 0.0, -within], [width, height, within]);
        let Ok(region) = Region::new(corners.0, corners.1) else { return Vec::new() };
        self.follow(quantity, Locator::new(channel, &region))
    }

    /// Whether the 90 % region of places holds the true one. The level, the third coordinate, is integrated over: nobody
    /// knows the true one.
    fn covered(&self, locator: &UserLocator<'_>, truth: [f64; 2]) -> Option<bool> {
        let truth = self.inward(truth);
        let moments = locator.moments();
        let (level, deviation) = (moments.mean()[2], moments.deviation()[2]);
        let levels = (0..LEVELS)
            .map(|k| level + deviation * (8.0 * f64::from(k) / f64::from(LEVELS - 1) - 4.0));
        let density = |[x, y]: [f64; 2]| {
            log_sum(levels.clone().map(|level| locator.log_posterior(&[x, y, level])))
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

    fn follow(&self, quantity: Quantity, locator: UserLocator<'_>) -> Vec<Estimate> {
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
            let truth = self.truth.get(number).filter(|_| last);
            let covered = truth.and_then(|truth| self.covered(&locator, *truth));
            estimates.push(Estimate {
                stop: number,
                place: self.outward([mean[0], mean[1]]),
                sd_m: deviation[0].hypot(deviation[1]),
                // A level received is the negative loss: the more the transmitter sends, the less.
                level_db: (quantity == Quantity::Level).then_some(-mean[2]),
                off_db: mean[2],
                covered,
                next: None,
                cloud: self
                    .with_clouds
                    .then(|| Cloud::of_lattice(locator.posterior()).moved(self.origin)),
            });
        }
        estimates
    }
}

/// Adds up exponentials of logarithms, as a logarithm.
fn log_sum(logs: impl Iterator<Item = f64>) -> f64 {
    let logs: Vec<f64> = logs.collect();
    let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    largest + logs.iter().map(|log| (log - largest).exp()).sum::<f64>().ln()
}

/// The box around a flight, and some more: its lower corner, and the area as seen from there.
fn surroundings(stops: &[Stop]) -> Result<([f64; 2], Area), Error> {
    let bound = |axis: usize, sign: f64| {
        let outermost = stops.iter().map(|stop| sign * stop.place[axis]).fold(f64::MIN, f64::max);
        sign * (outermost + BEYOND_M)
    };
    let origin = [bound(0, -1.0), bound(1, -1.0)];
    let size = [bound(0, 1.0) - origin[0], bound(1, 1.0) - origin[1]];
    let region = Region::new([0.0; 2], size).map_err(|_| Error::Surroundings)?;
    Ok((origin, Area::rectangle(&region)?))
}
