//! Signal delays in the troposphere and the ionosphere.

use std::f64::consts::{PI, TAU};

use kestirim_gnss_ppp::{Direction, FREQUENCY, Geodetic, Troposphere};
use rand_core::Rng;

use super::noise::Wander;
use super::times::{INTERVAL_S, MIDNIGHT};
use crate::random::{normal, uniform};

/// The random walk of the zenith wet delay, m/√s: 4 mm in an hour.
const WET_WALK: f64 = 7e-5;
/// The deviation of the weather from the standard atmosphere, as a zenith delay, m: 10 hPa.
const WEATHER_M: f64 = 0.023;
/// The horizontal gradients, m, and their correlation time, s.
const GRADIENT_M: f64 = 0.4e-3;
const GRADIENT_MEMORY_S: f64 = 6.0 * 3600.0;
/// The delay of L1 caused by 10¹⁶ electrons/m², m.
const TECU_M: f64 = 40.3e16 / (FREQUENCY[0] * FREQUENCY[0]);
/// The height of the ionospheric shell, in Earth radii.
const SHELL: f64 = 0.0627;

/// The troposphere above a station.
#[derive(Debug, Clone, Copy)]
pub(super) struct Air {
    troposphere: Troposphere,
    /// The deviation of the zenith hydrostatic delay from the standard atmosphere, m.
    weather: f64,
    /// The zenith wet delay, m.
    wet: f64,
    gradients: [Wander; 2],
    /// The horizontal gradients towards north and east, m.
    gradient: [f64; 2],
}

impl Air {
    pub(super) fn draw(place: &Geodetic, rng: &mut impl Rng) -> Self {
        let humid = 0.05 + 0.25 * place.latitude.cos().powi(2);
        Self {
            troposphere: Troposphere::over(place, MIDNIGHT),
            weather: normal(rng, WEATHER_M),
            wet: humid * (0.6 + 0.8 * uniform(rng)),
            gradients: [(); 2].map(|()| Wander::draw(GRADIENT_MEMORY_S, rng)),
            gradient: [0.0; 2],
        }
    }

    /// Advances by one epoch.
    pub(super) fn advance(&mut self, rng: &mut impl Rng) {
        self.wet = (self.wet + normal(rng, WET_WALK * INTERVAL_S.sqrt())).max(0.0);
        for (gradient, wander) in self.gradient.iter_mut().zip(&mut self.gradients) {
            *gradient = GRADIENT_M * wander.next(rng);
        }
    }

    /// The slant delay of a signal from a direction, m.
    pub(super) fn delay(&self, direction: Direction) -> f64 {
        let mapping = self.troposphere.mapping(direction.elevation);
        let dry = mapping.hydrostatic * (self.troposphere.zenith_hydrostatic() + self.weather);
        let (sine, cosine) = direction.azimuth.sin_cos();
        let [north, east] = self.gradient;
        // The gradient model of Davis et al. 1993.
        let slope = mapping.wet / direction.elevation.tan();
        dry + mapping.wet * self.wet + slope * (north * cosine + east * sine)
    }
}

/// The electron content over a region: high at noon near the equator, low at night.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ionosphere {
    /// The electron content at night, 10¹⁶ electrons/m².
    night: f64,
    /// The additional electron content at noon at the equator, 10¹⁶ electrons/m².
    noon: f64,
}

impl Ionosphere {
    /// Draws an ionosphere of years with a calm Sun, such as 2008 and 2020 of the recordings and 2019 of the paper. In
    /// active years it jumps by more than slips do.
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        Self { night: 2.0 + 3.0 * uniform(rng), noon: 5.0 + 20.0 * uniform(rng) }
    }

    /// The delay of L1's code from a direction, m, including the disturbance `wave`.
    pub(super) fn delay(
        &self,
        place: &Geodetic,
        direction: Direction,
        second: f64,
        wave: &Wave,
    ) -> f64 {
        let Direction { elevation, azimuth } = direction;
        let grazing = elevation.cos() / (1.0 + SHELL);
        // The point at which the ray pierces the shell.
        let arc = PI / 2.0 - elevation - grazing.asin();
        let latitude = place.latitude + arc * azimuth.cos();
        let longitude = place.longitude + arc * azimuth.sin() / latitude.cos().max(0.2);
        let from_two = TAU * (second / 86_400.0 - 14.0 / 24.0) + longitude;
        let day = from_two.cos().max(0.0) * latitude.cos().powi(2);
        let vertical = self.night + self.noon * day + wave.at(second);
        TECU_M * vertical / (1.0 - grazing * grazing).sqrt()
    }
}

/// A travelling ionospheric disturbance, as it affects one satellite's ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wave {
    /// The amplitude, 10¹⁶ electrons/m².
    size: f64,
    period_s: f64,
    phase: f64,
}

impl Wave {
    /// Draws a disturbance of medium scale.
    pub(super) fn draw(rng: &mut impl Rng) -> Self {
        Self {
            size: normal(rng, 0.15),
            period_s: 900.0 + 1800.0 * uniform(rng),
            phase: TAU * uniform(rng),
        }
    }

    fn at(&self, second: f64) -> f64 {
        self.size * (TAU * second / self.period_s + self.phase).sin()
    }
}
