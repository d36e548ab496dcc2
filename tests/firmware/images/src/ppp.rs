//! Ten satellites above a station on a coast, every half minute: what the filter of precise point positioning sees,
//! made by its own model of observations, with noise and two outliers. The host's tests read this very file.

use kestirim_gnss_ppp::constants::{EARTH_GRAVITY, EARTH_ROTATION, SPEED_OF_LIGHT};
use kestirim_gnss_ppp::{Carriers, FREQUENCY, Geodetic, GpsTime, SatelliteState, Site, WAVELENGTH};
use kestirim_ppp_filter::{Lean, PppFilter, SatelliteObservation, states};
use nalgebra::Vector3;

/// The receiver and its antennas: those of the application, which a user edits.
#[path = "../../../apps/gnss/src/site.rs"]
pub mod site;

pub use site::receiver;
use site::satellite_antenna;

/// Room for twelve satellites.
pub type Filter = PppFilter<{ states(12) }, Lean>;
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
    pub observations: [SatelliteObservation<'static>; SATELLITES],
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

    /// The epoch of this number, of which none before must be left out: winds go round.
    pub fn epoch(&mut self, index: usize) -> Option<Epoch> {
        let elapsed = index as f64 * INTERVAL;
        let time = START.plus(elapsed);
        let site = Site::new(&receiver(), &self.station, time);
        let state = sending(0, &self.station, elapsed);
        let antenna = satellite_antenna();
        let none = SatelliteObservation {
            satellite: 0,
            carriers: Carriers::L1L2,
            code: [0.0; 2],
            phase: [0.0; 2],
            lock_lost: false,
            state,
            antenna,
        };
        let mut observations = [none; SATELLITES];
        for (satellite, (observation, wind_up)) in
            observations.iter_mut().zip(&mut self.wind_up).enumerate()
        {
            let state = sending(satellite, &self.station, elapsed);
            let expected = site.expect(&state, Carriers::L1L2, antenna.as_ref(), *wind_up)?;
            *wind_up = Some(expected.wind_up_cycles);
            let range = expected.range
                + CLOCK[0]
                + CLOCK[1] * index as f64
                + WET_DELAY * expected.wet_mapping;
            let slant = IONOSPHERE / expected.local.z;
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
            *observation =
                SatelliteObservation { satellite: satellite as u8 + 1, code, phase, state, ..none };
        }
        Some(Epoch { time, observations })
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
        anomaly = mean_anomaly + eccentricity * libm::sincos(anomaly).0;
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
        accuracy: 0.0,
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
