//! The message `Imu` of ROS: `sensor_msgs/Imu` as ROS 1 and `sensor_msgs/msg/Imu` as ROS 2 write it
//! (<https://docs.ros.org/en/noetic/api/sensor_msgs/html/msg/Imu.html>): a header with a stamp, then orientation,
//! angular velocity and linear acceleration, each with the nine numbers of its covariance. m/s², rad/s; the
//! acceleration is specific force: +1 g upwards at rest (REP 145).
//!
//! Where a covariance begins with −1 the sensor has no such values, which are then NaN here.

use super::bytes::Bytes;
use super::gather::Row;

/// The serialisation of a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    /// The format of ROS 1: little-endian without padding.
    Ros1,
    /// The CDR format of DDS, of either byte order, each number aligned to its size.
    Cdr,
    /// Protobuf, the format that `host-sim` writes.
    Protobuf,
}

impl Encoding {
    /// Reads time in µs since 1970, acceleration and rate.
    pub(super) fn read(self, message: &[u8]) -> Option<Row> {
        match self {
            Self::Ros1 => ros1(message),
            Self::Cdr => cdr(message),
            Self::Protobuf => None,
        }
    }
}

fn ros1(message: &[u8]) -> Option<Row> {
    let mut bytes = Bytes(message);
    let _sequence = bytes.u32()?;
    let (seconds, nanoseconds) = (bytes.u32()?, bytes.u32()?);
    let _frame = bytes.counted()?;
    row(f64::from(seconds), nanoseconds, bytes, f64::from_le_bytes)
}

fn cdr(message: &[u8]) -> Option<Row> {
    let mut bytes = Bytes(message);
    let [_, order, _, _] = bytes.take()?;
    let whole = bytes.0.len();
    let (seconds, nanoseconds, length) = match order {
        0 => {
            let seconds = i32::from_be_bytes(bytes.take()?);
            (seconds, u32::from_be_bytes(bytes.take()?), u32::from_be_bytes(bytes.take()?))
        }
        1 => (i32::from_le_bytes(bytes.take()?), bytes.u32()?, bytes.u32()?),
        _ => return None,
    };
    let _frame = bytes.slice(usize::try_from(length).ok()?)?;
    let read = whole - bytes.0.len();
    bytes.slice(read.next_multiple_of(8) - read)?;
    let number = if order == 0 { f64::from_be_bytes } else { f64::from_le_bytes };
    row(f64::from(seconds), nanoseconds, bytes, number)
}

/// Reads the part behind the header.
fn row(
    seconds: f64,
    nanoseconds: u32,
    mut bytes: Bytes<'_>,
    number: fn([u8; 8]) -> f64,
) -> Option<Row> {
    let time = seconds * 1e6 + f64::from(nanoseconds) / 1e3;
    let _orientation_with_covariance = bytes.slice(8 * (4 + 9))?;
    let mut vector = || {
        let mut numbers = [0.0; 12];
        for slot in &mut numbers {
            *slot = number(bytes.take()?);
        }
        let [x, y, z, covariance, ..] = numbers;
        Some(if covariance == -1.0 { [f64::NAN; 3] } else { [x, y, z] })
    };
    let ([gx, gy, gz], [ax, ay, az]) = (vector()?, vector()?);
    Some([time, ax, ay, az, gx, gy, gz])
}
