//! First part of LAMBDA: ambiguities that are correlated as little as integer transformations allow.

use heapless::Vec;

use crate::Error;
use crate::square::Square;

/// Magnitude beyond which a double does not resolve the fraction of an ambiguity.
const LARGEST: f64 = 1e15;
/// Factor by which an exchange must reduce the variance; without it, rounding could cause exchanges without end.
const GAIN: f64 = 1.0 + 1e-9;
/// Limit on the exchanges, times the number of ambiguities squared: beyond it, the search is merely slower.
const EXCHANGES: usize = 64;

/// Real-valued ambiguities after the Z-transformation (Teunissen 1995).
///
/// They are z = Zᵀa with the covariance Zᵀ Q Z = Lᵀ D L, where Z and its inverse hold integers. L is nearly a unit
/// matrix, and the variances D, of each ambiguity given those after it, are nearly alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Decorrelated<const N: usize> {
    /// z, computed from a without its whole parts.
    pub(crate) float: Vec<f64, N>,
    /// Whole parts that were subtracted from a.
    whole: Vec<f64, N>,
    /// L, unit lower triangular.
    pub(crate) lower: Square<N>,
    /// D, the conditional variances.
    pub(crate) variances: Vec<f64, N>,
    /// Z⁻ᵀ, which transforms z back to a.
    back: Square<N>,
}

impl<const N: usize> Decorrelated<N> {
    /// Decorrelates ambiguities (cycles). `covariance` returns the covariance (cycles²) of the ambiguities with two
    /// indices, and is called with the first index not below the second.
    ///
    /// # Errors
    /// [`Error::WrongNumber`], [`Error::NotFinite`], [`Error::NotPositive`].
    pub fn new(
        ambiguities: &[f64],
        covariance: impl Fn(usize, usize) -> f64,
    ) -> Result<Self, Error> {
        let number = ambiguities.len();
        if number == 0 || number > N {
            return Err(Error::WrongNumber);
        }
        if !ambiguities.iter().all(|ambiguity| ambiguity.abs() < LARGEST) {
            return Err(Error::NotFinite);
        }
        let (mut float, mut whole) = (Vec::new(), Vec::new());
        for &ambiguity in ambiguities {
            let near = libm::round(ambiguity);
            let pushed = whole.push(near).is_ok() && float.push(ambiguity - near).is_ok();
            if !pushed {
                return Err(Error::WrongNumber);
            }
        }
        let (lower, variances) = factors(number, covariance)?;
        let back = Square::identity();
        let mut decorrelated = Self { float, whole, lower, variances, back };
        decorrelated.reduce();
        Ok(decorrelated)
    }

    /// The number of ambiguities.
    pub fn len(&self) -> usize {
        self.float.len()
    }

    /// Always false: see [`Self::new`].
    pub fn is_empty(&self) -> bool {
        self.float.is_empty()
    }

    /// The probability ∏ (2Φ(1/2σ) − 1) that rounding one ambiguity after the other, each given those before
    /// (bootstrapping), finds the right integers.
    ///
    /// The search finds them at least as often (Teunissen 1999). It is only as true as the covariance.
    pub fn success_rate(&self) -> f64 {
        let of = |variance: &f64| libm::erf(0.5 / libm::sqrt(2.0 * variance));
        self.variances.iter().map(of).product()
    }

    /// The original ambiguities for a vector of decorrelated ones.
    pub(crate) fn original(&self, decorrelated: &[f64]) -> Vec<i64, N> {
        let mut original = Vec::new();
        for (row, whole) in self.whole.iter().enumerate() {
            let terms = decorrelated.iter().enumerate();
            let sum: f64 = terms.map(|(column, z)| self.back.at(row, column) * z).sum();
            if original.push(libm::round(whole + sum) as i64).is_err() {
                break;
            }
        }
        original
    }

    fn variance(&self, index: usize) -> f64 {
        self.variances.get(index).copied().unwrap_or(0.0)
    }

