//! Numbers and texts stored as differences from those of the preceding epoch.

use crate::error::Error;
use crate::fields::large_integer;
use crate::text::Line;

/// The highest order of differences in the format.
const HIGHEST_ORDER: usize = 5;
/// The largest value, in thousandths, that fits a field: ten digits before the point and three after it.
const LARGEST_VALUE: u64 = 9_999_999_999_999;

/// The state of a satellite on which the next epoch builds.
#[derive(Debug)]
pub(super) struct Satellite {
    pub(super) name: [u8; 3],
    pub(super) arcs: Vec<Option<Arc>>,
    /// The flags, two for each observation.
    pub(super) flags: Vec<u8>,
}

/// The differences of a number at the preceding epoch, from order 0 (the number itself) up.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arc {
    differences: [i64; HIGHEST_ORDER + 1],
    order: usize,
    final_order: usize,
}

impl Satellite {
    /// Advances the state by the line of the next epoch. Only observables that are `used` are followed.
    pub(super) fn step(
        &mut self,
        line: &Line<'_>,
        used: &[bool],
        compact_version: i32,
    ) -> Result<(), Error> {
        self.arcs.resize(used.len(), None);
        let mut rest = line.bytes;
        for (arc, used) in self.arcs.iter_mut().zip(used) {
            let length = rest.iter().position(|&byte| byte == b' ').unwrap_or(rest.len());
            let (field, after) = rest.split_at(length);
            rest = after.get(1..).unwrap_or_default();
            if !used {
                continue;
            }
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
            // In this version the flags of a missing observation are implicitly blank.
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
    /// Advances to the next number, by its difference.
    fn step(mut self, difference: i64) -> Self {
        self.order = (self.order + 1).min(self.final_order);
        self.differences[self.order] = difference;
        for order in (0..self.order).rev() {
            self.differences[order] =
                self.differences[order].wrapping_add(self.differences[order + 1]);
        }
        self
    }

    /// Writes the number, in thousandths, as 14 characters over blanks; returns whether it fits.
    pub(super) fn write(&self, field: &mut [u8]) -> bool {
        let thousandths = self.differences[0];
        let left = thousandths.unsigned_abs();
        if left > if thousandths < 0 { LARGEST_VALUE / 10 } else { LARGEST_VALUE } {
            return false;
        }
        let (mut whole, behind) = (left / 1000, left % 1000);
        let [hundreds, tens_and_ones] = [behind / 100, behind % 100].map(|it| PAIRS[it as usize]);
        field[10..].copy_from_slice(&[b'.', hundreds[1], tens_and_ones[0], tens_and_ones[1]]);
        let mut place = 10;
        while whole > 9 {
            place -= 2;
            field[place..place + 2].copy_from_slice(&PAIRS[(whole % 100) as usize]);
            whole /= 100;
        }
        if whole > 0 || place == 10 {
            place -= 1;
            field[place] = b'0' + whole as u8;
        }
        if thousandths < 0 {
            field[place - 1] = b'-';
        }
        true
    }
}

/// The two digits of each number below a hundred.
const PAIRS: [[u8; 2]; 100] = {
    let mut pairs = [*b"00"; 100];
    let mut number = 0;
    while number < 100 {
        pairs[number] = [b'0' + number as u8 / 10, b'0' + number as u8 % 10];
        number += 1;
    }
    pairs
};

/// Applies changes to a text: a blank leaves a character unchanged, `&` stands for a blank.
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
