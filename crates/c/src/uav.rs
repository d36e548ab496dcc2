//! An aircraft's longitudinal motion, by the flight filter of `kestirim-uav-estimator`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_scalar::Components;
use kestirim_uav_estimator::{Dynamics, FlightFilter, Noise, Sample};
use kestirim_uav_longitudinal::{StateSpace, aerosonde, rate_airspeed_and_pitch};
use nalgebra::{ArrayStorage, SMatrix, SVector};

use crate::memory::{self, Handle, argument, held, held_mut, place, status};
use crate::{Health, Status};

#[cfg(not(feature = "fixed"))]
type Number = f32;
#[cfg(feature = "fixed")]
type Number = kestirim_scalar::Q16_16;

/// Number of measured outputs of a flight filter.
pub const UAV_OUTPUTS: usize = 3;

/// A flight filter: a Kalman filter of an aircraft's longitudinal motion, for samples at any times, with gaps and
/// missing outputs.
///
/// States: angle of attack (rad), pitch rate (rad/s), airspeed (m/s), pitch angle (rad). Inputs: elevator (rad),
/// throttle (0 to 1). All are deviations from the steady flight at which the model was linearised: subtract its values
/// from measurements and inputs, and add them to the estimate. The motion is in a vertical plane, in the body's axes.
#[derive(Debug)]
pub struct Uav {
    _private: [u8; 0],
}

type Filter = FlightFilter<Number, UAV_OUTPUTS>;

impl Handle for Uav {
    type Value = Filter;
    const TAG: u32 = 0x6B50_5501;
}

/// Upper bound of the size of a flight filter on any target, bytes: for static memory.
pub const UAV_SIZE: usize = 2048;
const _: () = assert!(memory::size::<Uav>() <= UAV_SIZE);
/// Upper bound of the size of a flight filter's snapshot on any target, bytes.
pub const UAV_SNAPSHOT: usize = UAV_SIZE / 4 * 5 + 64;

/// Linear model of an aircraft near its steady flight and of its sensors: x' = A x + B u, y = C x. Matrices are
/// row-major.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UavModel {
    /// State matrix A: 4 rows of 4.
    pub a: [[f64; 4]; 4],
    /// Input matrix B: 4 rows of 2.
    pub b: [[f64; 2]; 4],
    /// Output matrix C: one row of 4 per output, in the unit of that output.
    pub c: [[f64; 4]; UAV_OUTPUTS],
    /// Standard deviations, per sample, of the noise on the inputs elevator (rad) and throttle.
    pub input_sigma: [f64; 2],
    /// Standard deviation of each measured output, in its unit.
    pub output_sigma: [f64; UAV_OUTPUTS],
    /// Usual interval between two samples, s.
    pub usual_interval: f64,
}

/// Inputs and outputs at one time, as deviations from the model's steady flight.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UavSample {
    /// Time of the sample, µs since any epoch.
    pub time_us: i64,
    /// Inputs elevator (rad) and throttle (0 to 1), applied from this time until the next sample.
    pub input: [f64; 2],
    /// Measured outputs, in the order and the units of C's rows.
    pub measured: [f64; UAV_OUTPUTS],
    /// Which outputs were measured, one bit each: bit 0 for C's first row; 7 for all three.
    pub present: u32,
}

impl Uav {
    fn filter(model: &UavModel) -> Result<Filter, Status> {
        let UavModel { a, b, c, input_sigma, output_sigma, usual_interval } = *model;
        if !(usual_interval > 0.0 && usual_interval.is_finite()) {
            return Err(Status::InvalidArgument);
        }
        // Rows of C are columns of nalgebra.
        let a = SMatrix::<f64, 4, 4>::from_data(ArrayStorage(a));
        let b = SMatrix::<f64, 2, 4>::from_data(ArrayStorage(b)).transpose();
        let c = SMatrix::<f64, 4, UAV_OUTPUTS>::from_data(ArrayStorage(c)).transpose();
        let dynamics = Dynamics::Continuous(StateSpace { a: a.transpose(), b });
        let noise =
            Noise { inputs: SVector::from(input_sigma), outputs: SVector::from(output_sigma) };
        Ok(Filter::new(&dynamics, &c, &noise, usual_interval)?)
    }
}

