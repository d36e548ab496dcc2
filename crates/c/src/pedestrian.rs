//! The path of a walking foot, by `kestirim-pedestrian`.
#![allow(unsafe_code)] // Functions that C calls: symbols of its own, and pointers, which `memory` checks.

use core::ffi::c_void;

use kestirim_pedestrian::{
    Config, EkfTracker, Estimate, ImuSample, PathUncertainty, SensorClass, Stride,
};
use kestirim_scalar::{Components, Scalar};
use kestirim_snapshot::layout;
use nalgebra::SVector;

use crate::memory::{self, Handle, argument, held, held_mut, place, status, wanted};
use crate::{Health, Status, floats, write};

#[cfg(not(feature = "fixed"))]
type Number = f32;
#[cfg(feature = "fixed")]
type Number = kestirim_scalar::Q12_20;

/// The pedestrian's tracker: where an IMU on a foot is, from what it measures.
///
/// Frames: `body` is the IMU's axes, right-handed. `earth` has z up; its origin is where the foot stood first, its
/// heading the one it had then.
#[derive(Debug)]
pub struct Pedestrian {
    _private: [u8; 0],
}

/// The contents of the memory.
#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct Walk {
    tracker: EkfTracker<Number>,
    uncertainty: PathUncertainty<Number>,
    last: Option<Estimate<Number>>,
}

layout! {
    [] for Walk as "c/pedestrian", 3, Number, []
}

impl Handle for Pedestrian {
    type Value = Walk;
    const TAG: u32 = 0x6B50_4401;
}

/// Bytes that a pedestrian's tracker takes at most, on any target: for memory that is set aside by the compiler.
pub const PEDESTRIAN_SIZE: usize = 2048;
const _: () = assert!(memory::size::<Pedestrian>() <= PEDESTRIAN_SIZE);
/// Bytes that a snapshot takes at most, on any target.
pub const PEDESTRIAN_SNAPSHOT: usize = PEDESTRIAN_SIZE / 4 * 5 + 64;

/// Class of an IMU.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// A calibrated unit (`MicroStrain`, Xsens, NGIMU): its gyroscope starts within 3 mrad/s of zero.
    Industrial = 0,
    /// A bare chip (MPU-6050, MPU-9250, BNO055, LSM6DS): its gyroscope may start 0.1 rad/s off.
    Consumer = 1,
}

/// Settings of sensor and foot.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianConfig {
    /// Class of the IMU: a `kestirim_sensor`.
    pub sensor: u32,
    /// Height of the sensor above the ball of the foot, about which the foot rolls, m. 0 takes it for motionless.
    pub contact_height: f32,
}

/// One sample of the foot's IMU.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianSample {
    /// Time of the sample, µs since any moment.
    pub time_us: u64,
    /// Specific force, as an accelerometer measures it, m/s², body: +9.8 upwards at rest.
    pub specific_force: [f32; 3],
    /// Angular rate, as a gyroscope measures it, rad/s, body.
    pub angular_rate: [f32; 3],
}

/// A stride: from one stance of the foot to the next.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianStride {
    /// End of the stance it arrived at, µs, the samples' clock.
    pub time_us: u64,
    /// Where that is, m, earth.
    pub position: [f32; 3],
    /// Horizontal distance from the stance before, m.
    pub length: f32,
    /// Time since the end of the stance before, s.
    pub duration: f32,
    /// Turn of its direction from that of the stride before, rad, anticlockwise from above; 0 of the first.
    pub heading_change: f32,
}

/// Estimate after a sample.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianState {
    /// Time of the sample, µs.
    pub time_us: u64,
    /// Position of the sensor, m, earth.
    pub position: [f32; 3],
    /// Velocity of the sensor, m/s, earth.
    pub velocity: [f32; 3],
    /// Orientation of the sensor, body to earth: quaternion w, x, y, z.
    pub orientation: [f32; 4],
    /// 1 if the foot stands, else 0.
    pub stance: u8,
    /// 1 if this sample completed a stride, which is `stride`, else 0.
    pub has_stride: u8,
    /// The stride, if there is one; else zeros.
    pub stride: PedestrianStride,
}

fn stride_of(stride: &Stride<Number>) -> PedestrianStride {
    PedestrianStride {
        time_us: stride.time_us,
        position: floats(stride.position.as_array()),
        length: stride.length.to_f32(),
        duration: stride.duration.to_f32(),
        heading_change: stride.heading_change.to_f32(),
    }
}

const NO_STRIDE: PedestrianStride = PedestrianStride {
    time_us: 0,
    position: [0.0; 3],
    length: 0.0,
    duration: 0.0,
    heading_change: 0.0,
};

impl Walk {
    fn new(config: PedestrianConfig) -> Result<Self, Status> {
        let sensor = match config.sensor {
            0 => SensorClass::Industrial,
            1 => SensorClass::Consumer,
            _ => return Err(Status::InvalidArgument),
        };
        let contact_height = Number::from_f32(config.contact_height);
        if !contact_height.is_finite() {
            return Err(Status::NotFinite);
        }
        let config = Config { sensor, contact_height, ..Config::default() };
        Ok(Self {
            tracker: EkfTracker::new(config),
            uncertainty: PathUncertainty::new(sensor),
            last: None,
        })
    }

    fn finish(&mut self) -> Option<Stride<Number>> {
        let stride = self.tracker.finish()?;
        self.uncertainty.add(&stride);
        Some(stride)
    }
}

/// Bytes that a tracker takes on this target.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_pedestrian_size() -> usize {
    memory::size::<Pedestrian>()
}

