//! The state of a satellite at the transmission of a signal, from precise orbits and clocks.
#![allow(unsafe_code)] // A function that C calls: a symbol of its own, and pointers, which `memory` checks.

use heapless::Vec;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Clock, ClockSample, GpsTime, Orbit, OrbitSample};
use kestirim_scalar::Components;
use nalgebra::Vector3;

use crate::memory::{argument, array, place, status};
use crate::{GnssSatellite, GnssTime, Status};

/// Largest number of samples of an orbit or a clock: four hours of an orbit with a sample every quarter of an hour.
pub const MOST_PRODUCTS: usize = 16;
/// The longest gap between samples of a clock that is interpolated over, s.
const LONGEST_GAP: f64 = 900.0;

/// One sample of a satellite's precise orbit (SP3).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssOrbitSample {
    /// Time of the sample.
    pub time: GnssTime,
    /// Position of the satellite's centre of mass, ECEF at the time of the sample, m.
    pub position: [f64; 3],
}

/// One sample of a satellite's precise clock (CLK, SP3).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GnssClockSample {
    /// Time of the sample.
    pub time: GnssTime,
    /// Satellite clock minus GPS time, s.
    pub bias: f64,
}

fn orbit_of(
    samples: &[GnssOrbitSample],
    reference: GpsTime,
) -> Result<Vec<OrbitSample, MOST_PRODUCTS>, Status> {
    let mut all = Vec::new();
    for sample in samples {
        let position = Vector3::from(sample.position);
        let sample = OrbitSample::from_ecef(reference, sample.time.instant(), &position);
        all.push(sample).map_err(|_| Status::TooMany)?;
    }
    Ok(all)
}

fn clock_of(
    samples: &[GnssClockSample],
    reference: GpsTime,
) -> Result<Vec<ClockSample, MOST_PRODUCTS>, Status> {
    let mut all = Vec::new();
    for sample in samples {
        let second = sample.time.instant().since(reference);
        all.push(ClockSample { second, bias: sample.bias }).map_err(|_| Status::TooMany)?;
    }
    Ok(all)
}

/// State of a satellite at the transmission of a signal, from its precise orbit and clock. `time` is the time of
/// reception by the receiver's clock, `code` the code observation (m). The orbit is interpolated by the polynomial
/// through eleven samples, the clock linearly between two. Samples are in the order of time, those of the orbit evenly
/// spaced, at most `KESTIRIM_MOST_PRODUCTS` of each.
///
/// Errors: `GAP` if the samples do not cover the time of transmission; `TOO_MANY`; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_gnss_satellite_at(
    time: *const GnssTime,
    code: f64,
    orbit: *const GnssOrbitSample,
    orbit_count: usize,
    clock: *const GnssClockSample,
    clock_count: usize,
    satellite: *mut GnssSatellite,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (time, orbit, clock, answer) = unsafe {
            (
                argument(time)?,
                array(orbit, orbit_count)?,
                array(clock, clock_count)?,
                place(satellite)?,
            )
        };
        if !code.is_finite() {
            return Err(Status::NotFinite);
        }
        let received = time.instant();
        let reference = GpsTime::new(received.day(), 0.0);
        let (orbit, clock) = (orbit_of(orbit, reference)?, clock_of(clock, reference)?);
        // By the satellite's own clock, which is off by less than a millisecond; the clock does not change noticeably
        // within that.
        let sent = received.plus(-code / SPEED_OF_LIGHT);
        let clock = Clock { reference, samples: &clock, longest_gap: LONGEST_GAP };
        let clock = clock.at(sent).ok_or(Status::Gap)?;
        let orbit = Orbit { reference, samples: &orbit };
        let orbit = orbit.at(sent.plus(-clock.bias)).ok_or(Status::Gap)?;
        answer.write(GnssSatellite {
            position: *orbit.position.as_array(),
            velocity: *orbit.velocity.as_array(),
            clock: clock.bias,
            clock_interval: clock.interval,
            clock_distance: clock.distance,
            accuracy: 0.0,
        });
        Ok(())
    })
}
