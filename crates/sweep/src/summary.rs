//! What columns of more rows than fit into memory have in common.

use std::fmt;

use datasketches::tdigest::TDigestMut;
use xsum::{Xsum, XsumLarge};

use crate::{Error, Merge, Value, Work};

/// Accuracy of the sketch: its centroids are so many at most, and its ranks are good to about one part in as many.
const CENTROIDS: u16 = 500;

/// What the numbers of a column have in common. Sums are exact and rounded once, so in any order the same; quantiles are
/// those of a t-digest, which are approximate and depend on the order of the rows.
pub struct Summarised {
    /// Which study of the plan.
    pub study: usize,
    /// Which block.
    pub block: String,
    /// Which column.
    pub name: String,
    /// How many rows have no number there.
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

/// The numbers themselves.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Summary {
    /// How many numbers there are.
    pub count: u64,
    /// How many rows have none.
    pub missing: u64,
    /// Their mean: the exact sum, rounded, by their number.
    pub mean: f64,
    /// Their standard deviation, from exact sums of numbers and of squares.
    pub deviation: f64,
    /// The least.
    pub least: f64,
    /// The 5th, 50th and 95th percentile, approximately.
    pub approximate_percentiles: [f64; 3],
    /// The greatest.
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
        // A square and what its rounding leaves: together exact.
        let square = number * number;
        self.squares.add(square);
        self.squares.add(number.mul_add(number, -square));
        self.least = self.least.min(number);
        self.greatest = self.greatest.max(number);
        self.sketch.update(number);
    }

    /// What there is by now; none if there is no number.
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
    /// Every column of every block, row by row: in memory that does not grow with the rows.
    ///
    /// # Errors
    /// As [`Merge::rows`].
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