/// Alignment of its memory, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_pedestrian_align() -> usize {
    memory::align::<Pedestrian>()
}

/// Makes a tracker in memory of at least `kestirim_pedestrian_size()` bytes, before its first sample. `tracker` is its
/// handle from then on, and there is nothing to be freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_init(
    memory: *mut c_void,
    size: usize,
    config: *const PedestrianConfig,
    tracker: *mut *mut Pedestrian,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::init(memory, size, tracker, || Walk::new(argument(config)?)) }
}

/// Takes the next sample.
///
/// A sample with the time of the last is taken for one that was sent twice and changes nothing.
///
/// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 1000 g or 100000 degrees a second; `OUT_OF_ORDER`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_update(
    tracker: *mut Pedestrian,
    sample: *const PedestrianSample,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, sample) = unsafe { (held_mut(tracker)?, argument(sample)?) };
        let estimate = walk.tracker.update(&ImuSample {
            time_us: sample.time_us,
            specific_force: SVector::from(sample.specific_force.map(Number::from_f32)),
            angular_rate: SVector::from(sample.angular_rate.map(Number::from_f32)),
        })?;
        if let Some(stride) = &estimate.stride {
            walk.uncertainty.add(stride);
        }
        walk.last = Some(estimate);
        Ok(())
    })
}

/// The whole estimate after the last sample.
///
/// Errors: `NO_ESTIMATE` before the first sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_now(
    tracker: *const Pedestrian,
    estimate: *mut PedestrianState,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, answer) = unsafe { (held(tracker)?, place(estimate)?) };
        let now = walk.last.as_ref().ok_or(Status::NoEstimate)?;
        answer.write(PedestrianState {
            time_us: now.time_us,
            position: floats(now.position.as_array()),
            velocity: floats(now.velocity.as_array()),
            orientation: floats(&now.orientation.quaternion()),
            stance: u8::from(now.stance),
            has_stride: u8::from(now.stride.is_some()),
            stride: now.stride.as_ref().map_or(NO_STRIDE, stride_of),
        });
        Ok(())
    })
}

/// Ends the walk: writes the stride that led to the stance the foot is in; `stride` may be null.
///
/// Errors: `NO_ESTIMATE` if there is no such stride.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_finish(
    tracker: *mut Pedestrian,
    stride: *mut PedestrianStride,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, answer) = unsafe { (held_mut(tracker)?, wanted(stride)?) };
        let stride = walk.finish().ok_or(Status::NoEstimate)?;
        if let Some(answer) = answer {
            answer.write(stride_of(&stride));
        }
        Ok(())
    })
}

/// Position of the sensor after the last sample, m, earth: x, y, z. Zeros until the foot has stood.
///
/// Errors: `NO_ESTIMATE` before the first sample.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_position(
    tracker: *const Pedestrian,
    position: *mut [f32; 3],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, answer) = unsafe { (held(tracker)?, place(position)?) };
        let last = walk.last.as_ref().ok_or(Status::NoEstimate)?;
        write(answer, last.position.as_array());
        Ok(())
    })
}

/// Standard deviations of the position, m, earth: x, y, z; those after the last stride.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_sigma(
    tracker: *const Pedestrian,
    sigma: *mut [f32; 3],
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, answer) = unsafe { (held(tracker)?, place(sigma)?) };
        write(answer, walk.uncertainty.standard_deviation().as_array());
        Ok(())
    })
}

/// The horizontal path walked, from stance to stance, m.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_path_length(
    tracker: *const Pedestrian,
    length: *mut f32,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, answer) = unsafe { (held(tracker)?, place(length)?) };
        answer.write(walk.tracker.path_length().to_f32());
        Ok(())
    })
}

/// Whether the path can be relied upon. `NOT_OBSERVABLE` stands there until the foot has stood still for half a
/// second, `SATURATED` if a sensor's range is too small, `UNITS` if g or degrees came for m/s² or rad, `AXES` if they
/// are swapped between the two sensors, `DROPOUT` after gaps, `INNOVATIONS` if strides end with too large a velocity.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_health(
    tracker: *const Pedestrian,
    health: *mut Health,
) -> Status {
    status(|| {
        // SAFETY: the caller keeps what the header asks for.
        let (walk, answer) = unsafe { (held(tracker)?, place(health)?) };
        answer.write(walk.tracker.warnings().health().into());
        Ok(())
    })
}

/// Stores the tracker in a buffer, to be restored after a sleep or by another machine: `KESTIRIM_PEDESTRIAN_SNAPSHOT` bytes are
/// enough, `length` tells how many it took.
///
/// Errors: `TOO_SMALL` for the buffer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_snapshot(
    tracker: *const Pedestrian,
    buffer: *mut u8,
    capacity: usize,
    length: *mut usize,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::snapshot(tracker, buffer, capacity, length) }
}

/// Makes the tracker in memory of at least `kestirim_pedestrian_size()` bytes that `kestirim_pedestrian_snapshot` stored: it goes on
/// to the bit as if it had not slept. More bytes than it took, such as a whole page of flash, may be given.
///
/// Errors: `NO_SNAPSHOT`; `FOREIGN_SNAPSHOT`; `DAMAGED_SNAPSHOT`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn kestirim_pedestrian_restore(
    memory: *mut c_void,
    size: usize,
    snapshot: *const u8,
    length: usize,
    tracker: *mut *mut Pedestrian,
) -> Status {
    // SAFETY: the caller keeps what the header asks for.
    unsafe { memory::restore(memory, size, snapshot, length, tracker) }
}
