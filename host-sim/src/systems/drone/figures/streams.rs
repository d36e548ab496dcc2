//! A flight as streams, for other programs.

use kestirim_replay::drone::Track;

use crate::stream::Stream;

/// The measurements, the estimates and, if known, the truth.
pub fn streams(track: &Track) -> Vec<Stream> {
    let measured = track.stops.iter().map(|stop| {
        let [x, y] = stop.place;
        (stop.t, vec![x, y, stop.height, stop.loss])
    });
    let found = track.estimates.iter().map(|found| {
        let [x, y] = found.place;
        (track.stop(found).t, vec![x, y, found.sd_m])
    });
    let columns = ["x_m", "y_m", "z_m", "loss_db"];
    let mut streams = vec![
        Stream::new("/drone/measurements", &columns, measured.collect()),
        Stream::new("/drone/estimate", &["x_m", "y_m", "sd_m"], found.collect()),
    ];
    if !track.truth.is_empty() {
        let rows = track.stops.iter().zip(&track.truth).map(|(stop, user)| (stop.t, user.to_vec()));
        streams.push(Stream::new("/drone/truth", &["x_m", "y_m"], rows.collect()));
    }
    streams
}
