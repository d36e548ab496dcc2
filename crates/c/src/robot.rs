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

/// A tag tracker: estimates position and velocity of a tag in the plane, at a known height, from single ranges to
/// anchors in any order, optionally with an IMU and wheels.
///
/// Frame: `room` has the axes in which the anchors are given, right-handed with z up, m.
#[derive(Debug)]
pub struct Robot {
    _private: [u8; 0],
}

/// Largest number of anchors of a tag tracker.
pub const MOST_ANCHORS: usize = 8;

type Tracker = PlaneTracker<Number, MOST_ANCHORS>;

impl Handle for Robot {
    type Value = Tracker;
    const TAG: u32 = 0x6B50_5201;
}

/// Upper bound of the size of a tag tracker on any target, bytes: for static memory.
pub const ROBOT_SIZE: usize = 1536;
const _: () = assert!(memory::size::<Robot>() <= ROBOT_SIZE);
/// Upper bound of the size of a tag tracker's snapshot on any target, bytes.
pub const ROBOT_SNAPSHOT: usize = ROBOT_SIZE / 4 * 5 + 64;

/// One sample of an IMU that is fixed to the tag.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RobotInertial {
    /// Time of the sample, µs on the ranges' clock.
    pub time_us: u64,
    /// Acceleration in the body's axes, with or without gravity, m/s². From its changes the tracker distinguishes
    /// standing from moving.
    pub acceleration: [f32; 3],
}

/// Size of a tag tracker on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_robot_size() -> usize {
    memory::size::<Robot>()
}

/// Alignment of the tag tracker's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_robot_align() -> usize {
    memory::align::<Robot>()
}

/// Creates a tag tracker without a position yet, in memory of at least `kestirim_robot_size()` bytes, for up to
/// `KESTIRIM_MOST_ANCHORS` anchors. Ranges refer to an anchor by its index in this array.
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

/// Processes a range to an anchor. `report` receives its outcome, and may be null.
///
/// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than
/// 0.1 s older than the estimate; `NOT_FINITE`.
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

/// Processes a sample of the tag's IMU, which shows whether the tag stands.
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

/// Processes a sample of the wheels: the speed, and whether the robot turns. `kestirim_wheels` makes fuller use of
/// wheels.
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

/// Sets the height of the tag in the room frame, m.
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

/// Position of the tag, m, room frame: x, y.
///
/// Errors: `NO_ESTIMATE` before the first position, or while it is lost.
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

/// Velocity of the tag, m/s, room frame: x, y.
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

/// Standard deviation of the tag's position at a time (µs), m: the root of the sum of both axes' variances, including
/// the effect of the anchors' constant errors and of a second position that the ranges allow.
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

/// Whether the tag's position can be relied upon at a time (µs). `details` receives the health in numbers, and may be
/// null.
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

/// Stores the tag tracker in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_ROBOT_SNAPSHOT`
/// bytes are enough; `length` receives the number of bytes used.
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

/// Restores a tag tracker from a snapshot that `kestirim_robot_snapshot` stored, in memory of at least
/// `kestirim_robot_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
/// the snapshot, such as a whole page of flash.
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
