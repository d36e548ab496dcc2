//! A walk as streams, for other programs.

use kestirim_replay::pedestrian::{Trace, TrackPoint};

use super::placement::Placement;
use super::seconds;
use crate::stream::Stream;
use crate::systems::pedestrian::Sample;

/// The sensor data, the track, and the truth as far as it is known, rotated onto the estimate, whose frame is the one
/// in which `--track` writes it.
pub fn streams(samples: &[Sample], trace: &Trace, truth: &[TrackPoint]) -> Vec<Stream> {
    let imu = samples.iter().map(|sample| {
        let values = [sample.specific_force, sample.angular_rate];
        (seconds(sample.time_us), values.concat())
    });
    let estimate = trace.walk.track.iter().zip(&trace.moments).map(|(point, moment)| {
        let stance = f64::from(u8::from(moment.stance));
        let values = [&point.position[..], &moment.velocity, &[stance]];
        (seconds(point.time_us), values.concat())
    });
    let strides = trace.walk.strides.iter().map(|stride| {
        let values = [&stride.position[..], &[stride.length_m, stride.duration_s]];
        (seconds(stride.time_us), values.concat())
    });
    let mut streams = vec![
        Stream::new(
            "/pedestrian/imu",
            &["ax_m_s2", "ay_m_s2", "az_m_s2", "gx_rad_s", "gy_rad_s", "gz_rad_s"],
            imu.collect(),
        ),
        Stream::new(
            "/pedestrian/estimate",
            &["x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "stance"],
            estimate.collect(),
        ),
        Stream::new(
            "/pedestrian/strides",
            &["x_m", "y_m", "z_m", "length_m", "duration_s"],
            strides.collect(),
        ),
    ];
    if !truth.is_empty() {
        let placement = Placement::of(&trace.walk.track, truth);
        let columns = if truth.iter().all(|point| point.position[2].is_finite()) { 3 } else { 2 };
        let rows = truth.iter().map(|point| {
            let [x, y] = placement.from_plan(point.horizontal());
            (seconds(point.time_us), [x, y, point.position[2]][..columns].to_vec())
        });
        let names = &["x_m", "y_m", "z_m"][..columns];
        streams.push(Stream::new("/pedestrian/truth", names, rows.collect()));
    }
    streams
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::pedestrian::recording::{Recording, Walked};
    use kestirim_replay::pedestrian::{Options, trace};

    #[test]
    fn rows_fit_their_columns_and_truth_lies_on_the_estimate() {
        let recording = Recording::synthetic(Walked::Route, 50.0, 1, 0).unwrap();
        let (samples, truth) = (&recording.log.samples, recording.truth());
        let streams = streams(samples, &trace(samples, &Options::default()).unwrap(), &truth);
        for stream in &streams {
            assert!(!stream.rows.is_empty(), "{}", stream.topic);
            assert!(stream.rows.iter().all(|(_, row)| row.len() == stream.columns.len()));
            assert!(stream.rows.is_sorted_by(|a, b| a.0 <= b.0));
        }
        let last = |topic: usize| &streams[topic].rows.last().unwrap().1;
        assert!((last(1)[0] - last(3)[0]).hypot(last(1)[1] - last(3)[1]) < 0.5);
    }
}
