//! The streams of a recorded flight, for other programs.

use crate::stream::Stream;
use crate::systems::uav::simulate::plant::STREAM_COLUMNS;
use crate::systems::uav::track::Track;

/// The inputs, measurements, estimates and, if known, the truth, in the coordinates of the log.
pub fn streams(Track { flight, followed, .. }: &Track) -> Vec<Stream> {
    let unknown = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let outputs: Vec<&str> = flight.names().collect();
    let inputs = flight.inputs().map(|(t_us, input)| (seconds(t_us), input.into()));
    let measured = flight
        .measured()
        .map(|(t_us, row)| (seconds(t_us), row.into_iter().map(unknown).collect()));
    let estimates = followed.estimates.iter();
    let estimates = estimates.map(|e| (seconds(e.t_us), flight.absolute(e).as_slice().to_vec()));
    let mut streams = vec![
        Stream::new("/uav/inputs", &["delta_e", "delta_t"], inputs.collect()),
        Stream::new("/uav/sensors", &outputs, measured.collect()),
        Stream::new("/uav/estimate", &STREAM_COLUMNS, estimates.collect()),
    ];
    streams.extend(flight.truth.as_ref().map(|truth| {
        let rows = truth.iter().map(|(t_us, row)| (seconds(*t_us), row.map(unknown).into()));
        Stream::new("/uav/truth", &STREAM_COLUMNS, rows.collect())
    }));
    streams
}

fn seconds(t_us: i64) -> f64 {
    t_us as f64 / 1e6
}
