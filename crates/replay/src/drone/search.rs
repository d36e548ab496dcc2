//! Where a user is looked for: over open ground, or through the thesis' channel.

use kestirim_air_to_ground::{LevelPrior, Measurement};
use kestirim_particle_filter::Region;

use super::{Area, EnvironmentKind, Error, Estimate, Quantity, Stop, WAVELENGTH_M};

/// Points of a lattice.
pub const POINTS: usize = 2000;
/// Most measurements of a flight among buildings; of more as many are taken, evenly.
pub const MOST: usize = 400;
/// How far beyond the flight the user may be if no area is given, m.
pub const BEYOND_M: f64 = 500.0;
/// How well a path loss is calibrated, dB.
pub(super) const CALIBRATION_DB: f64 = 3.0;

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
