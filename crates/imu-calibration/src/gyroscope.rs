use crate::matrix::{cross, product, unit};
use crate::normal::{Inverse, Normal, amplification, noise};
use crate::{Error, Triad, Turn};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The parameters of a gyroscope, besides its bias, that were determined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum GyroscopeModel {
    /// The scales of the axes about which it was turned.
    Scale,
    /// All scales and misalignments, including those to the accelerometer.
    Full,
}

/// The errors of a gyroscope, determined from turns between poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct GyroscopeFit<T: Scalar> {
    /// The bias (rad/s), as it was assumed, and the matrix.
    pub triad: Triad<T>,
    /// The entries of the matrix that were determined; the others are as assumed.
    pub model: GyroscopeModel,
    /// The standard deviations of the matrix, row by row; `None` for entries that the turns do not determine.
    pub matrix_sigma: [[Option<T>; 3]; 3],
    /// The root mean square error of gravity's direction after the turns (rad).
    pub residual: T,
}

/// The number of unknowns: the entries of the matrix, column by column.
const UNKNOWNS: usize = 9;
/// The largest uncertainty of an entry, as a multiple of a turn's noise: beyond it no turn determines the entry.
const MOST_AMPLIFICATION: f64 = 3.0;
/// The largest error of gravity's direction after a turn (the sine of 30°): a larger one shows swapped axes, or another
/// unit.
const MOST_ASTRAY: f64 = 0.5;
/// The largest correction of the matrix for a working gyroscope.
const LARGEST: f64 = 0.5;

/// The estimation of a gyroscope's scales and misalignments from turns between poses: a turn must carry gravity's
/// direction at its end to that at its beginning (Tedaldi, Pretto & Menegatti 2014).
///
/// It keeps sums of fixed size, whatever the number of turns. They are of first order in the correction: for a matrix
/// that is wrong by 3 % the entries come out within 0.4 %. Integrating the turns again with the result removes the
/// rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gyroscope<T: Scalar> {
    assumed: Triad<T>,
    normal: Normal<T, UNKNOWNS>,
    turns: T,
}

impl<T: Scalar> Gyroscope<T> {
    /// Begins with the triad with which the turns are integrated: [`Turn::new`].
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(assumed: Triad<T>) -> Result<Self, Error> {
        assumed.check()?;
        Ok(Self { assumed, normal: Normal::new(), turns: T::ZERO })
    }

    /// Adds a turn and the specific forces before and after it, both calibrated (any unit).
    ///
    /// # Errors
    /// [`Error::Empty`] for a force without direction, [`Error::Inconsistent`] if the turn misdirects gravity by 30° or
    /// more, [`Error::NotFinite`], [`Error::Full`] where the number type cannot count further; nothing is changed.
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
        // The remaining turn is about an axis perpendicular to gravity. Turns about gravity itself are not observed.
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

    /// Solves for the matrix, as far as the turns determine it.
    ///
    /// `noise` is the standard deviation of a turn (rad), including everything that a calibration cannot explain: 0.003
    /// suits consumer sensors turned within seconds. Standard deviations follow from it, or from the residuals if they
    /// are larger.
    ///
    /// # Errors
    /// [`Error::TooFew`] without a turn, [`Error::NotObservable`] if no turn determines a scale,
    /// [`Error::Inconsistent`] if no working gyroscope explains them, [`Error::NotPositive`] for the noise.
    pub fn solve(&self, noise: T) -> Result<GyroscopeFit<T>, Error> {
        if !(noise.is_finite() && noise > T::ZERO) {
            return Err(Error::NotPositive);
        }
        if self.turns < T::ONE {
            return Err(Error::TooFew { found: 0, needed: 1 });
        }
        // A turn has two equations: the one about gravity carries no information.
        let is_enough = self.turns * T::TWO >= T::from_f64(UNKNOWNS as f64);
        let all = [true; UNKNOWNS];
        if is_enough
            && let Some(inverse) = self.normal.inverse(&all, T::ZERO)
            && amplification(&inverse).iter().all(|gain| *gain <= T::from_f64(MOST_AMPLIFICATION))
        {
            return self.fit(&inverse, &all, GyroscopeModel::Full, noise);
        }
        let mut active: [bool; UNKNOWNS] = core::array::from_fn(|entry| entry % 4 == 0);
        // An axis about which there was no turn has no weight, or none by which to divide.
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
                // It is unknown which entries cannot be separated from the others, so none is determined.
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

/// The sensitivity of a turn perpendicular to the carried direction of gravity: a row for each axis of the frame at the
/// beginning, an entry for each entry of the matrix.
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
