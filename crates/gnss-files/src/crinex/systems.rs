//! The observables of each satellite system, and which of them are used.

use super::MOST;
use crate::error::Error;
use crate::fields::blank_separated;
use crate::observations::Signal;
use crate::text::Line;

/// The observables of each satellite system, by its letter; in RINEX 2 those of all systems, by letter 0.
#[derive(Debug, Default)]
pub(super) struct Systems(Vec<System>);

#[derive(Debug)]
struct System {
    letter: u8,
    /// The number of observables named so far.
    named: usize,
    /// Whether each observable is used.
    used: Vec<bool>,
}

impl Systems {
    /// Takes note of a header line of a version of RINEX.
    ///
    /// # Errors
    /// [`Error::Line`] if it announces more observables than a file can have.
    pub(super) fn take(&mut self, line: &Line<'_>, version: i32) -> Result<(), Error> {
        let (letter, from, to) = match line.label() {
            b"# / TYPES OF OBSERV" if version < 3 => (0, 0, 6),
            b"SYS / # / OBS TYPES" if version >= 3 => (line.column(0), 3, 6),
            _ => return Ok(()),
        };
        // A continuation line names no system, or in RINEX 2 has no number.
        if letter != b' ' && !line.columns(from, to).is_empty() {
            let count = line.count("how many observables there are", from, to)?;
            if count > MOST {
                return Err(line.expected("a possible number of observables"));
            }
            self.0.retain(|system| system.letter != letter);
            self.0.push(System { letter, named: 0, used: vec![false; count] });
        }
        if let Some(system) = self.0.last_mut() {
            blank_separated(line.columns(6, 60)).for_each(|code| system.name(code));
        }
        Ok(())
    }

    /// Whether each observable of a system is used; `None` if the header does not list the system.
    pub(super) fn of(&self, letter: u8) -> Option<&[bool]> {
        self.0.iter().find(|system| system.letter == letter).map(|system| &*system.used)
    }
}

impl System {
    fn name(&mut self, code: &[u8]) {
        // The observables of RINEX 2 are taken as those of GPS.
        let letter = if self.letter == 0 { b'G' } else { self.letter };
        if let Some(used) = self.used.get_mut(self.named) {
            *used = Signal::new(letter, code).is_some();
        }
        self.named += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{header, text};

    #[test]
    fn a_list_goes_on_even_if_its_number_stands_there_again() {
        let types = |list: &str| header(list, "SYS / # / OBS TYPES");
        let file = text(types("G    4 C1C D1C L1C") + &types("     4 C2W"));
        let mut systems = Systems::default();
        for line in file.lines() {
            systems.take(&line, 3).unwrap();
        }
        assert_eq!(systems.of(b'G'), Some(&[true, false, true, true][..]));
    }
}
