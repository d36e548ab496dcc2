//! Logs of `ArduPilot` as text (`.log`), as ground stations write them: one message a line, its name and fields
//! separated by commas, after `FMT` lines that define the labels. Their contents are those of the binary logs.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use super::dataflash::Gather;
use crate::damage::Fault;
use crate::error::Error;
use crate::text::Text;

/// The number of bytes at the beginning within which the first `FMT` line must start.
const BEGINNING: usize = 2000;
/// The largest number of fields of a message; a line with more is not one.
const MOST_FIELDS: usize = 100;

/// Whether a text has a line that defines the labels of messages near its beginning.
pub(super) fn is_it(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let beginning = bytes.get(..BEGINNING).unwrap_or(bytes);
    let mut lines = beginning.split(|&byte| byte == b'\n' || byte == b'\r');
    lines.any(|line| line.starts_with(b"FMT, ") || line.starts_with(b"FMT,1"))
}

/// Reads all messages.
///
/// # Errors
/// If there is no text.
pub(super) fn read<G: Gather>(bytes: &[u8], gather: &mut G) -> Result<(), Error> {
    let text = Text::new(bytes)?;
    // For each message name: the number of fields, and the layout if it is wanted.
    let mut known: BTreeMap<Vec<u8>, (usize, Option<G::Layout>)> = BTreeMap::new();
    let mut torn: Option<(usize, usize)> = None;
    for line in text.lines() {
        if let Some((number, bytes)) = torn.take() {
            gather.losses().add(Fault::Torn, number, bytes);
        }
        let fields: Vec<_> = line
            .bytes
            .split(|&byte| byte == b',')
            .map(<[u8]>::trim_ascii)
            .take(MOST_FIELDS)
            .collect();
        let name = fields.first().copied().unwrap_or_default();
        let is_read = if let [b"FMT", _, _, name, _, labels @ ..] = &fields[..] {
            let words: Vec<_> =
                labels.iter().map(|label| std::str::from_utf8(label).unwrap_or("")).collect();
            if let Entry::Vacant(slot) = known.entry(name.to_vec()) {
                let layout = gather.define(&String::from_utf8_lossy(name), &words);
                slot.insert((1 + labels.len(), layout));
            }
            true
        } else if let Some((width, layout)) = known.get(name) {
            let field = |place: usize| fast_float2::parse(fields.get(place + 1)?).ok();
            let take = |layout| {
                let is_whole = fields.len() == *width;
                is_whole && gather.take(layout, line.number, &field).is_some()
            };
            layout.as_ref().is_none_or(take)
        } else {
            known.is_empty()
        };
        if is_read {
            gather.losses().read += line.bytes.len();
        } else {
            torn = Some((line.number, line.bytes.len()));
        }
    }
    if let Some((number, bytes)) = torn {
        gather.losses().add(Fault::Cut, number, bytes);
    }
    Ok(())
}
