use crate::matrix::{cross, product, unit};
use crate::normal::{Inverse, Normal, amplification, noise};
use crate::{Error, Triad, Turn};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// How much of a gyroscope was found beside its bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum GyroscopeModel {
    /// The scales of some axes: those about which it was turned.
    Scale,
    /// All scales and misalignments, those to the accelerometer included.
    Full,
}

/// What a gyroscope measures wrong, as the turns between poses show it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GyroscopeFit<T: Scalar> {
    /// Bias (rad/s), as it was assumed, and matrix.
    pub triad: Triad<T>,
    /// Which entries of the matrix were found; the others are as assumed.
    pub model: GyroscopeModel,
    /// Standard deviations of the matrix, row by row; none of what the turns do not tell.
    pub matrix_sigma: [[Option<T>; 3]; 3],
    /// How far the turns carry gravity astray: root mean square (rad).
    pub residual: T,
}

/// Entries of the matrix, column by column.
const UNKNOWNS: usize = 9;
/// So many times the noise of a turn is the most that an entry may be uncertain by: beyond, no turn tells it.
const MOST_AMPLIFICATION: f64 = 3.0;
/// A turn that carries gravity so far astray (the sine of 30°) is not this gyroscope's: swapped axes, another unit.
const MOST_ASTRAY: f64 = 0.5;
/// Beyond this a correction of the matrix is none of a gyroscope that works.
const LARGEST: f64 = 0.5;

/// A gyroscope's scales and misalignments, from turns between poses: the turn must carry gravity's direction at its end to
/// that at its beginning (Tedaldi, Pretto & Menegatti 2014).
///
/// Sums of fixed size, whatever the number of turns. They are of first order in the correction: with a matrix wrong by
/// 3 % its entries come out within 0.4 %. Turns integrated again with the result lead to the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gyroscope<T: Scalar> {
    assumed: Triad<T>,
    normal: Normal<T, UNKNOWNS>,
    turns: T,
}

impl<T: Scalar> Gyroscope<T> {
    /// Begins with what the turns are integrated with: [`Turn::new`].
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(assumed: Triad<T>) -> Result<Self, Error> {
        assumed.check()?;
        Ok(Self { assumed, normal: Normal::new(), turns: T::ZERO })
    }

    /// Takes in a turn and the specific forces before and after it, both calibrated (any unit).
    ///
    /// # Errors
    /// [`Error::Empty`] of a force without direction, [`Error::Inconsistent`] if the turn carries gravity astray by 30° or
    /// more, [`Error::NotFinite`], [`Error::Full`] where the number type counts no further; nothing is changed.
    pub fn add(
        &mut self,
        turn: &Turn<T>,
        before: &SVector<T, 3>,
        after: &SVector<T, 3>,
    ) -> Result<(), Error> {
        let before = unit(before.as_array()).ok_or(Error::Empty)?;
        let after = unit(after.as_array()).ok_or(Error::Empty)?;
        let carried = turn.to_beginning(&SVector::from(after));
        let carried = unit(carried.as_array()).ok_or(Error::Empty)?;
        // What is left to turn: about an axis at right angles to gravity. Of turns about gravity itself it says nothing.
        let axis = cross(&carried, &before);
        let (sine, cosine) = (T::norm(&axis), T::dot(&carried, &before));
        if !(sine <= T::from_f64(MOST_ASTRAY) && cosine > T::ZERO) {
            return Err(Error::Inconsistent);
        }
        let stretch = if sine > T::ZERO { sine.atan2(cosine) / sine } else { T::ONE };
        let left = axis.map(|component| component * stretch);
        let turns = self.turns + T::ONE;
        if !turns.is_finite() || turns <= self.turns {
            return Err(Error::Full);
        }
        let mut normal = self.normal;
        let rows = across(turn, &carried);
        for (row, value) in rows.iter().zip(left) {
            normal.add(row, value);
        }
        if !normal.is_finite() {
            return Err(Error::NotFinite);
        }
        (self.normal, self.turns) = (normal, turns);
        Ok(())
    }