/// Size of a flight filter on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_uav_size() -> usize {
    memory::size::<Uav>()
}

/// Alignment of the flight filter's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_uav_align() -> usize {
    memory::align::<Uav>()
}

/// Writes an example model: the Aerosonde, a small unmanned aircraft, with a pitch gyroscope, a Pitot tube and an
/// attitude reference at 100 Hz. Its outputs are pitch rate (rad/s), airspeed (m/s) and pitch angle (rad).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_aerosonde(model: *mut UavModel) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let answer = unsafe { place(model)? };
        let plant = aerosonde()?;
        let (a, b) = (plant.a.transpose(), plant.b.transpose());
        answer.write(UavModel {
            a: a.data.0,
            b: b.data.0,
            c: rate_airspeed_and_pitch().transpose().data.0,
            input_sigma: [0.009, 0.02],
            output_sigma: [0.009, 0.5, 0.009],
            usual_interval: 0.01,
        });
        Ok(())
    })
}

/// Creates a flight filter of a model, with an unknown state, in memory of at least `kestirim_uav_size()` bytes.
///
/// Errors: `NOT_FINITE`; `INVALID_ARGUMENT` if the usual interval is not positive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_init(
    memory: *mut c_void,
    size: usize,
    model: *const UavModel,
    filter: *mut *mut Uav,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::init(memory, size, filter, || Uav::filter(&argument(model)?)) }
}

/// Processes a sample of a flight. If it is more than a second older than the preceding one, the clock was set back,
/// and the filter restarts.
///
/// Errors: `OUT_OF_ORDER`; `GAP` of more than a million usual intervals; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_update(filter: *mut Uav, sample: *const UavSample) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, sample) = unsafe { (held_mut(filter)?, argument(sample)?) };
        let mut measured = [None; UAV_OUTPUTS];
        let mut bit = 1;
        for (measured, value) in measured.iter_mut().zip(sample.measured) {
            *measured = (sample.present & bit != 0).then_some(value);
            bit <<= 1;
        }
        let input = SVector::from(sample.input);
        filter.take(&Sample { time_us: sample.time_us, input, measured })?;
        Ok(())
    })
}

/// Estimate of the aircraft's state at the time of the last sample: angle of attack (rad), pitch rate (rad/s), airspeed
/// (m/s), pitch angle (rad), as deviations from the model's steady flight.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_estimate(
    filter: *const Uav,
    estimate: *mut [f64; 4],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(estimate)?) };
        answer.write(*filter.filter().estimate().as_array());
        Ok(())
    })
}

/// Standard deviations of the aircraft's estimated state: angle of attack (rad), pitch rate (rad/s), airspeed (m/s),
/// pitch angle (rad).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_sigma(filter: *const Uav, sigma: *mut [f64; 4]) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(sigma)?) };
        answer.write(*filter.filter().sigma().as_array());
        Ok(())
    })
}

/// Whether the estimate of the flight can be relied upon. Reasons why not: `INNOVATIONS` if measurements and model have
/// contradicted each other over about 200 samples; `REJECTED` if over about 50 samples more than a tenth of the
/// measurements were rejected; `TIME` if over about 1000 samples outputs or inputs seem to be late.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_health(filter: *const Uav, health: *mut Health) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (filter, answer) = unsafe { (held(filter)?, place(health)?) };
        answer.write(filter.health().into());
        Ok(())
    })
}

/// Stores the flight filter in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_UAV_SNAPSHOT`
/// bytes are enough; `length` receives the number of bytes used.
///
/// Errors: `TOO_SMALL` for the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_snapshot(
    filter: *const Uav,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::snapshot(filter, buffer, capacity, length) }
}

/// Restores a flight filter from a snapshot that `kestirim_uav_snapshot` stored, in memory of at least
/// `kestirim_uav_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
/// the snapshot, such as a whole page of flash.
///
/// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_uav_restore(
    memory: *mut c_void,
    size: usize,
    snapshot: *const u8,
    length: usize,
    filter: *mut *mut Uav,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::restore(memory, size, snapshot, length, filter) }
}
