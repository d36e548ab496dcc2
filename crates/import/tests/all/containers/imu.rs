//! The message `Imu` of ROS as programs write it.

/// The beginning of the walk, s since 1970.
pub(super) const START: f64 = 1_700_000_000.0;

/// The seconds and nanoseconds of a time of the walk.
pub(super) fn stamp(t: f64) -> (u32, u32) {
    let nanoseconds = (t * 1e9).round() as u64;
    (START as u32 + (nanoseconds / 1_000_000_000) as u32, (nanoseconds % 1_000_000_000) as u32)
}

/// The time at which a message was received, ns since 1970.
pub(super) fn receipt(t: f64) -> u64 {
    let (seconds, nanoseconds) = stamp(t);
    u64::from(seconds) * 1_000_000_000 + u64::from(nanoseconds)
}

/// The numbers that follow the header.
fn numbers([_, ax, ay, az, gx, gy, gz]: [f64; 7], bytes: fn(f64) -> [u8; 8]) -> Vec<u8> {
    let mut numbers = vec![0.0, 0.0, 0.0, 1.0];
    numbers.extend([0.01; 9]);
    numbers.extend([gx, gy, gz]);
    numbers.extend([0.0; 9]);
    numbers.extend([ax, ay, az]);
    numbers.extend([0.0; 9]);
    numbers.into_iter().flat_map(bytes).collect()
}

/// A message as ROS 1 writes it.
pub(super) fn ros1(sequence: u32, (seconds, nanoseconds): (u32, u32), row: [f64; 7]) -> Vec<u8> {
    let mut message = [sequence, seconds, nanoseconds, 8].map(u32::to_le_bytes).concat();
    message.extend(b"imu_link");
    message.extend(numbers(row, f64::to_le_bytes));
    message
}

/// A message as ROS 2 writes it, in either byte order, with a frame name of any length.
pub(super) fn cdr(
    frame: &str,
    is_big: bool,
    (seconds, nanoseconds): (u32, u32),
    row: [f64; 7],
) -> Vec<u8> {
    let number = if is_big { u32::to_be_bytes } else { u32::to_le_bytes };
    let mut body = [seconds, nanoseconds, frame.len() as u32 + 1].map(number).concat();
    body.extend(frame.as_bytes());
    body.push(0);
    body.resize(body.len().next_multiple_of(8), 0);
    body.extend(numbers(row, if is_big { f64::to_be_bytes } else { f64::to_le_bytes }));
    [vec![0, u8::from(!is_big), 0, 0], body].concat()
}
