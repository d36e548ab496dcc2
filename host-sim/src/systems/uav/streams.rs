//! A recorded flight for other programs.

use super::follow::Followed;
use super::plant::STREAM_COLUMNS;
use super::recording::Recording;
use crate::stream::Stream;

/// Inputs, measurements, estimates and, where it is known, the truth: all as in the log.
pub(super) fn streams(recording: &Recording, followed: &Followed) -> Vec<Stream> {
    let unknown = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let outputs: Vec<&str> = recording.names().collect();
    let inputs = recording.inputs().map(|(t_us, input)| (seconds(t_us), input.into()));
    let measured = recording
        .measured()
        .map(|(t_us, row)| (seconds(t_us), row.into_iter().map(unknown).collect()));
    let estimates = followed.estimates.iter();
    let estimates = estimates.map(|e| (seconds(e.t_us), recording.absolute(e).as_slice().to_vec()));
    let mut streams = vec![
        Stream::new("/uav/inputs", &["delta_e", "delta_t"], inputs.collect()),
        Stream::new("/uav/sensors", &outputs, measured.collect()),
        Stream::new("/uav/estimate", &STREAM_COLUMNS, estimates.collect()),
    ];
    streams.extend(recording.truth.as_ref().map(|truth| {
        let rows = truth.iter().map(|(t_us, row)| (seconds(*t_us), row.map(unknown).into()));
        Stream::new("/uav/truth", &STREAM_COLUMNS, rows.collect())
    }));
    streams
}

fn seconds(t_us: i64) -> f64 {
    t_us as f64 / 1e6
}
