//! Ten satellites above a station on a coast, every half minute: what the filter of precise point positioning sees,
//! made by its own model of observations, with noise and two outliers. The host's tests read this very file.

use kestirim_gnss_ppp::constants::{EARTH_GRAVITY, EARTH_ROTATION, SPEED_OF_LIGHT};
use kestirim_gnss_ppp::{
    Corrections, FREQUENCY, Geodetic, GpsTime, OceanLoading, Pattern, Receiver, SatelliteState,
    Site, WAVELENGTH,
};
use kestirim_ppp_filter::{PppFilter, Sighting, states};
use nalgebra::Vector3;

/// Room for twelve satellites.
pub type Filter = PppFilter<{ states(12) }>;
/// How many satellites there are.
pub const SATELLITES: usize = 10;
/// How many epochs there are.
pub const EPOCHS: usize = 7;
/// In which epoch a code and a phase are wrong.
pub const OUTLIERS: usize = 4;

/// The satellite with the wrong code, and by how much, m.
const WRONG_CODE: (usize, f64) = (6, 15.0);
/// The satellite with the wrong phase, and by how much, m: on both carriers alike, as no slip is.
const WRONG_PHASE: (usize, f64) = (1, 0.5);

/// From an epoch to the next, s.
pub const INTERVAL: f64 = 30.0;
/// Midday of 25 June 2020, but for the first epoch.
pub const START: GpsTime = GpsTime::new_in_day(59_025, 43_200.0 - INTERVAL);
/// How far the receiver's clock is ahead in the first epoch, m, and what it gains an epoch.
pub const CLOCK: [f64; 2] = [812.5, 3.25];
/// Zenith delay of the water vapour, m.
const WET_DELAY: f64 = 0.14;
/// Delay of L1 in the ionosphere at the zenith, m.
const IONOSPHERE: f64 = 2.5;
/// The largest noise of a code and of a phase on one carrier, m.
const NOISE: [f64; 2] = [0.3, 0.002];

/// Semi-major axis of all orbits, m, eccentricity, and the cosine and sine of the inclination, 55°.
const ORBIT: (f64, f64, [f64; 2]) =
    (26_559_800.0, 0.01, [0.573_576_436_351_046, 0.819_152_044_288_991_8]);
/// Longitude of the ascending node and mean argument of latitude at the start, degrees.
const PLACES: [[f64; 2]; SATELLITES] = [
    [0.0, 0.0],
    [0.0, 72.0],
    [60.0, 13.0],
    [60.0, 85.0],
    [180.0, 111.0],
    [180.0, 183.0],
    [240.0, 52.0],
    [240.0, 124.0],
    [300.0, 65.0],
    [300.0, 137.0],
];

/// Phase centres of the satellites: nadir angles of 0°, 7° and 14°.
static SATELLITE_ANTENNA: [Pattern<'static>; 2] = {
    const L1: Pattern<'static> = Pattern {
        offset: [0.279, 0.0, 2.3195],
        first: 0.0,
        step: 7.0,
        mean: &[-0.0008, -0.0045, 0.0026],
        azimuth_step: 0.0,
        by_azimuth: &[],
    };
    [L1, Pattern { offset: [0.279, 0.0, 2.2895], ..L1 }]
};
/// Phase centres of the receiver: zenith angles of 0°, 30°, 60° and 90°, azimuths of 0°, 180° and 360°.
static RECEIVER_ANTENNA: [Pattern<'static>; 2] = {
    const L1: Pattern<'static> = Pattern {
        offset: [0.0012, -0.0004, 0.0892],
        first: 0.0,
        step: 30.0,
        mean: &[0.0, -0.0041, -0.0018, 0.0094],
        azimuth_step: 180.0,
        by_azimuth: &[
            0.0, -0.0040, -0.0016, 0.0090, 0.0, -0.0042, -0.0020, 0.0098, 0.0, -0.0040, -0.0016,
            0.0090,
        ],
    };
    [L1, Pattern { offset: [0.0, 0.0001, 0.1185], ..L1 }]
};
/// Tides of the ocean as near Denmark's west coast.
static OCEAN_LOADING: OceanLoading = OceanLoading {
    amplitude: [
        [0.0074, 0.0023, 0.0017, 0.0006, 0.0013, 0.0008, 0.0004, 0.0002, 0.0006, 0.0003, 0.0003],
        [0.0022, 0.0007, 0.0005, 0.0002, 0.0003, 0.0002, 0.0001, 0.0001, 0.0, 0.0, 0.0],
        [0.0012, 0.0003, 0.0003, 0.0001, 0.0002, 0.0001, 0.0001, 0.0, 0.0001, 0.0, 0.0],
    ],
    lag: [
        [-64.2, -40.1, -92.9, -43.5, -53.2, -104.7, -54.0, -153.2, 2.8, -9.5, 0.3],
        [89.1, 118.4, 66.6, 117.1, 113.0, 16.5, 110.9, -41.1, -171.9, 176.0, 179.1],
        [25.5, 78.8, -1.3, 79.9, 28.4, -29.6, 27.5, -65.4, 9.9, 178.2, 0.0],
    ],
};

/// What is known of the receiver.
pub const fn receiver() -> Receiver<'static> {
    Receiver {
        antenna: Some(RECEIVER_ANTENNA),
        eccentricity: [0.0, 0.0, 0.0083],
        ocean_loading: Some(&OCEAN_LOADING),
        ut1_minus_gps: -18.24,
        corrections: Corrections::ALL,
    }
}

