//! Selects one of several numbered sensors of a kind.

use std::collections::BTreeSet;

use super::gather::{Row, Stream};
use crate::error::{Error, listed, quoted};
use crate::options::Options;

/// The sensor's number that the option `--topic` gives.
///
/// # Errors
/// If it is not a number.
pub(super) fn wanted(options: &Options) -> Result<Option<u32>, Error> {
    let Some(said) = &options.topic else { return Ok(None) };
    said.trim().parse().map(Some).map_err(|_| {
        let found = quoted(said);
        Error::options(format!("expected a sensor's number for --topic, found {found}"))
    })
}

/// The rows of the sensor with the wanted number, and the numbers of all sensors seen.
#[derive(Debug, Default)]
pub(super) struct Numbered {
    wanted: u32,
    is_said: bool,
    seen: BTreeSet<u32>,
    pub(super) stream: Stream,
}

impl Numbered {
    /// Selects the sensor that `--topic` gives, or number 0.
    ///
    /// # Errors
    /// If `--topic` is not a number.
    pub(super) fn new(options: &Options) -> Result<Self, Error> {
        let said = wanted(options)?;
        Ok(Self { wanted: said.unwrap_or(0), is_said: said.is_some(), ..Self::default() })
    }

    /// Keeps a row if it belongs to the wanted sensor.
    pub(super) fn push(&mut self, number: u32, record: usize, row: Row) {
        self.seen.insert(number);
        if number == self.wanted {
            self.stream.push(record, row);
        }
    }

    /// Whether any sensor of this kind was seen.
    pub(super) fn is_seen(&self) -> bool {
        !self.seen.is_empty()
    }

    /// A note on the selection, such as `IMU 0 of 3`; `None` if there is only one sensor.
    ///
    /// # Errors
    /// If there is no sensor with this number, but there are others.
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
