//! The position of a tag from ranges to anchors, by the tracker in the plane of `kestirim-uwb-tracker`, with IMU and
//! wheels.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_tracker::{InertialSample, OdometrySample, PlaneTracker, RangeSample};
use nalgebra::SVector;

use crate::memory::{self, Handle, argument, array, held, held_mut, place, status, wanted};
use crate::uwb::{Anchor, Number, OdometryRecord, RangeRecord, RangeReport, TagConfig, TagHealth};
use crate::{Health, Status, floats};

/// A tag in the plane at a known height: position and velocity from single ranges to anchors, in any order, with IMU and
/// wheels if there are any.
///
/// Frame: the room's axes in which the anchors are given, right-handed with z up, m.
#[derive(Debug)]
pub struct Robot {
    _private: [u8; 0],
}

/// Most anchors of a tracker.
pub const MOST_ANCHORS: usize = 8;

type Tracker = PlaneTracker<Number, MOST_ANCHORS>;

impl Handle for Robot {
    type Value = Tracker;
    const TAG: u32 = 0x6B50_5201;
}

/// Bytes that a tracker takes at most, on any target.
pub const ROBOT_SIZE: usize = 1536;
const _: () = assert!(memory::size::<Robot>() <= ROBOT_SIZE);
/// Bytes that a snapshot takes at most, on any target.
pub const ROBOT_SNAPSHOT: usize = ROBOT_SIZE / 4 * 5 + 64;

/// One sample of an IMU on the tag.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotInertial {
    /// Time of the sample, µs, the ranges' clock.
    pub time_us: u64,
    /// Acceleration in the body's axes, with or without gravity, m/s². From its changes the tracker tells standing from
    /// moving.
    pub acceleration: [f32; 3],
}

/// Bytes that a tracker takes on this target.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_robot_size() -> usize {
    memory::size::<Robot>()
}

/// Alignment of its memory, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_robot_align() -> usize {
    memory::align::<Robot>()
}

/// Makes a tracker in memory of at least `kestirim_robot_size()` bytes, before its first position, for up to
/// `KESTIRIM_MOST_ANCHORS` anchors. Ranges name them by their place in this array.
///
/// Errors: `TOO_MANY`; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_init(
    memory: *mut c_void,
    size: usize,
    config: *const TagConfig,
    anchors: *const Anchor,
    count: usize,
    tracker: *mut *mut Robot,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe {
        memory::init(memory, size, tracker, || {
            let anchors = Anchor::all::<MOST_ANCHORS>(array(anchors, count)?)?;
            Ok(Tracker::new(argument(config)?.to_config()?, &anchors)?)
        })
    }
}

/// Takes in a range. `report` may be null if it is not wanted.
///
/// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than 0.1 s
/// older than the estimate; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_range(
    tracker: *mut Robot,
    sample: *const RangeRecord,
    report: *mut RangeReport,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, sample, answer) =
            unsafe { (held_mut(tracker)?, argument(sample)?, wanted(report)?) };
        let report = tracker.range(&RangeSample {
            time_us: sample.time_us,
            anchor: sample.anchor as usize,
            range: Number::from_f32(sample.range),
        })?;
        if let Some(answer) = answer {
            answer.write(RangeReport::of(&report));
        }
        Ok(())
    })
}

/// Takes in a sample of an IMU: whether the tag stands.
///
/// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 500 m/s²; `OUT_OF_ORDER`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_inertial(
    tracker: *mut Robot,
    sample: *const RobotInertial,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, sample) = unsafe { (held_mut(tracker)?, argument(sample)?) };
        tracker.inertial(&InertialSample {
            time_us: sample.time_us,
            acceleration: SVector::from(sample.acceleration.map(Number::from_f32)),
            push: None,
        })?;
        Ok(())
    })
}

/// Takes in a sample of the wheels: speed, and whether it turns. `kestirim_wheels` makes more of them.
///
/// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 100 m/s or rad/s; `OUT_OF_ORDER`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_odometry(
    tracker: *mut Robot,
    sample: *const OdometryRecord,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, sample) = unsafe { (held_mut(tracker)?, argument(sample)?) };
        tracker.odometry(&OdometrySample::from(sample))?;
        Ok(())
    })
}

/// Sets the tag's height, m.
///
/// Errors: `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_set_height(tracker: *mut Robot, height: f32) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let tracker = unsafe { held_mut(tracker)? };
        Ok(tracker.set_height(Number::from_f32(height))?)
    })
}

/// Position of the tag, m, room: x, y.
///
/// Errors: `NO_ESTIMATE` before the first one, or when it is lost.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_position(
    tracker: *const Robot,
    position: *mut [f32; 2],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer) = unsafe { (held(tracker)?, place(position)?) };
        answer.write(floats(tracker.position().ok_or(Status::NoEstimate)?.as_array()));
        Ok(())
    })
}

/// Velocity of the tag, m/s, room: x, y.
///
/// Errors: `NO_ESTIMATE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_velocity(
    tracker: *const Robot,
    velocity: *mut [f32; 2],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer) = unsafe { (held(tracker)?, place(velocity)?) };
        answer.write(floats(tracker.velocity().ok_or(Status::NoEstimate)?.as_array()));
        Ok(())
    })
}

/// Standard deviation of the position at a time (µs), m: root of the sum of both axes' variances, with what the anchors'
/// constant errors add.
///
/// Errors: `NO_ESTIMATE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_sigma(
    tracker: *const Robot,
    time_us: u64,
    sigma: *mut f32,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer) = unsafe { (held(tracker)?, place(sigma)?) };
        let sigma = tracker.health(time_us).position_sigma.ok_or(Status::NoEstimate)?;
        answer.write(sigma.to_f32());
        Ok(())
    })
}

/// Whether the position can be relied upon at a time (µs); `details` may be null if they are not wanted.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_health(
    tracker: *const Robot,
    time_us: u64,
    health: *mut Health,
    details: *mut TagHealth,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer, details) =
            unsafe { (held(tracker)?, place(health)?, wanted(details)?) };
        let health = tracker.health(time_us);
        answer.write(health.in_short().into());
        if let Some(details) = details {
            details.write(TagHealth::of(&health));
        }
        Ok(())
    })
}

/// Stores the tracker in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_ROBOT_SNAPSHOT` bytes are
/// enough, `length` tells how many it took.
///
/// Errors: `TOO_SMALL` for the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_snapshot(
    tracker: *const Robot,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::snapshot(tracker, buffer, capacity, length) }
}

/// Makes the tracker in memory of at least `kestirim_robot_size()` bytes that `kestirim_robot_snapshot` stored: it goes on
/// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
///
/// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_robot_restore(
    memory: *mut c_void,
    size: usize,
    snapshot: *const u8,
    length: usize,
    tracker: *mut *mut Robot,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::restore(memory, size, snapshot, length, tracker) }
}
