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

/// A pedestrian tracker: estimates the path of a walking foot from the IMU on it.
///
/// Frames: `body` has the IMU's axes, right-handed. `earth` has z up; its origin and its heading are those of the
/// sensor when the foot first stood.
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

/// Upper bound of the size of a pedestrian tracker on any target, bytes: for static memory.
pub const PEDESTRIAN_SIZE: usize = 2048;
const _: () = assert!(memory::size::<Pedestrian>() <= PEDESTRIAN_SIZE);
/// Upper bound of the size of a pedestrian tracker's snapshot on any target, bytes.
pub const PEDESTRIAN_SNAPSHOT: usize = PEDESTRIAN_SIZE / 4 * 5 + 64;

/// Class of an IMU.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// Calibrated unit (`MicroStrain`, Xsens, NGIMU): its gyroscope starts within 3 mrad/s of zero.
    Industrial = 0,
    /// Bare chip (MPU-6050, MPU-9250, BNO055, LSM6DS): its gyroscope may start 0.1 rad/s off.
    Consumer = 1,
}

/// Settings of a pedestrian tracker: the sensor and its mounting on the foot.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianConfig {
    /// Class of the IMU: a `kestirim_sensor`.
    pub sensor: u32,
    /// Height of the sensor above the ball of the foot, about which the foot rolls in stance, m. 0 treats a standing
    /// foot as motionless.
    pub contact_height: f32,
}

/// One sample of the foot's IMU.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianSample {
    /// Time of the sample, µs since any epoch.
    pub time_us: u64,
    /// Specific force, as an accelerometer measures it, m/s², body frame: +9.8 upwards at rest.
    pub specific_force: [f32; 3],
    /// Angular rate, as a gyroscope measures it, rad/s, body frame.
    pub angular_rate: [f32; 3],
}

/// A stride: from one stance of the foot to the next.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianStride {
    /// End of the stance at which the stride arrived, µs on the samples' clock.
    pub time_us: u64,
    /// Position of the stance at which the stride arrived, m, earth frame.
    pub position: [f32; 3],
    /// Horizontal distance from the preceding stance, m.
    pub length: f32,
    /// Time since the end of the preceding stance, s.
    pub duration: f32,
    /// Change of direction from the preceding stride, rad, anticlockwise from above; 0 for the first stride.
    pub heading_change: f32,
}

/// Estimate of the foot's state after a sample.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PedestrianState {
    /// Time of the sample, µs on the samples' clock.
    pub time_us: u64,
    /// Position of the sensor, m, earth frame.
    pub position: [f32; 3],
    /// Velocity of the sensor, m/s, earth frame.
    pub velocity: [f32; 3],
    /// Orientation of the sensor, from the body to the earth frame: quaternion w, x, y, z.
    pub orientation: [f32; 4],
    /// 1 if the foot stands, else 0.
    pub stance: u8,
    /// 1 if this sample completed a stride, described by `stride`; else 0.
    pub has_stride: u8,
    /// The completed stride; zeros if `has_stride` is 0.
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

/// Size of a pedestrian tracker on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_pedestrian_size() -> usize {
    memory::size::<Pedestrian>()
}

/// Alignment of the pedestrian tracker's memory on this target, bytes.
#[unsafe(no_mangle)]
pub extern "C" fn kestirim_pedestrian_align() -> usize {
    memory::align::<Pedestrian>()
}

/// Creates a pedestrian tracker in memory of at least `kestirim_pedestrian_size()` bytes. `tracker` receives its
/// handle; nothing has to be freed.
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

/// Processes the next sample of the foot's IMU.
///
/// A sample with the time of the last one counts as a repetition and changes nothing.
///
/// Errors: `NOT_FINITE`; `IMPLAUSIBLE` beyond 1000 g or 100000 degrees per second; `OUT_OF_ORDER`.
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

/// The complete estimate of the foot's state after the last sample.
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

/// Ends the walk: completes the stride that led to the present stance, and writes it to `stride`, which may be null.
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

/// Position of the foot's sensor after the last sample, m, earth frame: x, y, z. Zeros until the foot has stood.
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

/// Standard deviations of the foot's position after the last stride, m, earth frame: x, y, z.
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

/// Length of the horizontal path walked so far, from stance to stance, m.
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

/// Whether the path can be relied upon. Reasons why not: `NOT_OBSERVABLE` until the foot has stood still for half a
/// second; `SATURATED` if a sensor's range is too small; `UNITS` if values seem to be in g or degrees instead of m/s²
/// or rad, or the accelerometer needs calibration; `AXES` if axes are swapped between the two sensors; `DROPOUT` after
/// gaps or if the tilt was lost; `INNOVATIONS` if strides end with too large a velocity or jump; `RANGE` if the path
/// exceeds the range of the number format.
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

/// Stores the pedestrian tracker in a buffer, to be restored after a sleep or on another machine.
/// `KESTIRIM_PEDESTRIAN_SNAPSHOT` bytes are enough; `length` receives the number of bytes used.
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

/// Restores a pedestrian tracker from a snapshot that `kestirim_pedestrian_snapshot` stored, in memory of at least
/// `kestirim_pedestrian_size()` bytes. It continues bit for bit as if there had been no interruption. `length` may
/// exceed the snapshot, such as a whole page of flash.
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
