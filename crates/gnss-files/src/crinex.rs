//! Hatanaka compression of observations: CRINEX 1.0 and 3.0.
//!
//! Each line is stored as its changes since the epoch before: texts character by character, numbers as differences of
//! some order since an arc began. Each observable of a satellite has an arc of its own, so the arcs of unused
//! observables need not be followed.

mod arcs;
mod systems;

use self::arcs::{Satellite, repair};
use self::systems::Systems;
use crate::error::Error;
use crate::fields::integer;
use crate::text::{Line, Lines, Text};

/// Upper limit on the number of satellites or observables: no file has so many.
const MOST: usize = 999;

/// The number of observables in a line of RINEX 2.
const IN_A_LINE: usize = 5;

/// The line that replaces an epoch that was cut off.
const CUT: &[u8] = b"> cut off";

/// Whether a text is in Compact RINEX.
pub(crate) fn is_compressed(bytes: &[u8]) -> bool {
    bytes.get(60..).is_some_and(|label| label.starts_with(b"CRINEX VERS"))
}

/// Restores the RINEX file. Whatever this crate does not need is blank: the receiver's clock offsets, flags without an
/// observation, and observables other than the codes and phases that can be used. An epoch that was cut off at the end
/// of the file is only marked.
///
/// # Errors
/// The line of the compressed file, and what was expected there.
pub(crate) fn decompress(text: &Text, largest: usize) -> Result<Vec<u8>, Error> {
    let mut lines = text.lines();
    let mut decoder = Decoder::default();
    if let Some(first) = lines.next() {
        decoder.compact_version = match first.columns(0, 20) {
            b"1.0" => 1,
            b"3.0" => 3,
            _ => return Err(first.expected("version 1.0 or 3.0 of compressed observations")),
        };
    }
    lines.next();
    let first = lines.expect("a header")?;
    decoder.version = match first.finite("a version of RINEX", 0, 9)? {
        version if (2.0..5.0).contains(&version) => version as i32,
        _ => return Err(first.expected("RINEX 2, 3 or 4")),
    };
    decoder.copy(&first)?;
    loop {
        let line = lines.expect("the end of the header")?;
        decoder.copy(&line)?;
        if line.label() == b"END OF HEADER" {
            break;
        }
    }
    while let Some(line) = lines.next() {
        let before = decoder.out.len();
        let result = decoder.epoch(&line, &mut lines);
        let at_end = lines.is_at_end();
        if at_end && (result.is_err() || !text.ends_with_line_break()) {
            // The mark replaces this epoch; the reader of the observations reports it.
            decoder.out.truncate(before);
            decoder.out.extend_from_slice(CUT);
            break;
        }
        result?;
        if decoder.out.len() > largest {
            return Err(text.error("unpacks to more than any file of observations needs"));
        }
    }
    Ok(decoder.out)
}

#[derive(Debug, Default)]
struct Decoder {
    compact_version: i32,
    version: i32,
    systems: Systems,
    /// The line of the preceding epoch.
    epoch: Vec<u8>,
    satellites: Vec<Satellite>,
    out: Vec<u8>,
}

impl Decoder {
    /// Copies a header line, and notes the observables it declares.
    fn copy(&mut self, line: &Line<'_>) -> Result<(), Error> {
        self.put(line.bytes);
        self.systems.take(line, self.version)
    }

    fn put(&mut self, line: &[u8]) {
        self.out.extend_from_slice(line);
        end_line(&mut self.out);
    }