    /// The matrix, as far as the turns tell it. `noise` is the standard deviation of a turn (rad), with all that a calibration
    /// cannot explain: 0.003 suits consumer sensors turned within seconds. Standard deviations are from it, or from
    /// what is left if that is more.
    ///
    /// # Errors
    /// [`Error::TooFew`] without a turn, [`Error::NotObservable`] if none of them tells a scale, [`Error::Inconsistent`] if no
    /// gyroscope measures so, [`Error::NotPositive`] of the noise.
    pub fn solve(&self, noise: T) -> Result<GyroscopeFit<T>, Error> {
        if !(noise.is_finite() && noise > T::ZERO) {
            return Err(Error::NotPositive);
        }
        if self.turns < T::ONE {
            return Err(Error::TooFew { found: 0, needed: 1 });
        }
        // A turn has two equations: that about gravity says nothing.
        let is_enough = self.turns * T::TWO >= T::from_f64(UNKNOWNS as f64);
        let all = [true; UNKNOWNS];
        if is_enough
            && let Some(inverse) = self.normal.inverse(&all, T::ZERO)
            && amplification(&inverse).iter().all(|gain| *gain <= T::from_f64(MOST_AMPLIFICATION))
        {
            return self.fit(&inverse, &all, GyroscopeModel::Full, noise);
        }
        let mut active: [bool; UNKNOWNS] = core::array::from_fn(|entry| entry % 4 == 0);
        // An axis about which nothing was turned has no weight, and none that can be divided by.
        for (entry, is_active) in active.iter_mut().enumerate() {
            let weight = self.normal.a.get(entry).and_then(|line| line.get(entry));
            *is_active &= weight
                .is_some_and(|weight| (*weight).sqrt() * T::from_f64(MOST_AMPLIFICATION) > T::ONE);
        }
        while active.iter().any(|is_active| *is_active) {
            let inverse = self.normal.inverse(&active, T::ZERO);
            let gains = inverse.as_ref().map(amplification).unwrap_or_default();
            let worst = gains.iter().enumerate().fold((0, T::ZERO), |worst, (entry, &gain)| {
                if gain > worst.1 { (entry, gain) } else { worst }
            });
            match inverse {
                Some(inverse) if worst.1 <= T::from_f64(MOST_AMPLIFICATION) => {
                    return self.fit(&inverse, &active, GyroscopeModel::Scale, noise);
                }
                // Which of them cannot be told apart from the others is not known then: none is.
                None => break,
                Some(_) => active.get_mut(worst.0).map_or((), |is_active| *is_active = false),
            }
        }
        Err(Error::NotObservable)
    }

    fn fit(
        &self,
        inverse: &Inverse<T, UNKNOWNS>,
        active: &[bool; UNKNOWNS],
        model: GyroscopeModel,
        given: T,
    ) -> Result<GyroscopeFit<T>, Error> {
        let solution = self.normal.solution(inverse);
        if !solution.iter().all(|entry| entry.abs() <= T::from_f64(LARGEST)) {
            return Err(Error::Inconsistent);
        }
        let left = self.normal.left(&solution);
        let equations = self.turns * T::TWO;
        let unknowns = active.iter().filter(|on| **on).fold(T::ZERO, |count, _| count + T::ONE);
        let sigma = noise(given, left, equations, unknowns);
        let sigmas = amplification(inverse).map(|gain| gain * sigma);
        let mut matrix_sigma = [[None; 3]; 3];
        for (entry, (&is_active, &sigma)) in active.iter().zip(&sigmas).enumerate() {
            let place = matrix_sigma.get_mut(entry % 3).and_then(|row| row.get_mut(entry / 3));
            if let (Some(place), true) = (place, is_active) {
                *place = Some(sigma);
            }
        }
        let [xx, yx, zx, xy, yy, zy, xz, yz, zz] = solution;
        let step = [[T::ONE + xx, yx, zx], [xy, T::ONE + yy, zy], [xz, yz, T::ONE + zz]];
        let matrix = SMatrix::from(product(&step, self.assumed.matrix.as_columns()));
        let triad = Triad { offset: self.assumed.offset, matrix };
        triad.check()?;
        let residual = (left / equations).sqrt();
        let finite = residual.is_finite() && T::all_finite(&sigmas);
        if !finite {
            return Err(Error::NotFinite);
        }
        Ok(GyroscopeFit { triad, model, matrix_sigma, residual })
    }
}

/// The sensitivity of a turn at right angles to where gravity was carried: a row for each axis of the frame at the beginning,
/// an entry for each of the matrix.
fn across<T: Scalar>(turn: &Turn<T>, carried: &[T; 3]) -> [[T; UNKNOWNS]; 3] {
    let mut rows = [[T::ZERO; UNKNOWNS]; 3];
    for (entry, adds) in turn.sensitivity().as_flattened().iter().enumerate() {
        let along = T::dot(adds, carried);
        for ((row, &adds), &carried) in rows.iter_mut().zip(adds).zip(carried) {
            if let Some(place) = row.get_mut(entry) {
                *place = adds - along * carried;
            }
        }
    }
    rows
}
