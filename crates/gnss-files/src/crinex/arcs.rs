//! Numbers and texts as differences from those before.

use crate::error::Error;
use crate::fields::large_integer;
use crate::text::Line;

/// The highest order of differences in the format.
const HIGHEST_ORDER: usize = 5;
/// Ten digits before the point and three behind it fill a field.
const LARGEST_VALUE: u64 = 9_999_999_999_999;

/// State of a satellite that the next epoch builds upon.
#[derive(Debug)]
pub(super) struct Satellite {
    pub(super) name: [u8; 3],
    pub(super) arcs: Vec<Option<Arc>>,
    /// Two of each observation.
    pub(super) flags: Vec<u8>,
}

/// The differences of a number at the epoch before, from that of order 0, the number itself.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    differences: [i64; HIGHEST_ORDER + 1],
    order: usize,
    final_order: usize,
}

impl Satellite {
    /// Takes the line of the next epoch.
    pub(super) fn step(&mut self, line: &Line<'_>, compact_version: i32) -> Result<(), Error> {
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

    /// The number, thousandths, as 14 characters; none if they do not fit.
    pub(super) fn field(&self) -> Option<[u8; 14]> {
        let thousandths = self.differences[0];
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
}

/// Takes over what changed in a text: a blank changes nothing, `&` stands for a blank.
pub(super) fn repair(text: &mut Vec<u8>, changes: &[u8]) {
    let shared = text.len().min(changes.len());
    let blank = |&byte: &u8| if byte == b'&' { b' ' } else { byte };
    for (byte, change) in text.iter_mut().zip(changes) {
        if *change != b' ' {
            *byte = blank(change);
        }
    }
    text.extend(changes[shared..].iter().map(blank));
}
