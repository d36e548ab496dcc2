//! Second part of LAMBDA: the search for the nearest integer vectors.

use heapless::Vec;

use crate::{Decorrelated, Error};

/// Limit on the integers tried by the search: for well-known ambiguities it tries a few for each.
const MOST: usize = 10_000;

/// The integer vector nearest to the ambiguities in the metric of their covariance, and its distance.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Fix<const N: usize> {
    /// The integers, in the order of the ambiguities.
    pub integers: Vec<i64, N>,
    /// Squared distances (a − z)ᵀ Q⁻¹ (a − z) of the nearest and the second nearest vector.
    pub distances: [f64; 2],
}

impl<const N: usize> Fix<N> {
    /// Squared distance of the second nearest vector over that of the nearest; infinite if the nearest is exact.
    ///
    /// The ratio test requires at least 2 to 3.
    pub fn ratio(&self) -> f64 {
        let [nearest, second] = self.distances;
        if nearest > 0.0 { second / nearest } else { f64::INFINITY }
    }
}

/// One level of the search, for one ambiguity.
#[derive(Clone, Copy, Debug)]
struct Level {
    /// Expected value of the ambiguity, given the integers after it.
    expected: f64,
    integer: f64,
    /// Step to the next integer: they are tried from the nearest on, alternating between the sides.
    step: f64,
    /// Squared distance due to the integers after this one.
    before: f64,
}

impl Level {
    fn new(expected: f64, before: f64) -> Self {
        let integer = libm::round(expected);
        Self { expected, integer, step: libm::copysign(1.0, expected - integer), before }
    }

    /// Squared distance including that of the current integer.
    fn distance(&self, variance: f64) -> f64 {
        let off = self.expected - self.integer;
        self.before + off * off / variance
    }

    fn next(&mut self) {
        self.integer += self.step;
        self.step = -self.step - libm::copysign(1.0, self.step);
    }
}

impl<const N: usize> Decorrelated<N> {
    /// Finds the nearest integer vector, by a search in shrinking ellipsoids (Chang, Yang and Zhou 2005).
    ///
    /// # Errors
    /// [`Error::Exhausted`] if the ambiguities are known so poorly that too many integers would have to be tried.
    pub fn nearest(&self) -> Result<Fix<N>, Error> {
        let number = self.len();
        let mut levels: Vec<Level, N> = Vec::new();
        for _ in 0..number {
            levels.push(Level::new(0.0, 0.0)).map_err(|_| Error::WrongNumber)?;
        }
        let mut best: [(f64, Vec<f64, N>); 2] =
            [(f64::INFINITY, Vec::new()), (f64::INFINITY, Vec::new())];
        let mut at = number.checked_sub(1).ok_or(Error::WrongNumber)?;
        self.enter(&mut levels, at, 0.0);
        for _ in 0..MOST {
            let Some(level) = levels.get_mut(at) else { break };
            let distance = level.distance(self.variances.get(at).copied().unwrap_or(1.0));
            let [nearest, second] = &mut best;
            if distance < second.0 {
                if let Some(next) = at.checked_sub(1) {
                    at = next;
                    self.enter(&mut levels, at, distance);
                } else {
                    let mut found = Vec::new();
                    for level in &levels {
                        found.push(level.integer).map_err(|_| Error::WrongNumber)?;
                    }
                    *second = (distance, found);
                    if second.0 < nearest.0 {
                        core::mem::swap(nearest, second);
                    }
                    if let Some(level) = levels.first_mut() {
                        level.next();
                    }
                }
            } else {
                at += 1;
                let Some(level) = levels.get_mut(at) else {
                    let [(nearest, integers), (second, _)] = &best;
                    let (integers, distances) = (self.original(integers), [*nearest, *second]);
                    return Ok(Fix { integers, distances });
                };
                level.next();
            }
        }
        Err(Error::Exhausted)
    }

    /// Enters a level, given the integers chosen after it.
    fn enter(&self, levels: &mut Vec<Level, N>, at: usize, before: f64) {
        let mut expected = self.float.get(at).copied().unwrap_or(0.0);
        for (after, level) in levels.iter().enumerate().skip(at + 1) {
            expected += (level.integer - level.expected) * self.lower.at(after, at);
        }
        if let Some(level) = levels.get_mut(at) {
            *level = Level::new(expected, before);
        }
    }
}
