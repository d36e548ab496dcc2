use core::f64::consts::TAU;

use crate::trigonometry::{cos, sin};
use crate::{Geodetic, GpsTime};
use kestirim_scalar::Components;
use nalgebra::Vector3;

/// Coefficients a, b, c of a mapping function.
type Coefficients = [f64; 3];

/// The annual mean of the hydrostatic coefficients at latitudes of 15°, 30°, 45°, 60° and 75° (Niell 1996, table 3).
const HYDROSTATIC_MEAN: [Coefficients; 5] = [
    [1.276_993_4e-3, 2.915_369_5e-3, 62.610_505e-3],
    [1.268_323_0e-3, 2.915_229_9e-3, 62.837_393e-3],
    [1.246_539_7e-3, 2.928_844_5e-3, 63.721_774e-3],
    [1.219_604_9e-3, 2.902_256_5e-3, 63.824_265e-3],
    [1.204_599_6e-3, 2.902_491_2e-3, 64.258_455e-3],
];
/// The seasonal amplitude of the hydrostatic coefficients at the same latitudes (Niell 1996, table 3).
const HYDROSTATIC_AMPLITUDE: [Coefficients; 5] = [
    [0.0, 0.0, 0.0],
    [1.270_962_6e-5, 2.141_497_9e-5, 9.012_840_0e-5],
    [2.652_366_2e-5, 3.016_077_9e-5, 4.349_703_7e-5],
    [3.400_045_2e-5, 7.256_272_2e-5, 84.795_348e-5],
    [4.120_219_1e-5, 11.723_375e-5, 170.372_06e-5],
];
/// The wet coefficients at the same latitudes (Niell 1996, table 4).
const WET: [Coefficients; 5] = [
    [5.802_189_7e-4, 1.427_526_8e-3, 4.347_296_1e-2],
    [5.679_484_7e-4, 1.513_862_5e-3, 4.672_951_0e-2],
    [5.811_801_9e-4, 1.457_275_2e-3, 4.390_893_1e-2],
    [5.972_754_2e-4, 1.500_742_8e-3, 4.462_698_2e-2],
    [6.164_169_3e-4, 1.759_908_2e-3, 5.473_603_8e-2],
];
/// The coefficients of the correction for the station's height.
const HEIGHT: Coefficients = [2.53e-5, 5.49e-3, 1.14e-3];

/// Factors from zenith delays to those at the elevation of a satellite.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mapping {
    /// The mapping of the dry air, in hydrostatic equilibrium.
    pub hydrostatic: f64,
    /// The mapping of the water vapour: the partial derivative of the range by the zenith wet delay.
    pub wet: f64,
}

/// The troposphere over a station at one epoch: Saastamoinen's zenith delay of a standard atmosphere, and Niell's
/// mapping functions (1996, *J. Geophys. Res.* 101 B2), valid from 3° of elevation up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Troposphere {
    hydrostatic: Coefficients,
    wet: Coefficients,
    /// The height of the station, km.
    height: f64,
    /// The zenith hydrostatic delay, m.
    zenith_hydrostatic: f64,
}

impl Troposphere {
    /// The troposphere over a place in a season; compute it once an epoch at most.
    pub fn over(place: &Geodetic, time: GpsTime) -> Self {
        // Counted from 28 January 2000, as the years of the tables have 365.25 days, and half a year off in the south.
        // This differs from the day of the calendar year by a day at most: some 10 µm at 5°.
        let season = (time.days_since_j2000(0.0) - 26.5) / 365.25
            + if place.latitude < 0.0 { 0.5 } else { 0.0 };
        let winter = cos(TAU * season);
        let latitude = libm::fabs(place.latitude);
        let mean = at_latitude(&HYDROSTATIC_MEAN, latitude);
        let amplitude = at_latitude(&HYDROSTATIC_AMPLITUDE, latitude);
        let [a, b, c] = mean;
        let [da, db, dc] = amplitude;
        Self {
            hydrostatic: [a - da * winter, b - db * winter, c - dc * winter],
            wet: at_latitude(&WET, latitude),
            height: place.height * 1e-3,
            zenith_hydrostatic: zenith_hydrostatic(place),
        }
    }

    /// The zenith delay of the dry air, m.
    pub const fn zenith_hydrostatic(&self) -> f64 {
        self.zenith_hydrostatic
    }