    /// Makes L small by integer Gauss transformations, and moves the best-known ambiguities to the end by exchanges
    /// (Teunissen 1995, as laid out by Chang, Yang and Zhou 2005).
    fn reduce(&mut self) {
        let number = self.len();
        let Some(last) = number.checked_sub(2) else { return };
        let (mut at, mut reduced) = (last, last);
        let mut exchanges = EXCHANGES * number * number;
        loop {
            if at <= reduced {
                for row in at + 1..number {
                    self.subtract(row, at);
                }
            }
            let lower = self.lower.at(at + 1, at);
            let exchanged = self.variance(at) + lower * lower * self.variance(at + 1);
            if exchanged * GAIN < self.variance(at + 1) && exchanges > 0 {
                self.exchange(at, exchanged);
                exchanges -= 1;
                (reduced, at) = (at, last);
            } else if let Some(next) = at.checked_sub(1) {
                at = next;
            } else {
                return;
            }
        }
    }

    /// Subtracts an integer multiple of the ambiguity `row` from the ambiguity `column`, such that L is at most one
    /// half there.
    fn subtract(&mut self, row: usize, column: usize) {
        let times = libm::round(self.lower.at(row, column));
        if times == 0.0 {
            return;
        }
        for below in row..self.len() {
            self.lower.add(below, column, -times * self.lower.at(below, row));
        }
        let off = self.float.get(row).copied().unwrap_or(0.0);
        if let Some(float) = self.float.get_mut(column) {
            *float -= times * off;
        }
        for each in 0..self.len() {
            self.back.add(each, row, times * self.back.at(each, column));
        }
    }

    /// Exchanges two neighbours; the later one then has the variance `exchanged`.
    fn exchange(&mut self, at: usize, exchanged: f64) {
        let (number, next) = (self.len(), at + 1);
        let lower = self.lower.at(next, at);
        let eta = self.variance(at) / exchanged;
        let lambda = self.variance(next) * lower / exchanged;
        let former = eta * self.variance(next);
        for (index, variance) in [(at, former), (next, exchanged)] {
            if let Some(place) = self.variances.get_mut(index) {
                *place = variance;
            }
        }
        for column in 0..at {
            let (upper, below) = (self.lower.at(at, column), self.lower.at(next, column));
            self.lower.set(at, column, below - lower * upper);
            self.lower.set(next, column, eta * upper + lambda * below);
        }
        self.lower.set(next, at, lambda);
        for row in next + 1..number {
            self.lower.exchange(row, at, next);
        }
        for row in 0..number {
            self.back.exchange(row, at, next);
        }
        if let Some([one, other]) = self.float.get_mut(at..=next) {
            core::mem::swap(one, other);
        }
    }
}

/// L and D of Q = Lᵀ D L.
fn factors<const N: usize>(
    number: usize,
    covariance: impl Fn(usize, usize) -> f64,
) -> Result<(Square<N>, Vec<f64, N>), Error> {
    let mut rest = Square::<N>::zeros();
    for row in 0..number {
        for column in 0..=row {
            let entry = covariance(row, column);
            if !entry.is_finite() {
                return Err(Error::NotFinite);
            }
            rest.set(row, column, entry);
        }
    }
    let (mut lower, mut variances) = (Square::<N>::identity(), Vec::<f64, N>::new());
    for _ in 0..number {
        // A placeholder, which is written in the loop below, from the end on.
        variances.push(0.0).map_err(|_| Error::WrongNumber)?;
    }
    for row in (0..number).rev() {
        let variance = rest.at(row, row);
        if variance.is_nan() || variance <= 0.0 {
            return Err(Error::NotPositive);
        }
        if let Some(place) = variances.get_mut(row) {
            *place = variance;
        }
        for column in 0..row {
            lower.set(row, column, rest.at(row, column) / variance);
        }
        for column in 0..row {
            for other in 0..=column {
                let share = lower.at(row, column) * lower.at(row, other) * variance;
                rest.add(column, other, -share);
            }
        }
    }
    Ok((lower, variances))
}
