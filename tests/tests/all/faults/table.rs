//! A table of numbers, to put faults into.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// A CSV file: a header, and fields that may be empty or contain words.
#[derive(Clone)]
pub(super) struct Table {
    pub(super) header: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
}

impl Table {
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path).with_context(|| path.display().to_string())?;
        let fields =
            |line: &str| line.split(',').map(|it| it.trim().to_owned()).collect::<Vec<_>>();
        let mut lines = text.lines().filter(|line| !line.is_empty()).map(fields);
        Ok(Self { header: lines.next().context("a header")?, rows: lines.collect() })
    }

    pub(super) fn write(&self, folder: &Path, name: &str) -> Result<PathBuf> {
        let mut text = self.header.join(",");
        for row in &self.rows {
            write!(text, "\n{}", row.join(","))?;
        }
        let path = folder.join(name);
        fs::write(&path, text + "\n")?;
        Ok(path)
    }

    /// The index of a column.
    pub(super) fn column(&self, name: &str) -> usize {
        self.header.iter().position(|it| it == name).unwrap_or_else(|| panic!("no column {name}"))
    }

    pub(super) fn number(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column].parse().unwrap_or(f64::NAN)
    }

    /// Changes the numbers of these columns, by row and value.
    pub(super) fn map(&mut self, columns: &[&str], mut with: impl FnMut(usize, f64) -> f64) {
        for name in columns {
            let column = self.column(name);
            for row in 0..self.rows.len() {
                let value = self.number(row, column);
                if value.is_finite() {
                    self.rows[row][column] = format!("{:.9}", with(row, value));
                }
            }
        }
    }

    /// Changes the numbers of these columns from a row on, given as a share of all rows.
    pub(super) fn map_from(&mut self, share: f64, columns: &[&str], with: impl Fn(f64) -> f64) {
        let from = (share * self.rows.len() as f64) as usize;
        self.map(columns, |row, value| if row < from { value } else { with(value) });
    }

    /// The largest magnitude of the numbers in these columns.
    pub(super) fn largest(&self, columns: &[&str]) -> f64 {
        let column = |name: &&str| {
            let column = self.column(name);
            (0..self.rows.len()).map(|row| self.number(row, column).abs()).fold(0.0, f64::max)
        };
        columns.iter().map(column).fold(0.0, f64::max)
    }

    /// The first and last time, s.
    pub(super) fn span(&self) -> [f64; 2] {
        let t = self.column("t");
        [self.number(0, t), self.number(self.rows.len() - 1, t)]
    }

    /// Selects the rows within `length` seconds after the middle.
    pub(super) fn after_the_middle(&self, length: f64) -> impl Fn(&Self, usize) -> bool + use<> {
        let [from, to] = self.span();
        let (middle, t) = (f64::midpoint(from, to), self.column("t"));
        move |table, row| (middle..middle + length).contains(&table.number(row, t))
    }

    /// Removes the rows within `length` seconds after the middle.
    pub(super) fn drop_out(&mut self, length: f64) {
        let is_lost = self.after_the_middle(length);
        let before = self.clone();
        let kept = (0..before.rows.len()).filter(|&row| !is_lost(&before, row));
        self.rows = kept.map(|row| before.rows[row].clone()).collect();
    }

    /// Delays the values of these columns by `rows` rows.
    pub(super) fn late(&mut self, columns: &[&str], rows: usize) {
        let before = self.clone();
        for name in columns {
            let column = self.column(name);
            for row in rows..self.rows.len() {
                self.rows[row][column].clone_from(&before.rows[row - rows][column]);
            }
        }
    }

    /// Repeats every row.
    pub(super) fn duplicate(&mut self) {
        self.rows = self.rows.iter().flat_map(|row| [row.clone(), row.clone()]).collect();
    }

    /// Swaps neighbouring rows, pair by pair.
    pub(super) fn reorder(&mut self) {
        self.rows.chunks_exact_mut(2).for_each(<[_]>::reverse);
    }

    /// Swaps the names of two columns.
    pub(super) fn swap(&mut self, a: &str, b: &str) {
        let (a, b) = (self.column(a), self.column(b));
        self.header.swap(a, b);
    }
}

/// Selects one in `many` rows, spread without a pattern: a multiplicative hash of the row.
pub(super) fn one_in(many: usize, row: usize) -> bool {
    (row.wrapping_mul(2_654_435_761) >> 7).is_multiple_of(many)
}