    /// The mapping to an elevation (rad). Below one degree it stays at its value for one degree.
    pub fn mapping(&self, elevation: f64) -> Mapping {
        self.mapping_of_sine(sin(elevation))
    }

    /// The mapping to an elevation given by its sine.
    pub(crate) fn mapping_of_sine(&self, sine: f64) -> Mapping {
        // The sine of one degree.
        const LOWEST: f64 = 0.017_452_406_437_283_51;
        let sine = if sine < LOWEST { LOWEST } else { sine };
        let height = (1.0 / sine - fraction(&HEIGHT, sine)) * self.height;
        Mapping {
            hydrostatic: fraction(&self.hydrostatic, sine) + height,
            wet: fraction(&self.wet, sine),
        }
    }

    /// The delay of the dry air towards an elevation (rad), m: add it to the modelled range.
    pub fn hydrostatic(&self, elevation: f64) -> f64 {
        self.zenith_hydrostatic * self.mapping(elevation).hydrostatic
    }
}

/// The zenith delay of the dry air, m, by Saastamoinen (1972, in the form of Davis et al. 1985), with the pressure of
/// the standard atmosphere at the height.
///
/// The height should be above sea level; the ellipsoidal height instead costs 0.3 mm per metre, which an estimated wet
/// delay absorbs almost completely.
pub fn zenith_hydrostatic(place: &Geodetic) -> f64 {
    let height = in_troposphere(place.height);
    let pressure = 1_013.25 * libm::pow(1.0 - 2.2557e-5 * height, 5.2568);
    let gravity = 1.0 - 0.00266 * cos(2.0 * place.latitude) - 0.28e-6 * height;
    0.002_276_8 * pressure / gravity
}

/// The zenith delay of the water vapour, m, by Saastamoinen with the standard atmosphere's temperature and a relative
/// humidity between 0 and 1: an initial value for a filter, some 0.05 m wrong.
pub fn zenith_wet(place: &Geodetic, humidity: f64) -> f64 {
    let temperature = 288.15 - 6.5e-3 * in_troposphere(place.height);
    let saturated = 6.108 * libm::exp((17.15 * temperature - 4_684.0) / (temperature - 38.45));
    0.002_277 * (1_255.0 / temperature + 0.05) * saturated * humidity
}

/// Limits a height to the range of the formulas, which ends below the stratosphere.
fn in_troposphere(height: f64) -> f64 {
    height.clamp(-1_000.0, 11_000.0)
}

/// The partial derivatives ∂P/∂G of a range by the troposphere's gradients to the north and to the east, along a unit
/// vector to the east, north and up.
///
/// By Chen and Herring (1997), with C = 0.0032, their value for the total delay. NaN for a zero vector.
pub fn gradient_mapping(local: &Vector3<f64>) -> [f64; 2] {
    let [east, north, up] = *local.as_array();
    let total = up * up + 0.0032 * libm::sqrt(east * east + north * north);
    [north / total, east / total]
}

/// Interpolates linearly between the latitudes of a table, constant beyond (rad, not negative).
fn at_latitude(table: &[Coefficients; 5], latitude: f64) -> Coefficients {
    let place = (latitude.to_degrees() / 15.0 - 1.0).clamp(0.0, 4.0);
    let below = libm::floor(place);
    let [low, high] = [below as usize, below as usize + 1]
        .map(|row| table.get(row.min(4)).copied().unwrap_or_default());
    let part = place - below;
    let mut coefficients = low;
    for (low, high) in coefficients.iter_mut().zip(high) {
        *low += (high - *low) * part;
    }
    coefficients
}

/// Marini's continued fraction, which is one at the zenith.
fn fraction(coefficients: &Coefficients, sine: f64) -> f64 {
    let [a, b, c] = *coefficients;
    (1.0 + a / (1.0 + b / (1.0 + c))) / (sine + a / (sine + b / (sine + c)))
}

#[cfg(test)]
mod tests {
    use super::{Troposphere, gradient_mapping, zenith_hydrostatic, zenith_wet};
    use crate::{Direction, Geodetic, GpsTime};

    fn place(latitude: f64, height: f64) -> Geodetic {
        Geodetic { latitude: latitude.to_radians(), longitude: 0.0, height }
    }

