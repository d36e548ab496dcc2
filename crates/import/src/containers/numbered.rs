//! One of several sensors of a kind that have numbers.

use std::collections::BTreeSet;

use super::gather::{Row, Stream};
use crate::error::{Error, listed, quoted};
use crate::options::Options;

/// The number that `--topic` says.
///
/// # Errors
/// If it says no number.
pub(super) fn wanted(options: &Options) -> Result<Option<u32>, Error> {
    let Some(said) = &options.topic else { return Ok(None) };
    said.trim().parse().map(Some).map_err(|_| {
        let found = quoted(said);
        Error::options(format!("expected a sensor's number for --topic, found {found}"))
    })
}

/// The rows of the sensor with the wanted number, and which others there are.
#[derive(Debug, Default)]
pub(super) struct Numbered {
    wanted: u32,
    is_said: bool,
    seen: BTreeSet<u32>,
    pub(super) stream: Stream,
}

impl Numbered {
    /// The sensor that `--topic` says, or number 0.
    ///
    /// # Errors
    /// If `--topic` says no number.
    pub(super) fn new(options: &Options) -> Result<Self, Error> {
        let said = wanted(options)?;
        Ok(Self { wanted: said.unwrap_or(0), is_said: said.is_some(), ..Self::default() })
    }

    /// Keeps a row if it is the wanted sensor's.
    pub(super) fn push(&mut self, number: u32, record: usize, row: Row) {
        self.seen.insert(number);
        if number == self.wanted {
            self.stream.push(record, row);
        }
    }

    /// Whether there is any sensor of this kind.
    pub(super) fn is_seen(&self) -> bool {
        !self.seen.is_empty()
    }

    /// Which of several it is, such as `IMU 0 of 3`; nothing of one alone.
    ///
    /// # Errors
    /// If there is none of this number, but others are.
    pub(super) fn note(&self, kind: &str) -> Result<Option<String>, Error> {
        let (wanted, count) = (self.wanted, self.seen.len());
        if self.stream.len() > 0 {
            return Ok((count > 1).then(|| format!("{kind} {wanted} of {count}")));
        }
        let numbers: Vec<_> = self.seen.iter().map(u32::to_string).collect();
        let found = listed(numbers.iter().map(String::as_str));
        let problem = format!("expected {kind} {wanted}, found {kind} {found}");
        let first = numbers.first().map_or("0", String::as_str);
        Err(if self.is_said {
            Error::options(format!("{problem} (--topic)"))
        } else {
            Error::undecided(problem, format!("--topic {first}"))
        })
    }
}
