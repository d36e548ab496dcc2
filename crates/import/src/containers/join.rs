//! Merges two sensors whose clocks agree but whose sampling times differ.

use super::gather::Stream;
use crate::error::Error;

/// The longest gap that is interpolated over, s.
const LONGEST_GAP: f64 = 0.1;

/// The rows of a gyroscope, with the accelerometer interpolated linearly onto their times.
///
/// Rows without accelerometer values on both sides are dropped: there is no extrapolation beyond its ends, and no
/// interpolation across gaps of more than 0.1 s. `second` is one second in the unit of both times.
///
/// # Errors
/// If no row remains.
pub(super) fn join(
    gyroscope: &Stream,
    accelerometer: &Stream,
    second: f64,
) -> Result<(Stream, String), Error> {
    let [times, ax, ay, az, ..] = &accelerometer.columns;
    let axes = [ax, ay, az];
    // A single time out of order must not cause a gap in all that follow.
    let mut order: Vec<usize> = (0..times.len()).filter(|&i| times[i].is_finite()).collect();
    order.sort_by(|&a, &b| times[a].total_cmp(&times[b]));
    let mut joined = Stream::default();
    for i in 0..gyroscope.len() {
        let [time, _, _, _, gx, gy, gz] = gyroscope.row(i);
        let after = order.partition_point(|&at| times[at] < time);
        let neighbours = [after.checked_sub(1), Some(after)]
            .map(|place| place.and_then(|place| order.get(place)).copied());
        let force = match neighbours {
            [_, Some(at)] if times[at] == time => axes.map(|axis| axis[at]),
            [Some(before), Some(at)] if times[at] - times[before] <= LONGEST_GAP * second => {
                let share = (time - times[before]) / (times[at] - times[before]);
                axes.map(|axis| axis[before] + share * (axis[at] - axis[before]))
            }
            _ => continue,
        };
        let [ax, ay, az] = force;
        joined.push(gyroscope.records[i], [time, ax, ay, az, gx, gy, gz]);
    }
    let left_out = gyroscope.len() - joined.len();
    if joined.len() == 0 {
        return Err(Error::log(
            "expected an accelerometer within 0.1 s of the gyroscope's times, found none",
        ));
    }
    let rest = match left_out {
        0 => String::new(),
        1 => ", 1 of which has none around it".to_owned(),
        _ => format!(", {left_out} of which have none around them"),
    };
    let note = format!("acceleration interpolated onto the times of the angular rate{rest}");
    Ok((joined, note))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(times: &[f64]) -> Stream {
        let mut stream = Stream::default();
        for (i, &time) in times.iter().enumerate() {
            stream.push(i, [time, 10.0 * time, 0.0, time, time, 0.0, 0.0]);
        }
        stream
    }

    #[test]
    fn nothing_is_extrapolated() {
        let accelerometer = stream(&[1.0, 1.05, 1.1, 1.3, 1.35, f64::NAN, 1.32]);
        let gyroscope = stream(&[0.99, 1.0, 1.02, 1.1, 1.15, 1.33, 1.36]);
        let (joined, note) = join(&gyroscope, &accelerometer, 1.0).unwrap();
        assert_eq!(joined.columns[0], [1.0, 1.02, 1.1, 1.33]);
        for (time, value) in joined.columns[0].iter().zip(&joined.columns[1]) {
            assert!((10.0 * time - value).abs() < 1e-12);
        }
        assert!(note.ends_with("3 of which have none around them"), "{note}");
        assert!(join(&gyroscope, &stream(&[]), 1.0).is_err());
    }
}
