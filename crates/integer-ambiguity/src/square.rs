//! A matrix of at most N × N with access by row and column: entries beyond are neither read nor written, so that
//! nothing can panic.

/// A square matrix, of which an upper left part may be in use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Square<const N: usize>([[f64; N]; N]);

impl<const N: usize> Square<N> {
    pub(crate) const fn zeros() -> Self {
        Self([[0.0; N]; N])
    }

    pub(crate) fn identity() -> Self {
        let mut identity = Self::zeros();
        for (index, row) in identity.0.iter_mut().enumerate() {
            if let Some(entry) = row.get_mut(index) {
                *entry = 1.0;
            }
        }
        identity
    }

    /// The entry, or zero beyond the matrix.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.0.get(row).and_then(|row| row.get(column)).copied().unwrap_or(0.0)
    }

    pub(crate) fn set(&mut self, row: usize, column: usize, value: f64) {
        if let Some(entry) = self.0.get_mut(row).and_then(|row| row.get_mut(column)) {
            *entry = value;
        }
    }

    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        self.set(row, column, self.at(row, column) + value);
    }

    /// Exchanges two entries of a row.
    pub(crate) fn exchange(&mut self, row: usize, one: usize, other: usize) {
        let (first, second) = (self.at(row, one), self.at(row, other));
        self.set(row, one, second);
        self.set(row, other, first);
    }
}
