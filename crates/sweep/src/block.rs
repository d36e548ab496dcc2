//! Blocks of trials, and the samples they give.

use std::fmt;
use std::ops::Range;

use rayon::prelude::*;

use crate::{Column, Error, Value};

/// The result of a trial as a function of its number: the same number gives the same answer on any machine of one kind.
type Trial<T> = Box<dyn Fn(u64) -> Result<Vec<T>, String> + Send + Sync>;

enum Of {
    Numbers(Trial<f64>),
    Records(Trial<Value>),
}

/// Whether the samples so far are enough.
type Enough = Box<dyn Fn(&Samples) -> bool + Send + Sync>;

/// Trials of one kind, each of which gives a row with the same columns.
pub struct Block {
    /// The name of the block, among those of a study.
    pub name: String,
    /// The columns of a row.
    pub columns: Vec<Column>,
    /// The number of trials, at most.
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
    /// Trials that give numbers, in the order of the columns; `NaN` is a missing value.
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

    /// Trials that give numbers and texts.
    pub fn of_records(
        name: impl Into<String>,
        columns: Vec<Column>,
        trials: u64,
        trial: impl Fn(u64) -> Result<Vec<Value>, String> + Send + Sync + 'static,
    ) -> Self {
        let of = Of::Records(Box::new(trial));
        Self { name: name.into(), columns, trials, of, enough: None }
    }

    /// Ends the block once `enough` says so: it is asked after each portion of `portion` trials, and further trials do
    /// not count.
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
    /// Why the trial gives no row, in one sentence.
    pub fn row(&self, index: u64) -> Result<Vec<Value>, String> {
        match &self.of {
            Of::Numbers(trial) => Ok(trial(index)?.into_iter().map(Value::from).collect()),
            Of::Records(trial) => trial(index),
        }
    }

    /// The numbers of a range of trials, computed on all threads, in order. Texts that are not numbers become `NaN`.
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

    /// Runs all trials that count, and calls `done` after each.
    ///
    /// # Errors
    /// [`Error::Refused`] with the sentence of a trial that fails.
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

    /// Reduces the samples of all trials to those that count.
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

/// The numbers of the trials of a block, in the order of the trials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    width: usize,
    values: Vec<f64>,
}

impl Samples {
    /// No samples yet, with `width` numbers per trial.
    pub fn new(width: usize) -> Self {
        Self { width: width.max(1), values: Vec::new() }
    }

    /// Appends the row of the next trial.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        self.values.extend(row);
    }

    /// The number of trials.
    pub fn len(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether there are no trials.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The row of each trial.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.values.chunks_exact(self.width.max(1))
    }

    /// The numbers of one column, in the order of the trials.
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
