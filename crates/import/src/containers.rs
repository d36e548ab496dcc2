//! Files that are no table of text, or hold several: recognised by their first bytes and decoded into a table of named
//! columns with known units, which then goes the same way as a text.
//!
//! Every reader goes through a file once, from start to end, and takes no length from it that goes beyond what remains. A
//! stretch that cannot be read is skipped and counted as the samples that it would have held, by how dense they are in the
//! rest of the file.

mod ardupilot;
mod ardupilot_text;
mod bytes;
mod gather;
mod join;
mod numbered;
mod px4;
mod ulog;
mod walk;

pub(crate) use ardupilot::ARDUPILOT;
pub(crate) use px4::PX4;

use crate::error::Error;
use crate::formats::Format;
use crate::options::Options;
use crate::table::Table;
use crate::text::Text;

/// A log as a table, and what is known of it before anybody looks at its columns.
pub(crate) struct Opened<'a> {
    pub(crate) table: Table,
    /// What a complaint may quote, if the table was read from one text.
    pub(crate) text: Option<Text<'a>>,
    /// What wrote it, if that is known.
    pub(crate) format: Option<Format>,
    /// What the format's reader tells.
    pub(crate) notes: Vec<String>,
}

/// Opens a log, whatever it is.
///
/// # Errors
/// What was expected and what was found.
pub(crate) fn open<'a>(bytes: &'a [u8], options: &Options) -> Result<Opened<'a>, Error> {
    let Some(format) = recognise(bytes) else { return open_text(bytes, options) };
    let other = options.format.filter(|&said| said != format);
    if let Some(said) = other {
        return Err(Error::options(format!("expected {said} as --format says, found {format}")));
    }
    let Decoded { table, notes } = match format {
        Format::Px4 => px4::read(bytes, options)?,
        _ if ardupilot::is_it(bytes) => ardupilot::read(bytes, options)?,
        _ => ardupilot_text::read(bytes, options)?,
    };
    Ok(Opened { table, text: None, format: Some(format), notes })
}

/// What a reader makes of a file.
struct Decoded {
    table: Table,
    /// What it tells beside the units.
    notes: Vec<String>,
}

/// The format that the first bytes tell.
fn recognise(bytes: &[u8]) -> Option<Format> {
    match bytes {
        _ if px4::is_it(bytes) => Some(Format::Px4),
        _ if ardupilot::is_it(bytes) || ardupilot_text::is_it(bytes) => Some(Format::ArduPilot),
        _ => None,
    }
}

fn open_text<'a>(bytes: &'a [u8], options: &Options) -> Result<Opened<'a>, Error> {
    if let Some(said) = options.format.filter(|said| said.is_container()) {
        return Err(Error::options(format!(
            "expected {said} as --format says, found another file"
        )));
    }
    let text = Text::new(bytes)?;
    let table = Table::read(&text)?;
    if options.topic.is_some() {
        let problem = "expected a file of several sensors for --topic, found one table of text";
        return Err(Error::options(problem));
    }
    let format = options.format.or_else(|| Format::of(&table));
    Ok(Opened { table, text: Some(text), format, notes: Vec::new() })
}
