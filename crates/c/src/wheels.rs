//! The position of a wheeled robot, by the tracker of ranges and wheels of `kestirim-uwb-tracker`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_scalar::{Components, Scalar};
use kestirim_uwb_tracker::{OdometrySample, RangeSample, WheelTracker};

use crate::memory::{self, Handle, argument, array, held, held_mut, place, status, wanted};
use crate::robot::MOST_ANCHORS;
use crate::uwb::{Anchor, Number, OdometryRecord, RangeRecord, RangeReport, TagConfig, TagHealth};
use crate::{Health, Status, floats};

/// A tag in the plane on a robot whose wheels are counted: the wheels move the estimate, the ranges correct it. Scale and
/// drift of the wheels' turns are estimated, and so is the heading, of which nothing need be known.
///
/// Frame: the room's axes in which the anchors are given, right-handed with z up, m.
#[derive(Debug)]
pub struct Wheels {
    _private: [u8; 0],
}

type Tracker = WheelTracker<Number, MOST_ANCHORS>;

impl Handle for Wheels {
    type Value = Tracker;
    const TAG: u32 = 0x6B50_5701;
}

/// Bytes that a tracker takes at most, on any target.
pub const WHEELS_SIZE: usize = 2048;
const _: () = assert!(memory::size::<Wheels>() <= WHEELS_SIZE);
/// Bytes that a snapshot takes at most, on any target.
pub const WHEELS_SNAPSHOT: usize = WHEELS_SIZE / 4 * 5 + 64;

/// Bytes that a tracker takes on this target.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_wheels_size() -> usize {
    memory::size::<Wheels>()
}

/// Alignment of its memory, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_wheels_align() -> usize {
    memory::align::<Wheels>()
}

/// Makes a tracker in memory of at least `kestirim_wheels_size()` bytes, before its first position, for up to
/// `KESTIRIM_MOST_ANCHORS` anchors. Ranges name them by their place in this array.
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

/// Takes in a range. `report` may be null if it is not wanted.
///
/// Errors: `NO_SUCH_ANCHOR`; `IMPLAUSIBLE` below -1 m or above 200 m; `DUPLICATE`; `OUT_OF_ORDER` if it is more than 0.1 s
/// older than the estimate; `NOT_FINITE`.
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

/// Takes in a sample of the wheels: what they did since the one before. Give all, in order with the ranges.
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

/// Sets the tag's height, m.
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

/// Position of the tag, m, room: x, y.
///
/// Errors: `NO_ESTIMATE` before the first one, or when it is lost.
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

/// Standard deviation of the position at a time (µs), m: root of the sum of both axes' variances, with what the anchors'
/// constant errors add.
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

/// Whether the position can be relied upon at a time (µs); `details` may be null if they are not wanted.
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

/// By what the wheels' ways are to be multiplied.
///
/// Errors: `NO_ESTIMATE` before it is known.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_wheels_scale(tracker: *const Wheels, scale: *mut f32) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (tracker, answer) = unsafe { (held(tracker)?, place(scale)?) };
        answer.write(tracker.scale().ok_or(Status::NoEstimate)?.to_f32());
        Ok(())
    })
}

/// Stores the tracker in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_WHEELS_SNAPSHOT` bytes are
/// enough, `length` tells how many it took.
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

/// Makes the tracker in memory of at least `kestirim_wheels_size()` bytes that `kestirim_wheels_snapshot` stored: it goes on
/// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
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
