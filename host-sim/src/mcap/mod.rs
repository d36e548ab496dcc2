//! Streams as an MCAP file, which Foxglove, `PlotJuggler` and Rerun open: <https://mcap.dev>.

mod clock;
mod foxglove;
mod place;
mod schema;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use ::mcap::records::{MessageHeader, Metadata};
use ::mcap::write::NoSeek;
use ::mcap::{McapResult, WriteOptions, Writer};

use crate::stream::Stream;
use crate::{Error, output};
use clock::Clock;
use place::Place;
use schema::Layout;

/// Writes the streams as a file of messages in chronological order, atomically.
///
/// Every row is a message of doubles named after the columns. For a stream with positions, each is also written as a
/// pose to its topic with the suffix `/pose`, and all of them as one line to its topic with the suffix `/path`. The
/// same streams give the same bytes. Times before 0 cannot be represented: in that case all streams are shifted by the
/// same whole seconds, which the metadata record `clock` states.
///
/// # Errors
/// [`Error::File`] if a time is not a number or the times span more than 136 years, [`Error::Write`] if the
/// file cannot be written.
pub fn write(path: &Path, streams: &[Stream]) -> Result<(), Error> {
    let times = streams.iter().flat_map(|stream| stream.rows.iter().map(|&(time, _)| time));
    let clock = Clock::holding(times)
        .map_err(|problem| Error::File { path: path.to_path_buf(), problem })?;
    output::write_file(path, |file| {
        messages(NoSeek::new(file), streams, clock).map_err(io::Error::other)
    })
}

/// Writes the complete contents of the file.
fn messages(file: NoSeek<&mut dyn Write>, streams: &[Stream], clock: Clock) -> McapResult<()> {
    let mut file = WriteOptions::new().compression(None).disable_seeking(true).create(file)?;
    file.write_metadata(&Metadata {
        name: "clock".to_owned(),
        metadata: BTreeMap::from([("zero_s".to_owned(), clock.zero_s().to_string())]),
    })?;
    let mut channels = streams
        .iter()
        .map(|stream| Channels::new(&mut file, stream))
        .collect::<McapResult<Vec<_>>>()?;
    let rows = streams.iter().map(|stream| stream.rows.iter());
    let mut order: Vec<_> = rows
        .enumerate()
        .flat_map(|(index, rows)| {
            rows.map(move |(time, values)| (clock.nanoseconds(*time), index, values))
        })
        .collect();
    // Rows of the same time stay in the order of their streams.
    order.sort_by_key(|&(time, index, _)| (time, index));
    for (time, index, values) in order {
        channels[index].write(&mut file, time, values)?;
    }
    file.finish()?;
    Ok(())
}

/// The channels that the messages of a stream are written to.
struct Channels<'a> {
    stream: &'a Stream,
    layout: Layout,
    rows: u16,
    place: Option<(Place, u16, u16)>,
    sequence: u32,
}

/// The file while it is being written.
type Draft<'a> = Writer<NoSeek<&'a mut dyn Write>>;

impl<'a> Channels<'a> {
    fn new(file: &mut Draft<'_>, stream: &'a Stream) -> McapResult<Self> {
        let layout = Layout::new(&stream.topic, &stream.columns);
        let rows = channel(file, &stream.topic, layout.name(), &layout.file_descriptor_set())?;
        let mut drawn = |under: &str, schema: foxglove::Schema| {
            let topic = format!("{}/{under}", stream.topic);
            channel(file, &topic, schema.name, schema.descriptors)
        };
        let place = match Place::among(&stream.columns) {
            Some(place) => Some((
                place,
                drawn("pose", foxglove::POSE_IN_FRAME)?,
                drawn("path", foxglove::SCENE_UPDATE)?,
            )),
            None => None,
        };
        Ok(Self { stream, layout, rows, place, sequence: 0 })
    }

    fn write(&mut self, file: &mut Draft<'_>, time: u64, values: &[f64]) -> McapResult<()> {
        let first = self.sequence == 0;
        self.sequence = self.sequence.wrapping_add(1);
        let header = |channel_id| MessageHeader {
            channel_id,
            sequence: self.sequence,
            log_time: time,
            publish_time: time,
        };
        file.write_to_known_channel(&header(self.rows), &self.layout.message(values))?;
        let Some((place, poses, paths)) = &self.place else { return Ok(()) };
        if first {
            let path = place.path(time, &self.stream.topic, &self.stream.rows);
            file.write_to_known_channel(&header(*paths), &path)?;
        }
        match place.pose(time, values) {
            Some(pose) => file.write_to_known_channel(&header(*poses), &pose),
            None => Ok(()),
        }
    }
}

/// Adds a channel of protobuf messages.
fn channel(
    file: &mut Draft<'_>,
    topic: &str,
    message: &str,
    descriptors: &[u8],
) -> McapResult<u16> {
    let schema = file.add_schema(message, "protobuf", descriptors)?;
    file.add_channel(schema, topic, "protobuf", &BTreeMap::new())
}
