//! Binary and archive files, which are not a table of text or hold several: they are recognised by their first bytes
//! and decoded into a table of named columns with known units, which is then processed like a text.
//!
//! Every reader goes through a file once, from start to end, and trusts no length in it beyond what remains. A stretch
//! that cannot be read is skipped and counted as the samples that it would have held, by their density in the rest of
//! the file.

mod ardupilot;
mod ardupilot_text;
mod bytes;
mod catalogue;
mod chunks;
mod dataflash;
mod definition;
mod gather;
mod imu_message;
mod join;
mod level_topics;
mod mcap;
mod member;
mod mimu;
mod number_message;
mod numbered;
mod own_message;
mod phones;
mod phyphox;
mod px4;
mod range_message;
mod range_topics;
mod rosbag;
mod sensor_logger;
mod signals;
mod topics;
mod ulog;
mod ulog_reader;
mod unpack;
mod walk;
mod zipped;

pub(crate) use ardupilot::ARDUPILOT;
pub(crate) use level_topics::{Entry as LevelEntry, LevelTopics, Role as LevelRole};
pub(crate) use mcap::MCAP;
pub(crate) use mimu::MIMU;
pub(crate) use number_message::ALTITUDE;
pub(crate) use phyphox::PHYPHOX;
pub(crate) use px4::PX4;
pub(crate) use range_message::Label;
pub(crate) use range_topics::{Entry as RangeEntry, RangeTopics};
pub(crate) use rosbag::ROS1;
pub(crate) use sensor_logger::SENSOR_LOGGER;
pub(crate) use signals::{Signals, autopilot, signals};

use phones::Phone;

use crate::error::Error;
use crate::formats::Format;
use crate::options::Options;
use crate::table::Table;
use crate::text::Text;

/// A log as a table, with what is known of it before its columns are examined.
pub(crate) struct Opened<'a> {
    pub(crate) table: Table,
    /// The text that error messages may quote, if the table was read from a single text.
    pub(crate) text: Option<Text<'a>>,
    /// The format, if it is known.
    pub(crate) format: Option<Format>,
    /// The notes of the format's reader.
    pub(crate) notes: Vec<String>,
}

/// The largest total size of unpacked data, bytes: 1 GiB.
const LARGEST: u64 = 1 << 30;

/// The error for a file that unpacks to too much.
fn too_large() -> Error {
    Error::log("expected a file that unpacks to at most 1 GiB, found a larger one")
}

/// Opens a log of any format.
///
/// # Errors
/// What was expected and what was found.
pub(crate) fn open<'a>(bytes: &'a [u8], options: &Options) -> Result<Opened<'a>, Error> {
    let (format, decoded) = if dataflash::is_it(bytes) {
        (Format::ArduPilot, ardupilot::read(bytes, options))
    } else if ulog_reader::is_it(bytes) {
        (Format::Px4, px4::read(bytes, options))
    } else if mcap::is_it(bytes) {
        (Format::Mcap, mcap::read(bytes, options))
    } else if rosbag::is_it(bytes) {
        (Format::Ros1, rosbag::read(bytes, options))
    } else if zipped::is_it(bytes) {
        let mut phone = Phone::open(bytes, options)?;
        (phone.format(), phone.read(options))
    } else if ardupilot_text::is_it(bytes) {
        (Format::ArduPilot, ardupilot::read_text(bytes, options))
    } else if mimu::is_it(bytes) {
        (Format::OpenShoeMimu, mimu::read(bytes, options))
    } else {
        return open_text(bytes, options);
    };
    if let Some(said) = options.format.filter(|&said| said != format) {
        return Err(Error::options(format!("expected {said} as --format says, found {format}")));
    }
    let Decoded { table, notes } = decoded?;
    Ok(Opened { table, text: None, format: Some(format), notes })
}

/// The topics that hold ranges in a bag of ROS 1 or an MCAP file; `None` if the file is neither.
///
/// # Errors
/// If it cannot be read, or unpacks to too much.
pub(crate) fn ranges<'o>(
    bytes: &[u8],
    options: &'o Options,
) -> Result<Option<(Format, RangeTopics<'o>)>, Error> {
    let read = if mcap::is_it(bytes) {
        mcap::ranges(bytes, options).map(|read| (Format::Mcap, read))
    } else if rosbag::is_it(bytes) {
        rosbag::ranges(bytes, options).map(|read| (Format::Ros1, read))
    } else {
        return Ok(None);
    };
    read.map(Some)
}

/// The topics that hold levels in a bag of ROS 1 or an MCAP file; `None` if the file is neither.
///
/// # Errors
/// If it cannot be read, or unpacks to too much.
pub(crate) fn levels<'o>(
    bytes: &[u8],
    options: &'o Options,
) -> Result<Option<(Format, LevelTopics<'o>)>, Error> {
    let read = if mcap::is_it(bytes) {
        mcap::levels(bytes, options).map(|read| (Format::Mcap, read))
    } else if rosbag::is_it(bytes) {
        rosbag::levels(bytes, options).map(|read| (Format::Ros1, read))
    } else {
        return Ok(None);
    };
    read.map(Some)
}

/// A file as decoded by its reader.
struct Decoded {
    table: Table,
    /// The reader's notes, other than on units.
    notes: Vec<String>,
}

fn open_text<'a>(bytes: &'a [u8], options: &Options) -> Result<Opened<'a>, Error> {
    if let Some(said) = options.format.filter(|said| said.is_container()) {
        return Err(Error::options(format!(
            "expected {said} as --format says, found another file"
        )));
    }
    let text = Text::new(bytes)?;
    let table = Table::read(&text)?;
    refuse_topic(options, "one table of text")?;
    let format = options.format.or_else(|| Format::of(&table));
    Ok(Opened { table, text: Some(text), format, notes: Vec::new() })
}

/// Refuses the option `--topic` for a file that leaves nothing to choose.
fn refuse_topic(options: &Options, found: &str) -> Result<(), Error> {
    if options.topic.is_none() {
        return Ok(());
    }
    Err(Error::options(format!("expected a file of several sensors for --topic, found {found}")))
}
