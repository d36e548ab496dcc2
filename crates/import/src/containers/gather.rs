//! The data that a reader collects from a file: rows of numbers, and stretches that cannot be read.

use crate::damage::{Damage, Fault};
use crate::formats::Description;
use crate::part::Part;
use crate::table::Table;

/// Time, three axes of the accelerometer, and three of the gyroscope, in the units of the file.
pub(super) type Row = [f64; 7];

/// The rows of one sensor, with the record of each.
#[derive(Debug, Default)]
pub(super) struct Stream {
    pub(super) columns: [Vec<f64>; 7],
    pub(super) records: Vec<usize>,
}

impl Stream {
    pub(super) fn push(&mut self, record: usize, row: Row) {
        for (column, value) in self.columns.iter_mut().zip(row) {
            column.push(value);
        }
        self.records.push(record);
    }

    /// The numbers of a row; NaN beyond the last one.
    pub(super) fn row(&self, place: usize) -> Row {
        self.columns.each_ref().map(|column| column.get(place).copied().unwrap_or(f64::NAN))
    }

    pub(super) fn len(&self) -> usize {
        self.records.len()
    }

    /// A table with the column names of a format, and with the losses as its damage.
    pub(super) fn table(
        self,
        known: &Description,
        time: &str,
        losses: &Losses,
        part: Part,
    ) -> Table {
        let damage = losses.damage(part, self.len());
        self.named(known, time, damage)
    }

    /// A table with the column names of a format.
    pub(super) fn named(self, known: &Description, time: &str, damage: Damage) -> Table {
        let names = std::iter::once(time).chain(known.sensors).map(str::to_owned);
        Table::decoded(names.zip(self.columns), self.records, damage)
    }
}

/// The number of bytes that were read, and the stretches that could not be.
#[derive(Debug, Default)]
pub(crate) struct Losses {
    /// The number of bytes that could be read.
    pub(super) read: usize,
    stretches: Vec<(Fault, usize, usize)>,
}

impl Losses {
    /// Adds a stretch of `bytes` bytes that could not be read.
    pub(super) fn add(&mut self, fault: Fault, record: usize, bytes: usize) {
        self.stretches.push((fault, record, bytes));
    }

    /// The losses as damage of a sensor with `rows` rows: each stretch counts as the number of rows that it would have
    /// held, at least one.
    pub(crate) fn damage(&self, part: Part, rows: usize) -> Damage {
        let mut damage = Damage::of(part);
        let density = rows as f64 / self.read.max(1) as f64;
        for &(fault, record, bytes) in &self.stretches {
            let count = (bytes as f64 * density).ceil().max(1.0) as usize;
            damage.add_some(fault, record, count, || {
                let noun = part.noun(1);
                match (fault, bytes) {
                    (Fault::Cut, _) => {
                        format!("expected a whole {noun}, found the end of the file")
                    }
                    (_, 0) => format!("expected a {noun} of the format, found one that is none"),
                    _ => format!(
                        "expected a {noun} of the format, found {bytes} bytes that are none"
                    ),
                }
            });
        }
        damage
    }
}