    /// Le Mans on 1 January 1994, published by Mercier and Perosanz (as Orekit's tests cite them).
    #[test]
    fn published_mapping() {
        let troposphere = Troposphere::over(&place(48.0, 68.0), GpsTime::new(49_353, 0.0));
        let mapping = troposphere.mapping(5_f64.to_radians());
        assert!((mapping.hydrostatic - 10.16).abs() < 0.005, "{mapping:?}");
        assert!((mapping.wet - 10.75).abs() < 0.005, "{mapping:?}");
    }

    /// Computed with numpy from the formulas and tables.
    #[test]
    fn north_and_south_in_summer_and_winter() {
        for (latitude, day, degrees, hydrostatic, wet) in [
            (-80.0, 0, 3.0, 14.733_197_846_885, 16.323_500_496_256),
            (-20.0, 200, 10.0, 5.552_746_161_746, 5.657_981_012_323),
            (3.0, 100, 30.0, 1.992_656_178_480, 1.996_549_324_858),
            (37.0, 330, 5.0, 10.152_812_475_248, 10.759_806_850_782),
        ] {
            let troposphere =
                Troposphere::over(&place(latitude, 1_234.0), GpsTime::new(58_849 + day, 43_200.0));
            let mapping = troposphere.mapping(f64::to_radians(degrees));
            assert!((mapping.hydrostatic - hydrostatic).abs() < 1e-9, "{mapping:?}");
            assert!((mapping.wet - wet).abs() < 1e-9, "{mapping:?}");
        }
    }

    #[test]
    fn the_zenith_maps_to_itself_and_the_horizon_is_finite() {
        let troposphere = Troposphere::over(&place(30.0, 4_000.0), GpsTime::new(59_025, 0.0));
        let up = troposphere.mapping(core::f64::consts::FRAC_PI_2);
        assert!((up.hydrostatic - 1.0).abs() < 1e-12 && (up.wet - 1.0).abs() < 1e-12);
        let low = troposphere.mapping(-1.0);
        assert_eq!(low, troposphere.mapping(0.0));
        assert!((20.0..60.0).contains(&low.hydrostatic), "{low:?}");
        assert!(troposphere.mapping(f64::NAN).wet.is_nan());
        let delay = troposphere.hydrostatic(0.5);
        assert_eq!(
            delay,
            zenith_hydrostatic(&place(30.0, 4_000.0)) * troposphere.mapping(0.5).hydrostatic
        );
    }

    /// 1/(sin 10° tan 10° + 0.0032) is 29.57; straight above a gradient adds nothing.
    #[test]
    fn gradients_add_to_low_satellites() {
        let mapped = |azimuth: f64, elevation: f64| {
            let [azimuth, elevation] = [azimuth, elevation].map(f64::to_radians);
            gradient_mapping(&Direction { elevation, azimuth }.local())
        };
        for (azimuth, [north, east]) in
            [(0.0, [1.0, 0.0]), (90.0, [0.0, 1.0]), (180.0, [-1.0, 0.0]), (270.0, [0.0, -1.0])]
        {
            let [to_north, to_east] = mapped(azimuth, 10.0);
            assert!((to_north - 29.569 * north).abs() < 1e-3, "{to_north}");
            assert!((to_east - 29.569 * east).abs() < 1e-3, "{to_east}");
        }
        assert!(mapped(30.0, 90.0).iter().all(|mapping| mapping.abs() < 1e-12));
        assert!(mapped(30.0, 0.0).iter().all(|mapping| mapping.is_finite()));
    }

    /// 1013.25 hPa at 45° and sea level: 2.3069 m. The rest computed with numpy.
    #[test]
    fn zenith_delays() {
        assert!((zenith_hydrostatic(&place(45.0, 0.0)) - 2.306_967_6).abs() < 1e-6);
        assert!((zenith_hydrostatic(&place(48.0, 1_234.0)) - 1.988_939_353).abs() < 1e-8);
        assert!((zenith_wet(&place(48.0, 1_234.0), 0.5) - 0.051_803_378).abs() < 1e-8);
        for height in [-1e9, 1e9] {
            let delay = zenith_hydrostatic(&place(48.0, height));
            assert!((0.4..2.7).contains(&delay), "{delay}");
        }
    }
}
