//! Hatanaka compression of observations: CRINEX 1.0 and 3.0.
//!
//! Lines are stored as what changed since the epoch before: texts character by character, numbers as
//! differences of some order since an arc began.

use super::fields::{integer, large_integer};
use super::lines::{Line, Lines, Text};
use crate::Error;

/// The highest order of differences in the format.
const HIGHEST_ORDER: usize = 5;
/// More satellites or observables than any file has.
const MOST: usize = 999;
/// Ten digits before the point and three behind it fill a field.
const LARGEST_VALUE: u64 = 9_999_999_999_999;

/// Whether a text is compressed so.
pub(super) fn is_compressed(bytes: &[u8]) -> bool {
    bytes.get(60..).is_some_and(|label| label.starts_with(b"CRINEX VERS"))
}

/// The RINEX file as it was, without the receiver's clock offsets, which nothing here needs. A line cut off
/// at the end of the file is left out.
///
/// # Errors
/// The line of the compressed file, and what was expected there.
pub(super) fn decompress(text: &Text, largest: usize) -> Result<Vec<u8>, Error> {
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
        let result = decoder.epoch(&line, &mut lines);
        if lines.is_at_end() && !text.ends_with_line_break() {
            break;
        }
        match result {
            // The rest of an epoch is missing: whoever reads the observations will see it.
            Err(_) if lines.is_at_end() => break,
            result => result?,
        }
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
    /// How many observables each satellite system has, by its letter; of RINEX 2 that of letter 0.
    observables: Vec<(u8, usize)>,
    /// The line of the epoch before.
    epoch: Vec<u8>,
    satellites: Vec<Satellite>,
    out: Vec<u8>,
}

#[derive(Debug)]
struct Satellite {
    name: [u8; 3],
    arcs: Vec<Option<Arc>>,
    /// Two of each observation.
    flags: Vec<u8>,
}

/// The differences of a number at the epoch before, from that of order 0, the number itself.
#[derive(Debug, Clone, Copy)]
struct Arc {
    differences: [i64; HIGHEST_ORDER + 1],
    order: usize,
    final_order: usize,
}

impl Decoder {
    /// Copies a line of a header, and counts its observables.
    fn copy(&mut self, line: &Line<'_>) -> Result<(), Error> {
        self.put(line.bytes);
        let (system, from, to) = match line.label() {
            b"# / TYPES OF OBSERV" => (0, 0, 6),
            b"SYS / # / OBS TYPES" => (line.column(0), 3, 6),
            _ => return Ok(()),
        };
        if line.columns(from, to).is_empty() {
            return Ok(());
        }
        let count = line.count("how many observables there are", from, to)?;
        if count > MOST {
            return Err(line.expected("a possible number of observables"));
        }
        self.observables.retain(|(other, _)| *other != system);
        self.observables.push((system, count));
        Ok(())
    }

    fn put(&mut self, line: &[u8]) {
        self.out.extend_from_slice(line);
        end_line(&mut self.out);
    }

    /// Unpacks an epoch or event that begins with a line.
    fn epoch<'a>(&mut self, line: &Line<'a>, lines: &mut Lines<'a>) -> Result<(), Error> {
        let old = self.version < 3;
        let (mark, flag, list) = if old { (b'&', 28, 32) } else { (b'>', 31, 41) };
        match line.bytes.first() {
            // Lines to be ignored, and the end of a file of DOS.
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
            // An event; what follows it begins anew.
            let epoch = std::mem::take(&mut self.epoch);
            self.put(&epoch);
            for _ in 0..count {
                self.copy(&lines.expect("a line of an event")?)?;
            }
            return Ok(());
        }
        lines.expect("the receiver's clock offset")?;
        self.put_epoch(list, count, line)?;
        let mut before = std::mem::take(&mut self.satellites);
        for i in 0..count {
            let name = self.epoch[list + 3 * i..][..3].try_into().unwrap_or_default();
            let line = lines.expect("a satellite's observations")?;
            let known = before.iter().position(|satellite| satellite.name == name);
            let mut satellite = match known {
                Some(place) => before.swap_remove(place),
                None => Satellite { name, arcs: Vec::new(), flags: Vec::new() },
            };
            let system = if old { 0 } else { name[0] };
            let observables = self.observables.iter().find(|(other, _)| *other == system);
            let (_, observables) = observables
                .ok_or_else(|| line.error("expected a satellite system of the header"))?;
            satellite.arcs.resize(*observables, None);
            satellite.step(&line, self.compact_version)?;
            self.put_satellite(&satellite, &line)?;
            self.satellites.push(satellite);
        }
        Ok(())
    }

    /// Writes the line of an epoch, in RINEX 2 twelve satellites in each, and checks that they are there.
    fn put_epoch(&mut self, list: usize, count: usize, line: &Line<'_>) -> Result<(), Error> {
        // Blanks at its end may have been cut.
        let last = self.epoch.iter().rposition(|&byte| byte != b' ').unwrap_or_default();
        if last >= list + 3 * count || last + 3 < list + 3 * count {
            return Err(line.error(format!("expected a list of {count} satellites")));
        }
        self.epoch.resize(list + 3 * count, b' ');
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

    fn put_satellite(&mut self, satellite: &Satellite, line: &Line<'_>) -> Result<(), Error> {
        let in_a_line = if self.version < 3 { 5 } else { usize::MAX };
        if self.version >= 3 {
            self.out.extend_from_slice(&satellite.name);
        }
        for (i, (arc, flags)) in satellite.arcs.iter().zip(satellite.flags.chunks(2)).enumerate() {
            if i > 0 && i % in_a_line == 0 {
                end_line(&mut self.out);
            }
            let field = match arc {
                Some(arc) => field(arc.differences[0])
                    .ok_or_else(|| line.error("expected observations of at most 14 characters"))?,
                None => [b' '; 14],
            };
            self.out.extend_from_slice(&field);
            self.out.extend_from_slice(flags);
        }
        end_line(&mut self.out);
        Ok(())
    }
}

