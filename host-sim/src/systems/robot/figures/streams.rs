//! A recording and its track as streams, for other programs.

use kestirim_replay::robot::{Epoch, Event};

use crate::stream::Stream;
use crate::systems::robot::recording::Recording;
use crate::systems::robot::track::Tracks;

/// The measurements, the track, the smoothed track if there is one, and the truth as far as it is known. Points that
/// were recorded separately all begin at the same time, so each has its own topics.
pub fn streams(recording: &Recording, tracks: &Tracks) -> Vec<Stream> {
    let seconds = |time_us: i64| time_us as f64 * 1e-6;
    let mut streams = Vec::new();
    for (index, (part, trace)) in recording.parts.iter().zip(&tracks.traces).enumerate() {
        let topic = |name: &str| match part.name.as_str() {
            "" => format!("/robot/{name}"),
            point => format!("/robot/{point}/{name}"),
        };
        let ranges = trace.ranges.iter().map(|(range, reception)| {
            let taken = f64::from(u8::from(reception.taken));
            let nis = reception.nis().unwrap_or(f64::NAN);
            (seconds(range.time_us), vec![range.anchor as f64, range.metres, taken, nis])
        });
        let names = ["anchor_index", "range_m", "taken", "nis"];
        streams.push(Stream::new(topic("ranges"), &names, ranges.collect()));
        let estimate = |epoch: &Epoch| {
            let [x, y, z] = epoch.position.unwrap_or([f64::NAN; 3]);
            (seconds(epoch.time_us), vec![x, y, z, epoch.sigma_m().unwrap_or(f64::NAN)])
        };
        let names = ["x_m", "y_m", "z_m", "sigma_m"];
        let rows = trace.epochs.iter().map(estimate).collect();
        streams.push(Stream::new(topic("estimate"), &names, rows));
        if let Some(epochs) = tracks.smoothed().and_then(|smoothed| smoothed.parts.get(index)) {
            let rows = epochs.iter().map(estimate).collect();
            streams.push(Stream::new(topic("smoothed"), &names, rows));
        }
        if let Some(truth) = &part.truth {
            let times = trace.epochs.iter().map(|epoch| epoch.time_us);
            let known =
                times.filter_map(|time_us| Some((seconds(time_us), truth.at(time_us)?.to_vec())));
            streams.push(Stream::new(topic("truth"), &["x_m", "y_m"], known.collect()));
        }
    }
    let mut sensors: Vec<Stream> = Vec::new();
    for event in recording.parts.iter().flat_map(|part| &part.events) {
        let Some((topic, columns, row)) = streamed(event) else { continue };
        let row = (seconds(event.time_us()), row);
        match sensors.iter_mut().find(|stream| stream.topic == topic) {
            Some(stream) => stream.rows.push(row),
            None => sensors.push(Stream::new(topic, columns, vec![row])),
        }
    }
    streams.extend(sensors);
    streams
}

/// The stream of a sensor event: its topic, its columns and their values; `None` if there is none.
fn streamed(event: &Event) -> Option<(&'static str, &'static [&'static str], Vec<f64>)> {
    match event {
        Event::Inertial(sample) => {
            Some(("/robot/imu", &["ax_m_s2", "ay_m_s2", "az_m_s2"], sample.acceleration.to_vec()))
        }
        Event::Wheels(sample) => Some((
            "/robot/wheels",
            &["speed_m_s", "turn_rate_rad_s"],
            vec![sample.speed, sample.turn_rate],
        )),
        // Ranges are written elsewhere, each with its outcome.
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::ScalarKind;
    use crate::systems::robot::recording::Driven;
    use crate::systems::robot::settings::of_the_office;

    #[test]
    fn rows_fit_their_columns_and_every_point_has_its_topics() {
        let setup = of_the_office(ScalarKind::F32);
        for (driven, expected) in [(Driven::Line, 4), (Driven::Points, 60)] {
            let recording = Recording::synthetic(driven, 1);
            let tracks = Tracks::smoothed_too(&recording, &setup).unwrap();
            let streams = streams(&recording, &tracks);
            assert_eq!(streams.len(), expected);
            for stream in &streams {
                assert!(!stream.rows.is_empty(), "{}", stream.topic);
                assert!(stream.rows.iter().all(|(_, row)| row.len() == stream.columns.len()));
            }
        }
    }
}
