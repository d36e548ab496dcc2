//! The search for a user: over open ground, or through the thesis' channel.

use kestirim_air_to_ground::{LevelPrior, Measurement};
use kestirim_particle_filter::Region;

use super::{Area, EnvironmentKind, Error, Estimate, Quantity, Stop, WAVELENGTH_M};

/// The number of points of a lattice.
pub const POINTS: usize = 2000;
/// The largest number of measurements of a flight among buildings; of more, this many are taken evenly.
pub const MOST: usize = 400;
/// The margin around the flight in which the user may be if no area is given, m.
pub const BEYOND_M: f64 = 500.0;
/// The standard deviation of a path loss's calibration, dB.
pub(super) const CALIBRATION_DB: f64 = 3.0;

/// The measurements to be used: as many as can be handled, evenly chosen; over open ground, where they are thinned by
/// place, all.
pub fn thinned(stops: &[Stop], environment: Option<EnvironmentKind>) -> Vec<Stop> {
    let count = stops.len();
    if environment.is_some() && count > MOST {
        (0..MOST).map(|k| stops[k * count / MOST]).collect()
    } else {
        stops.to_vec()
    }
}

/// The prior of the level received at one metre over open ground, for a wavelength (m); `None` if nothing is known.
pub fn level_prior(quantity: Quantity, wavelength_m: f64) -> Option<LevelPrior<f64>> {
    match quantity {
        Quantity::Level => None,
        // The loss over the first metre.
        Quantity::PathLoss => Some(LevelPrior {
            mean: -20.0 * (4.0 * std::f64::consts::PI / wavelength_m).log10(),
            sigma: CALIBRATION_DB,
        }),
    }
}

/// The search for a user.
#[derive(Debug)]
pub struct Search<'a> {
    pub(super) stops: &'a [Stop],
    /// The origin of coordinates, chosen so that they stay small.
    pub(super) origin: [f64; 2],
    pub(super) area: Box<Area>,
    /// The true place of the user at each measurement; empty if unknown.
    pub(super) truth: &'a [[f64; 2]],
    /// The largest number of estimates, including the last one, where each takes long.
    pub(super) most: usize,
    /// Whether clouds are requested.
    pub(super) with_clouds: bool,
    /// The wavelength of the transmitter, m.
    pub(super) wavelength_m: f64,
    /// The time for which measurements count, s; `None` for all.
    pub(super) window_s: Option<f64>,
    /// Whether fewer points are enough.
    pub(super) is_rough: bool,
}

impl<'a> Search<'a> {
    /// A search in an area, or around the measurements if none is given.
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

    /// Sets the wavelength, m; by default that of 2 GHz.
    pub fn at_wavelength(self, wavelength_m: f64) -> Self {
        Self { wavelength_m, ..self }
    }

    /// Restricts the measurements to those of the last `window_s` seconds, for a user who moves.
    pub fn within(self, window_s: Option<f64>) -> Self {
        Self { window_s, ..self }
    }

    /// Estimates after each measurement that some place explains: through the channel of an environment, or over open
    /// ground if there is none. If only the measurements of some seconds count, the number of estimates is limited to
    /// the largest number requested.
    pub fn find(&self, environment: Option<EnvironmentKind>, quantity: Quantity) -> Vec<Estimate> {
        match environment {
            _ if self.window_s.is_some() => self.while_moving(environment, quantity),
            None => self.over_open_ground(quantity),
            Some(environment) => self.among_buildings(environment, quantity),
        }
    }

    /// Whether an estimate is requested after the measurement of this number: after one in several, counted from the
    /// end, so that the last is one of them.
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

/// The box around a flight with a margin: its lower corner, and the area relative to that.
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