impl Satellite {
    /// Takes the line of the next epoch.
    fn step(&mut self, line: &Line<'_>, compact_version: i32) -> Result<(), Error> {
        let mut rest = line.bytes;
        for arc in &mut self.arcs {
            let length = memchr::memchr(b' ', rest).unwrap_or(rest.len());
            let field = &rest[..length];
            rest = rest.get(length + 1..).unwrap_or_default();
            *arc = match field {
                [] => None,
                [order @ b'0'..=b'5', b'&', value @ ..] => {
                    let value =
                        large_integer(value).ok_or_else(|| line.expected("whole numbers"))?;
                    let mut differences = [0; HIGHEST_ORDER + 1];
                    differences[0] = value;
                    Some(Arc { differences, order: 0, final_order: usize::from(order - b'0') })
                }
                difference => {
                    let difference = large_integer(difference)
                        .ok_or_else(|| line.expected("differences of whole numbers"))?;
                    let arc = arc.as_ref().ok_or_else(|| {
                        line.error("expected a whole observation, found the difference from one that is missing")
                    })?;
                    Some(arc.step(difference))
                }
            };
        }
        repair(&mut self.flags, rest);
        self.flags.resize(2 * self.arcs.len(), b' ');
        if compact_version == 1 {
            // There the flags of no observation are blank without saying so.
            for (arc, flags) in self.arcs.iter().zip(self.flags.chunks_mut(2)) {
                if arc.is_none() {
                    flags.fill(b' ');
                }
            }
        }
        Ok(())
    }
}

impl Arc {
    /// The next number, by its difference.
    fn step(mut self, difference: i64) -> Self {
        self.order = (self.order + 1).min(self.final_order);
        self.differences[self.order] = difference;
        for order in (0..self.order).rev() {
            self.differences[order] =
                self.differences[order].wrapping_add(self.differences[order + 1]);
        }
        self
    }
}

fn end_line(out: &mut Vec<u8>) {
    while out.last() == Some(&b' ') {
        out.pop();
    }
    out.push(b'\n');
}

/// Takes over what changed in a text: a blank changes nothing, `&` stands for a blank.
fn repair(text: &mut Vec<u8>, changes: &[u8]) {
    let shared = text.len().min(changes.len());
    let blank = |&byte: &u8| if byte == b'&' { b' ' } else { byte };
    for (byte, change) in text.iter_mut().zip(changes) {
        if *change != b' ' {
            *byte = blank(change);
        }
    }
    text.extend(changes[shared..].iter().map(blank));
}

/// Thousandths as 14 characters; none if they do not fit.
fn field(thousandths: i64) -> Option<[u8; 14]> {
    let mut field = [b' '; 14];
    let mut left = thousandths.unsigned_abs();
    if left > if thousandths < 0 { LARGEST_VALUE / 10 } else { LARGEST_VALUE } {
        return None;
    }
    let mut place = 14;
    while left > 0 || place > 9 {
        place -= 1;
        if place == 10 {
            field[place] = b'.';
        } else {
            field[place] = b'0' + (left % 10) as u8;
            left /= 10;
        }
    }
    if thousandths < 0 {
        field[place - 1] = b'-';
    }
    Some(field)
}
