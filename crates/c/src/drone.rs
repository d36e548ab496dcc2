//! The drone's search for a transmitter, by the beacon search of `kestirim-user-locator`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use heapless::Vec;
use kestirim_air_to_ground::{FreeSpace, Measurement};
use kestirim_health::Reason;
use kestirim_scalar::Scalar;
use kestirim_user_locator::{Area, BeaconSearch};

use crate::memory::{self, Handle, argument, array, held, held_mut, place, status};
use crate::{Health, Status, floats};

#[cfg(not(feature = "fixed"))]
type Number = f32;
#[cfg(feature = "fixed")]
type Number = kestirim_scalar::Q16_16;

/// Largest number of corners of a search area.
pub const MOST_CORNERS: usize = 16;
/// The number of measurements that are kept: evenly spaced ones of a longer flight.
const KEPT: usize = 40;
/// The number of points of the lattice on which the posterior is computed.
const POINTS: usize = 500;
/// The fewest measurements that determine a position: each level is a circle about the transmitter, and fewer circles
/// do not meet in one point.
const FEWEST: usize = 3;

/// A transmitter search: locates a transmitter of unknown power over open ground, from the levels that a drone
/// receives.
///
/// Places are coordinates in a horizontal plane (such as east and north), m, with one origin for drone and transmitter.
#[derive(Debug)]
pub struct Drone {
    _private: [u8; 0],
}

type Search = BeaconSearch<Number, KEPT, MOST_CORNERS>;

impl Handle for Drone {
    type Value = Search;
    const TAG: u32 = 0x6B50_4201;
}

/// Upper bound of the size of a transmitter search on any target, bytes: for static memory.
pub const DRONE_SIZE: usize = 1024;
const _: () = assert!(memory::size::<Drone>() <= DRONE_SIZE);
/// Upper bound of the size of a transmitter search's snapshot on any target, bytes.
pub const DRONE_SNAPSHOT: usize = DRONE_SIZE / 4 * 5 + 64;

/// A level that the drone received from the transmitter, and where.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DroneMeasurement {
    /// Place of the drone, m: x, y.
    pub place: [f32; 2],
    /// Height of the drone above the transmitter, m.
    pub height: f32,
    /// Received level, dBm or dB relative to any reference that is the same for all measurements.
    pub level: f32,
}

/// Estimated place of the transmitter.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DronePlace {
    /// Place of the transmitter, m: x, y.
    pub place: [f32; 2],
    /// Standard deviation of the place, m: the root of the sum of both axes' variances.
    pub sigma: f32,
    /// Level received at one metre from the transmitter, in the measurements' unit.
    pub level: f32,
    /// Whether the place can be relied upon: `DROPOUT` with fewer than three measurements, `INNOVATIONS` if the levels show a step,
    /// as after a change of the receiver's gain. How well the measurements determine the place is shown by its standard deviation.
    pub health: Health,
}

/// Size of a transmitter search on this target, bytes. An estimate needs 16 kB of stack on a computer, 9 kB on a
/// microcontroller.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_drone_size() -> usize {
    memory::size::<Drone>()
}

/// Alignment of the transmitter search's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_drone_align() -> usize {
    memory::align::<Drone>()
}

/// Creates a transmitter search in memory of at least `kestirim_drone_size()` bytes, for an area with these corners (x,
/// y, m, in either sense of rotation), at most `KESTIRIM_MOST_CORNERS`.
///
/// Errors: `TOO_MANY`; `GEOMETRY` if the corners enclose no area; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_drone_init(
    memory: *mut c_void,
    size: usize,
    corners: *const [f32; 2],
    count: usize,
    search: *mut *mut Drone,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe {
        memory::init(memory, size, search, || {
            let mut all = Vec::<[Number; 2], MOST_CORNERS>::new();
            for corner in array(corners, count)? {
                all.push(corner.map(Number::from_f32)).map_err(|_| Status::TooMany)?;
            }
            Ok(Search::new(FreeSpace::new(None), Area::new(&all)?))
        })
    }
}

/// Adds a measurement of the transmitter's level.
///
/// Errors: `NOT_FINITE`; `INVALID_ARGUMENT` if the height is not positive; `IMPLAUSIBLE` beyond 300 dB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_drone_update(
    search: *mut Drone,
    measurement: *const DroneMeasurement,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (search, taken) = unsafe { (held_mut(search)?, argument(measurement)?) };
        let place = taken.place.map(Number::from_f32);
        let (height, level) = (Number::from_f32(taken.height), Number::from_f32(taken.level));
        search.measure(&Measurement::new(place, height, -level)?);
        Ok(())
    })
}

/// Estimates the place of the transmitter from all measurements that are kept. This takes much computing time: call it
/// only when a place is needed.
///
/// Errors: `NO_ESTIMATE` without a measurement; `CONTRADICTORY` if no place in the area explains the measurements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_drone_estimate(
    search: *const Drone,
    estimate: *mut DronePlace,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (search, answer) = unsafe { (held(search)?, place(estimate)?) };
        if search.measurements().is_empty() {
            return Err(Status::NoEstimate);
        }
        let found = search.estimate::<POINTS>()?;
        let few = search.measurements().len() < FEWEST;
        answer.write(DronePlace {
            place: floats(&found.place),
            sigma: found.sigma().to_f32(),
            level: found.level.to_f32(),
            health: search.health(&found).with(Reason::Dropout, few).into(),
        });
        Ok(())
    })
}

/// Stores the transmitter search in a buffer, to be restored after a sleep or on another machine.
/// `KESTIRIM_DRONE_SNAPSHOT` bytes are enough; `length` receives the number of bytes used.
///
/// Errors: `TOO_SMALL` for the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_drone_snapshot(
    search: *const Drone,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::snapshot(search, buffer, capacity, length) }
}

/// Restores a transmitter search from a snapshot that `kestirim_drone_snapshot` stored, in memory of at least
/// `kestirim_drone_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
/// the snapshot, such as a whole page of flash.
///
/// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_drone_restore(
    memory: *mut c_void,
    size: usize,
    snapshot: *const u8,
    length: usize,
    search: *mut *mut Drone,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::restore(memory, size, snapshot, length, search) }
}
