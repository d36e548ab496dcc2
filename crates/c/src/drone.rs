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

/// Most corners of an area.
pub const MOST_CORNERS: usize = 16;
/// The number of measurements that are kept: evenly spaced ones of a longer flight.
const KEPT: usize = 40;
/// The number of points of the lattice on which the posterior is computed.
const POINTS: usize = 500;
/// The fewest measurements that determine a position: each level is a circle about the transmitter, and fewer circles
/// do not meet in one point.
const FEWEST: usize = 3;

/// A search for a transmitter of unknown power over open ground, from the levels that a drone receives.
///
/// Places are metres in a plane (such as east and north) of one origin for drone and transmitter.
#[derive(Debug)]
pub struct Drone {
    _private: [u8; 0],
}

type Search = BeaconSearch<Number, KEPT, MOST_CORNERS>;

impl Handle for Drone {
    type Value = Search;
    const TAG: u32 = 0x6B50_4201;
}

/// Bytes that a search takes at most, on any target.
pub const DRONE_SIZE: usize = 1024;
const _: () = assert!(memory::size::<Drone>() <= DRONE_SIZE);
/// Bytes that a snapshot takes at most, on any target.
pub const DRONE_SNAPSHOT: usize = DRONE_SIZE / 4 * 5 + 64;

/// A level that the drone received.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DroneMeasurement {
    /// Where the drone is, m: x, y.
    pub place: [f32; 2],
    /// Its height above the transmitter, m.
    pub height: f32,
    /// The level, dBm or dB of any reference, the same for all measurements.
    pub level: f32,
}

/// Where the transmitter is.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DronePlace {
    /// Its place, m: x, y.
    pub place: [f32; 2],
    /// Standard deviation of the place: root of the sum of both axes' variances, m.
    pub sigma: f32,
    /// The level that is received a metre from it, in the measurements' unit.
    pub level: f32,
}

/// Bytes that a search takes on this target. An estimate needs 16 kB of stack on a computer, 9 kB on a microcontroller.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_drone_size() -> usize {
    memory::size::<Drone>()
}

/// Alignment of its memory, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_drone_align() -> usize {
    memory::align::<Drone>()
}

/// Makes a search in memory of at least `kestirim_drone_size()` bytes, in an area with these corners (x, y, m, in either
/// sense of rotation), of which there may be `KESTIRIM_MOST_CORNERS`.
///
/// Errors: `TOO_MANY`; `GEOMETRY` if the corners enclose nothing; `NOT_FINITE`.
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

/// Takes in a measurement.
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

/// Computes where the transmitter is from all measurements that are kept: much work, so ask for it when it is wanted.
///
/// Errors: `NO_ESTIMATE` without a measurement; `CONTRADICTORY` if nothing in the area explains them.
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
        answer.write(DronePlace {
            place: floats(&found.place),
            sigma: found.moments().spread().to_f32(),
            level: found.level.to_f32(),
        });
        Ok(())
    })
}

/// Whether an estimate can be relied upon: `DROPOUT` with fewer than three measurements. How well they determine the
/// place, its standard deviation says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_drone_health(
    search: *const Drone,
    health: *mut Health,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (search, answer) = unsafe { (held(search)?, place(health)?) };
        let few = search.measurements().len() < FEWEST;
        answer.write(kestirim_health::Health::GOOD.with(Reason::Dropout, few).into());
        Ok(())
    })
}

/// Stores the search in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_DRONE_SNAPSHOT` bytes are
/// enough, `length` tells how many it took.
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

/// Makes the search in memory of at least `kestirim_drone_size()` bytes that `kestirim_drone_snapshot` stored: it goes on
/// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
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