    /// Unpacks the epoch or event that begins with `line`.
    fn epoch<'a>(&mut self, line: &Line<'a>, lines: &mut Lines<'a>) -> Result<(), Error> {
        let old = self.version < 3;
        let (mark, flag, list) = if old { (b'&', 28, 32) } else { (b'>', 31, 41) };
        match line.bytes.first() {
            // Lines to be ignored, and the end-of-file character of DOS.
            Some(b'&') if !old => return Ok(()),
            Some(0x1a) => return Ok(()),
            Some(&first) if first == mark => {
                self.epoch.clear();
                self.satellites.clear();
            }
            _ if self.epoch.is_empty() => {
                return Err(line.expected("an epoch that does not build upon another"));
            }
            _ => {}
        }
        repair(&mut self.epoch, line.bytes);
        if old && let Some(first) = self.epoch.first_mut() {
            *first = b' ';
        }
        let columns = |from, to| self.epoch.get(from..to).unwrap_or_default().trim_ascii();
        let count =
            integer(columns(flag + 1, flag + 4)).and_then(|count| usize::try_from(count).ok());
        let count = count.filter(|&count| count <= MOST);
        let count = count.ok_or_else(|| line.expected("how many satellites or lines follow"))?;
        if !matches!(columns(flag, flag + 1), b"" | b"0" | b"1") {
            // An event: the epoch after it starts anew.
            let epoch = std::mem::take(&mut self.epoch);
            self.put(&epoch);
            for _ in 0..count {
                self.copy(&lines.expect("a line of an event")?)?;
            }
            return Ok(());
        }
        self.put_epoch(list, count, line)?;
        lines.expect("the receiver's clock offset")?;
        let mut before = std::mem::take(&mut self.satellites);
        for i in 0..count {
            let name: [u8; 3] = self.epoch[list + 3 * i..][..3].try_into().unwrap_or_default();
            let line = lines.expect("a satellite's observations")?;
            let system = self.systems.of(if old { 0 } else { name[0] });
            let used =
                system.ok_or_else(|| line.error("expected a satellite system of the header"))?;
            if !used.contains(&true) || (old && !matches!(name[0], b'G' | b' ')) {
                // The content is not looked at, but a missing line is detected.
                if matches!(line.column(0), b'>' | b'&') {
                    return Err(line.expected("a satellite's observations"));
                }
                self.put_blank(name, used.len());
                continue;
            }
            let known = before.iter().position(|satellite| satellite.name == name);
            let mut satellite = match known {
                Some(place) => before.swap_remove(place),
                None => Satellite { name, arcs: Vec::new(), flags: Vec::new() },
            };
            satellite.step(&line, used, self.compact_version)?;
            self.put_satellite(&satellite, &line)?;
            self.satellites.push(satellite);
        }
        Ok(())
    }

    /// Writes the line of an epoch, or in RINEX 2 lines of twelve satellites each, and checks that all satellites are
    /// listed.
    fn put_epoch(&mut self, list: usize, count: usize, line: &Line<'_>) -> Result<(), Error> {
        // Trailing blanks may have been cut off.
        let last = self.epoch.iter().rposition(|&byte| byte != b' ').unwrap_or_default();
        let end = list + 3 * count;
        if last >= end || (count > 0 && last + 3 < end) {
            return Err(line.error(format!("expected a list of {count} satellites")));
        }
        self.epoch.resize(end, b' ');
        let first = if self.version < 3 { self.epoch.len().min(list + 36) } else { list };
        self.out.extend_from_slice(&self.epoch[..first]);
        end_line(&mut self.out);
        if self.version < 3 {
            for names in self.epoch[first..].chunks(36) {
                self.out.resize(self.out.len() + list, b' ');
                self.out.extend_from_slice(names);
                end_line(&mut self.out);
            }
        }
        Ok(())
    }

    /// Writes the lines of a satellite with blanks in place of its `observables`.
    fn put_blank(&mut self, name: [u8; 3], observables: usize) {
        if self.version >= 3 {
            self.out.extend_from_slice(&name);
        }
        end_line(&mut self.out);
        if self.version < 3 {
            self.out.extend((0..observables.saturating_sub(1) / IN_A_LINE).map(|_| b'\n'));
        }
    }

    fn put_satellite(&mut self, satellite: &Satellite, line: &Line<'_>) -> Result<(), Error> {
        let in_a_line = if self.version < 3 { IN_A_LINE } else { usize::MAX };
        if self.version >= 3 {
            self.out.extend_from_slice(&satellite.name);
        }
        for (i, (arc, flags)) in
            satellite.arcs.iter().zip(satellite.flags.as_chunks::<2>().0).enumerate()
        {
            if i > 0 && i % in_a_line == 0 {
                end_line(&mut self.out);
            }
            let begin = self.out.len();
            self.out.resize(begin + 16, b' ');
            if let Some(arc) = arc {
                let (field, flags_of_it) = self.out[begin..].split_at_mut(14);
                if !arc.write(field) {
                    return Err(line.error("expected observations of at most 14 characters"));
                }
                flags_of_it.copy_from_slice(flags);
            }
        }
        end_line(&mut self.out);
        Ok(())
    }
}

fn end_line(out: &mut Vec<u8>) {
    while out.last() == Some(&b' ') {
        out.pop();
    }
    out.push(b'\n');
}

#[cfg(test)]
mod tests;
