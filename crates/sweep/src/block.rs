//! What is tried again and again.

use std::fmt;
use std::ops::Range;

use rayon::prelude::*;

use crate::{Column, Error, Value};

/// What one trial gives by its number: the same number, the same answer, on any machine of a kind.
type Trial<T> = Box<dyn Fn(u64) -> Result<Vec<T>, String> + Send + Sync>;

enum Of {
    Numbers(Trial<f64>),
    Records(Trial<Value>),
}

/// Whether what is there is enough.
type Enough = Box<dyn Fn(&Samples) -> bool + Send + Sync>;

/// Trials of one kind: each gives a row of the same columns.
pub struct Block {
    /// Its name among the blocks of a study.
    pub name: String,
    /// What a row holds.
    pub columns: Vec<Column>,
    /// How many trials there are, at most.
    pub trials: u64,
    of: Of,
    enough: Option<(u64, Enough)>,
}

impl fmt::Debug for Block {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, columns, trials, .. } = self;
        f.debug_struct("Block")
            .field("name", name)
            .field("columns", columns)
            .field("trials", trials)
            .finish_non_exhaustive()
    }
}

impl Block {
    /// Trials that give numbers, in the order of the columns; what is not a number is missing.
    pub fn new(
        name: impl Into<String>,
        columns: impl IntoIterator<Item = String>,
        trials: u64,
        trial: impl Fn(u64) -> Result<Vec<f64>, String> + Send + Sync + 'static,
    ) -> Self {
        let columns = columns.into_iter().map(Column::number).collect();
        let of = Of::Numbers(Box::new(trial));
        Self { name: name.into(), columns, trials, of, enough: None }
    }

    /// Trials that give texts as well.
    pub fn of_records(
        name: impl Into<String>,
        columns: Vec<Column>,
        trials: u64,
        trial: impl Fn(u64) -> Result<Vec<Value>, String> + Send + Sync + 'static,
    ) -> Self {
        let of = Of::Records(Box::new(trial));
        Self { name: name.into(), columns, trials, of, enough: None }
    }

    /// Trials beyond those that are enough do not count; it is asked after each portion of so many.
    #[must_use]
    pub fn until(
        mut self,
        portion: u64,
        enough: impl Fn(&Samples) -> bool + Send + Sync + 'static,
    ) -> Self {
        self.enough = Some((portion.max(1), Box::new(enough)));
        self
    }

    /// The row of a trial.
    ///
    /// # Errors
    /// Why there is none, in one sentence.
    pub fn row(&self, index: u64) -> Result<Vec<Value>, String> {
        match &self.of {
            Of::Numbers(trial) => Ok(trial(index)?.into_iter().map(Value::from).collect()),
            Of::Records(trial) => trial(index),
        }
    }

    /// Numbers of trials, on all threads, in order. Texts that are no numbers are missing.
    fn numbers(&self, range: Range<u64>, done: &(dyn Fn() + Sync)) -> Result<Vec<f64>, Error> {
        let rows: Result<Vec<_>, _> = range
            .into_par_iter()
            .map(|index| {
                let row = match &self.of {
                    Of::Numbers(trial) => trial(index),
                    Of::Records(trial) => trial(index)
                        .map(|row| row.iter().map(|it| it.number().unwrap_or(f64::NAN)).collect()),
                };
                done();
                row
            })
            .collect();
        Ok(rows.map_err(Error::Refused)?.concat())
    }

    /// All trials that count, `done` after each.
    ///
    /// # Errors
    /// [`Error::Refused`] with the sentence of a trial that gives nothing.
    pub fn run(&self, done: &(dyn Fn() + Sync)) -> Result<Samples, Error> {
        let mut samples = Samples::new(self.columns.len());
        let portion = self.enough.as_ref().map_or(self.trials, |(portion, _)| *portion);
        let mut next = 0;
        while next < self.trials {
            let end = next.saturating_add(portion).min(self.trials);
            samples.values.extend(self.numbers(next..end, done)?);
            next = end;
            if self.enough.as_ref().is_some_and(|(_, enough)| enough(&samples)) {
                break;
            }
        }
        Ok(samples)
    }

    /// Of all its trials, those that count.
    pub fn counted(&self, mut samples: Samples) -> Samples {
        let Some((portion, enough)) = &self.enough else { return samples };
        let mut counted = Samples::new(samples.width);
        let values = *portion as usize * samples.width;
        while !samples.values.is_empty() {
            let rest = samples.values.split_off(values.min(samples.values.len()));
            counted.values.append(&mut samples.values);
            samples.values = rest;
            if enough(&counted) {
                break;
            }
        }
        counted
    }
}

/// Numbers of the trials of a block, in the order of the trials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    width: usize,
    values: Vec<f64>,
}

impl Samples {
    /// None yet, with so many numbers a trial.
    pub fn new(width: usize) -> Self {
        Self { width: width.max(1), values: Vec::new() }
    }

    /// With the row of the next trial.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        self.values.extend(row);
    }

    /// How many trials.
    pub fn len(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The row of each trial.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.width.max(1))
    }

    /// A number of each trial.
    pub fn column(&self, column: usize) -> Vec<f64> {
        self.rows().filter_map(|row| row.get(column).copied()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(trials: u64) -> Block {
        let columns = ["number", "square"].map(str::to_owned);
        Block::new("squares", columns, trials, |index| {
            Ok(vec![index as f64, (index * index) as f64])
        })
    }

    #[test]
    fn rows_are_in_the_order_of_the_trials() {
        let samples = squares(1000).run(&|| ()).unwrap();
        assert_eq!(samples.len(), 1000);
        let expected: Vec<_> = (0..1000).map(|index| f64::from(index * index)).collect();
        assert_eq!(samples.column(1), expected);
    }

    #[test]
    fn what_is_beyond_enough_does_not_count() {
        for (trials, counted) in [(100, 30), (25, 25), (5, 5), (0, 0)] {
            let block = squares(trials).until(10, |samples| samples.len() > 20);
            let samples = block.run(&|| ()).unwrap();
            assert_eq!(samples.len(), counted);
            assert_eq!(block.counted(squares(trials).run(&|| ()).unwrap()), samples);
        }
    }

    #[test]
    fn a_trial_that_gives_nothing_says_why() {
        let block = Block::new("odd", ["n".to_owned()], 9, |index| match index {
            7 => Err("trial 7 gives nothing".to_owned()),
            _ => Ok(vec![0.0]),
        });
        assert_eq!(block.run(&|| ()).unwrap_err().to_string(), "trial 7 gives nothing");
    }
}