/// Where the receiver is, ECEF, m.
pub fn station() -> Vector3<f64> {
    Geodetic { latitude: 0.968, longitude: 0.148, height: 57.0 }.to_ecef()
}

/// One epoch.
#[derive(Clone, Copy, Debug)]
pub struct Epoch {
    /// When, by the receiver's clock.
    pub time: GpsTime,
    /// What was observed.
    pub sightings: [Sighting<'static>; SATELLITES],
}

/// The epochs one after the other.
#[derive(Clone, Debug)]
pub struct Epochs {
    station: Vector3<f64>,
    next: usize,
    wind_up: [Option<f64>; SATELLITES],
    noise: Noise,
}

impl Epochs {
    /// From the first on, as a receiver at a place observes them.
    pub const fn at(station: Vector3<f64>) -> Self {
        Self { station, next: 0, wind_up: [None; SATELLITES], noise: Noise(1) }
    }

    fn epoch(&mut self, index: usize) -> Option<Epoch> {
        let elapsed = index as f64 * INTERVAL;
        let time = START.plus(elapsed);
        let site = Site::new(&receiver(), &self.station, time);
        let state = sending(0, &self.station, elapsed);
        let antenna = Some(SATELLITE_ANTENNA);
        let none = Sighting {
            satellite: 0,
            code: [0.0; 2],
            phase: [0.0; 2],
            lock_lost: false,
            state,
            antenna,
        };
        let mut sightings = [none; SATELLITES];
        for (satellite, (sighting, wind_up)) in
            sightings.iter_mut().zip(&mut self.wind_up).enumerate()
        {
            let state = sending(satellite, &self.station, elapsed);
            let expected = site.expect(&state, antenna.as_ref(), *wind_up)?;
            *wind_up = Some(expected.wind_up_cycles);
            let range = expected.range
                + CLOCK[0]
                + CLOCK[1] * index as f64
                + WET_DELAY * expected.wet_mapping;
            let slant = IONOSPHERE / libm::sin(expected.direction.elevation);
            let wrong = |(who, by): (usize, f64)| {
                if index == OUTLIERS && satellite == who { by } else { 0.0 }
            };
            let mut code = [0.0; 2];
            let mut phase = [0.0; 2];
            for (carrier, (code, phase)) in code.iter_mut().zip(&mut phase).enumerate() {
                let ratio = FREQUENCY[0] / FREQUENCY[carrier];
                let ionosphere = slant * ratio * ratio;
                *code = range + ionosphere + wrong(WRONG_CODE) + NOISE[0] * self.noise.next();
                let metres = range - ionosphere + wrong(WRONG_PHASE) + NOISE[1] * self.noise.next();
                let ambiguity = 1_000.0 * (satellite + carrier) as f64;
                *phase = metres / WAVELENGTH[carrier] + expected.wind_up_cycles + ambiguity;
            }
            *sighting = Sighting { satellite: satellite as u8 + 1, code, phase, state, ..none };
        }
        Some(Epoch { time, sightings })
    }
}

impl Iterator for Epochs {
    type Item = Epoch;

    fn next(&mut self) -> Option<Epoch> {
        let index = self.next;
        self.next += 1;
        if index < EPOCHS { self.epoch(index) } else { None }
    }
}

/// A satellite when it sends what is received `elapsed` seconds after the start.
fn sending(satellite: usize, station: &Vector3<f64>, elapsed: f64) -> SatelliteState {
    let mut flight = 0.075;
    let mut state = in_orbit(satellite, elapsed - flight);
    for _ in 0..2 {
        flight = (state.position - station).norm() / SPEED_OF_LIGHT;
        state = in_orbit(satellite, elapsed - flight);
    }
    SatelliteState { clock_interval: INTERVAL, clock_distance: flight, ..state }
}

/// A satellite on its ellipse, whose perigee is at the ascending node, `elapsed` seconds after the start.
pub fn in_orbit(satellite: usize, elapsed: f64) -> SatelliteState {
    let (axis, eccentricity, [tilt_cosine, tilt_sine]) = ORBIT;
    let [node, argument] = PLACES.get(satellite).copied().unwrap_or_default();
    let motion = libm::sqrt(EARTH_GRAVITY / axis) / axis;
    let mean_anomaly = argument.to_radians() + motion * elapsed;
    let mut anomaly = mean_anomaly;
    for _ in 0..8 {
        anomaly = mean_anomaly + eccentricity * libm::sin(anomaly);
    }
    let (sine, cosine) = libm::sincos(anomaly);
    let minor = libm::sqrt(1.0 - eccentricity * eccentricity);
    let speed = axis * motion / (1.0 - eccentricity * cosine);
    let (turn, straight) = libm::sincos(node.to_radians() - EARTH_ROTATION * elapsed);
    let earth_fixed = |x: f64, y: f64| {
        let (y, z) = (tilt_cosine * y, tilt_sine * y);
        Vector3::new(straight * x - turn * y, turn * x + straight * y, z)
    };
    SatelliteState {
        position: earth_fixed(axis * (cosine - eccentricity), axis * minor * sine),
        velocity: earth_fixed(-speed * sine, speed * minor * cosine),
        clock: 1e-5 * (satellite as f64 - 4.5),
        clock_interval: 0.0,
        clock_distance: 0.0,
    }
}

/// Numbers between −1 and 1 that look random (Knuth's MMIX generator).
#[derive(Clone, Copy, Debug)]
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.0 >> 32) as i32) / 2_147_483_648.0
    }
}
