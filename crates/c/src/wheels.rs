//! The position of a wheeled robot, by the tracker of ranges and wheels of `kestirim-uwb-tracker`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_tracker::{OdometrySample, RangeSample, WheelTracker};

use crate::memory::{self, Handle, argument, array, held, held_mut, place, status, wanted};
use crate::robot::MOST_ANCHORS;
use crate::uwb::{Anchor, Number, OdometryRecord, RangeRecord, RangeReport, TagConfig, TagHealth};
use crate::{Health, Status, floats};

/// A wheel tracker: estimates the position of a tag in the plane on a robot with wheel odometry. The wheels drive the
/// prediction, the ranges correct it. The wheels' scale, the gain and drift of their turns, and the heading are
/// estimated: the heading need not be known.
///
/// Frame: `room` has the axes in which the anchors are given, right-handed with z up, m.
#[derive(Debug)]
pub struct Wheels {
    _private: [u8; 0],
}

type Tracker = WheelTracker<Number, MOST_ANCHORS>;

impl Handle for Wheels {
    type Value = Tracker;
    const TAG: u32 = 0x6B50_5701;
}

/// Upper bound of the size of a wheel tracker on any target, bytes: for static memory.
pub const WHEELS_SIZE: usize = 2048;
const _: () = assert!(memory::size::<Wheels>() <= WHEELS_SIZE);
/// Upper bound of the size of a wheel tracker's snapshot on any target, bytes.
pub const WHEELS_SNAPSHOT: usize = WHEELS_SIZE / 4 * 5 + 64;

/// Size of a wheel tracker on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_wheels_size() -> usize {
    memory::size::<Wheels>()
}

/// Alignment of the wheel tracker's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_wheels_align() -> usize {
    memory::align::<Wheels>()
}

/// Creates a wheel tracker without a position yet, in memory of at least `kestirim_wheels_size()` bytes, for up to
/// `KESTIRIM_MOST_ANCHORS` anchors. Ranges refer to an anchor by its index in this array.
///
/// Errors: `TOO_MANY`; `NOT_FINITE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_init(
    memory: *mut c_void,
    size: usize,
    config: *const TagConfig,
    anchors: *const Anchor,
    count: usize,
    tracker: *mut *mut Wheels,
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
pub unsafe extern "C" fn kestirim_wheels_range(
    tracker: *mut Wheels,
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

/// Processes a sample of the wheels: their motion since the preceding sample. Pass every sample, in the order of time
/// with the ranges.
///
/// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 100 m/s or rad/s; `OUT_OF_ORDER`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_odometry(
    tracker: *mut Wheels,
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
pub unsafe extern "C" fn kestirim_wheels_set_height(tracker: *mut Wheels, height: f32) -> Status {
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
pub unsafe extern "C" fn kestirim_wheels_position(
    tracker: *const Wheels,
    position: *mut [f32; 2],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer) = unsafe { (held(tracker)?, place(position)?) };
        answer.write(floats(tracker.position().ok_or(Status::NoEstimate)?.as_array()));
        Ok(())
    })
}

/// Standard deviation of the tag's position at a time (µs), m: the root of the sum of both axes' variances, including
/// the effect of the anchors' constant errors.
///
/// Errors: `NO_ESTIMATE`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_sigma(
    tracker: *const Wheels,
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
pub unsafe extern "C" fn kestirim_wheels_health(
    tracker: *const Wheels,
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

/// Factor by which distances measured by the wheels have to be multiplied.
///
/// Errors: `NO_ESTIMATE` before the factor is known.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_scale(tracker: *const Wheels, scale: *mut f32) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer) = unsafe { (held(tracker)?, place(scale)?) };
        answer.write(tracker.scale().ok_or(Status::NoEstimate)?.to_f32());
        Ok(())
    })
}

/// Stores the wheel tracker in a buffer, to be restored after a sleep or on another machine. `KESTIRIM_WHEELS_SNAPSHOT`
/// bytes are enough; `length` receives the number of bytes used.
///
/// Errors: `TOO_SMALL` for the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_snapshot(
    tracker: *const Wheels,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::snapshot(tracker, buffer, capacity, length) }
}

/// Restores a wheel tracker from a snapshot that `kestirim_wheels_snapshot` stored, in memory of at least
/// `kestirim_wheels_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may exceed
/// the snapshot, such as a whole page of flash.
///
/// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_restore(
    memory: *mut c_void,
    size: usize,
    snapshot: *const u8,
    length: usize,
    tracker: *mut *mut Wheels,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::restore(memory, size, snapshot, length, tracker) }
}
