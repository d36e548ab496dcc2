//! Summaries of columns with more rows than fit into memory.

use std::fmt;

use datasketches::tdigest::TDigestMut;
use xsum::{Xsum, XsumLarge};

use crate::{Error, Merge, Value, Work};

/// The accuracy of the sketch: it has at most this many centroids, and its ranks are accurate to about one part in as
/// many.
const CENTROIDS: u16 = 500;

/// The summary of a column, updated row by row. Sums are exact and rounded once, so they are the same in any order;
/// quantiles are those of a t-digest, which are approximate and depend on the order of the rows.
pub struct Summarised {
    /// The number of the study in the plan.
    pub study: usize,
    /// The name of the block.
    pub block: String,
    /// The name of the column.
    pub name: String,
    /// The number of rows without a finite number in the column.
    pub missing: u64,
    count: u64,
    sum: XsumLarge,
    squares: XsumLarge,
    least: f64,
    greatest: f64,
    sketch: TDigestMut,
}

impl fmt::Debug for Summarised {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { study, block, name, count, .. } = self;
        f.debug_struct("Summarised")
            .field("study", study)
            .field("block", block)
            .field("name", name)
            .field("count", count)
            .finish_non_exhaustive()
    }
}

/// Statistics of the numbers in a column.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Summary {
    /// The number of rows that have a finite number.
    pub count: u64,
    /// The number of rows that have none.
    pub missing: u64,
    /// The mean: the exact sum, rounded, divided by the count.
    pub mean: f64,
    /// The standard deviation, from the exact sums of the numbers and of their squares.
    pub deviation: f64,
    /// The least number.
    pub least: f64,
    /// The 5th, 50th and 95th percentile, approximately.
    pub approximate_percentiles: [f64; 3],
    /// The greatest number.
    pub greatest: f64,
}

impl Summarised {
    fn new(study: usize, block: &str, name: &str) -> Result<Self, Error> {
        let sketch = TDigestMut::new(CENTROIDS);
        let sketch = sketch.map_err(|error| Error::Refused(error.to_string()))?;
        Ok(Self {
            study,
            block: block.to_owned(),
            name: name.to_owned(),
            missing: 0,
            count: 0,
            sum: XsumLarge::new(),
            squares: XsumLarge::new(),
            least: f64::INFINITY,
            greatest: f64::NEG_INFINITY,
            sketch,
        })
    }

    fn take(&mut self, value: &Value) {
        let Some(number) = value.number().filter(|number| number.is_finite()) else {
            self.missing += 1;
            return;
        };
        self.count += 1;
        self.sum.add(number);
        // A rounded square and its rounding error: together they are exact.
        let square = number * number;
        self.squares.add(square);
        self.squares.add(number.mul_add(number, -square));
        self.least = self.least.min(number);
        self.greatest = self.greatest.max(number);
        self.sketch.update(number);
    }

    /// The statistics so far; `None` if there is no number.
    pub fn summary(&mut self) -> Option<Summary> {
        let (count, n) = (self.count, self.count as f64);
        let quantiles = self.sketch.quantiles(&[0.05, 0.5, 0.95]).ok().flatten()?;
        let (sum, squares) = (self.sum.sum(), self.squares.sum());
        let mean = sum / n;
        let variance = (squares - sum * mean) / (n - 1.0).max(1.0);
        Some(Summary {
            count,
            missing: self.missing,
            mean,
            deviation: variance.max(0.0).sqrt(),
            least: self.least,
            approximate_percentiles: quantiles.try_into().ok()?,
            greatest: self.greatest,
        })
    }
}

impl Merge {
    /// Summarises every column of every block, row by row, in memory that does not grow with the rows.
    ///
    /// # Errors
    /// Those of [`Merge::rows`].
    pub fn summary(&self, work: &Work) -> Result<Vec<Summarised>, Error> {
        let (mut columns, mut first) = (Vec::new(), Vec::new());
        for (study, block) in work.blocks() {
            first.push(columns.len());
            for column in &block.columns {
                columns.push(Summarised::new(study, &block.name, &column.name)?);
            }
        }
        self.rows(work, |row| {
            for (column, value) in columns[first[row.block]..].iter_mut().zip(row.values) {
                column.take(value);
            }
            Ok(())
        })?;
        Ok(columns)
    }
}
