//! A sky of thirty-two satellites on circular orbits, and a receiver that observes them without noise.

use kestirim_gnss_ppp::{
    Carriers, GpsTime, Receiver, SatelliteState, Site, WAVELENGTH, carried_along,
};
use kestirim_ppp_filter::SatelliteObservation;
use nalgebra::Vector3;

pub(crate) const START: GpsTime = GpsTime::new_in_day(59_025, 30_000.0);
/// The position of the marker, ECEF, m.
pub(crate) const MARKER: [f64; 3] = [3_582_104.8, 532_590.2, 5_232_755.1];
const RADIUS: f64 = 26_560e3;
const MEAN_MOTION: f64 = 1.4585e-4;
const WET_DELAY: f64 = 0.15;

pub(crate) fn marker() -> Vector3<f64> {
    Vector3::from(MARKER)
}

/// The state of a satellite `seconds` after the start, ECEF.
fn state(prn: u8, seconds: f64) -> SatelliteState {
    let (node, phase) = (f64::from(prn % 6) * 1.047, f64::from(prn) * 2.4);
    let (sine, cosine) = (phase + MEAN_MOTION * seconds).sin_cos();
    let (sine_node, cosine_node) = node.sin_cos();
    let turned = |x: f64, y: f64| {
        let (level, up) = (y * 0.5736, y * 0.8192);
        Vector3::new(cosine_node * x - sine_node * level, sine_node * x + cosine_node * level, up)
    };
    let position = turned(RADIUS * cosine, RADIUS * sine);
    let velocity = turned(-RADIUS * MEAN_MOTION * sine, RADIUS * MEAN_MOTION * cosine);
    SatelliteState {
        position: carried_along(&position, seconds),
        velocity: carried_along(&velocity, seconds),
        clock: 1e-5 * f64::from(prn),
        clock_interval: 0.0,
        clock_distance: 0.0,
        accuracy: 0.0,
    }
}

/// The observations of a receiver at `place`, `seconds` after the start, above five degrees.
pub(crate) fn observe(seconds: f64, place: &Vector3<f64>) -> Vec<SatelliteObservation<'static>> {
    let site = Site::new(&Receiver::default(), place, START.plus(seconds));
    let carriers = Carriers::L1L2;
    let sight = |prn: u8| {
        let state = state(prn, seconds);
        let expected = site.expect(&state, carriers, None, None)?;
        if expected.direction.elevation < 0.09 {
            return None;
        }
        let code = expected.range + 150.0 + WET_DELAY * expected.wet_mapping;
        let phase = code + expected.wind_up + 3.0 * f64::from(prn);
        Some(SatelliteObservation {
            satellite: prn,
            carriers,
            code: [code; 2],
            phase: WAVELENGTH.map(|wavelength| phase / wavelength),
            lock_lost: false,
            state,
            antenna: None,
        })
    };
    (1..=32).filter_map(sight).collect()
}

/// Adds errors to a satellite's codes and phases, m.
pub(crate) fn spoil(
    observations: &mut [SatelliteObservation<'_>],
    satellite: u8,
    code: f64,
    phase: f64,
) {
    for observation in
        observations.iter_mut().filter(|observation| observation.satellite == satellite)
    {
        for carrier in 0..2 {
            observation.code[carrier] += code;
            observation.phase[carrier] += phase / WAVELENGTH[carrier];
        }
    }
}
