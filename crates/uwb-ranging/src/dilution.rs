use crate::Error;
use crate::symmetric::{Factors, NormalEquations};
use kestirim_scalar::Scalar;

/// The dilution of precision: the factor by which the anchors' geometry magnifies a range error into a position
/// error, √(tr (HᵀH)⁻¹) for the directions H towards the tag (Langley 1999).
///
/// Four anchors around a tag in the plane give 1; more than 5 is a poor geometry.
///
/// # Errors
/// [`Error::TooFewRanges`] or [`Error::DegenerateGeometry`].
pub fn dilution_of_precision<T: Scalar, const D: usize>(
    directions: impl IntoIterator<Item = [T; D]>,
) -> Result<T, Error> {
    weighted_dilution(directions.into_iter().map(|direction| (direction, T::ONE)))
}

/// The dilution of precision of ranges with different accuracies. Each range has a weight: a reference variance
/// over its own.
///
/// The dilution times the reference standard deviation is the standard deviation of the position.
///
/// # Errors
/// [`Error::TooFewRanges`] or [`Error::DegenerateGeometry`].
pub fn weighted_dilution<T: Scalar, const D: usize>(
    ranges: impl IntoIterator<Item = ([T; D], T)>,
) -> Result<T, Error> {
    let ranges = ranges.into_iter().map(|(direction, weight)| (direction, weight, T::ZERO));
    let (factors, _) = equations(ranges)?;
    let inverse = factors.inverse();
    let trace = (0..D).fold(T::ZERO, |sum, axis| sum + inverse[axis][axis]);
    Ok(trace.sqrt())
}

/// The error (m) that range errors cause in the least-squares position, (HᵀWH)⁻¹HᵀW e.
///
/// Each range is given by its direction towards the tag, its weight and its error (m, positive if it is too long).
///
/// # Errors
/// [`Error::TooFewRanges`] or [`Error::DegenerateGeometry`].
pub fn position_error<T: Scalar, const D: usize>(
    ranges: impl IntoIterator<Item = ([T; D], T, T)>,
) -> Result<[T; D], Error> {
    let (factors, right_side) = equations(ranges)?;
    Ok(factors.solve(&right_side))
}

/// The normal equations of ranges, given by their directions, weights and errors.
fn equations<T: Scalar, const D: usize>(
    ranges: impl IntoIterator<Item = ([T; D], T, T)>,
) -> Result<(Factors<T, D>, [T; D]), Error> {
    const { assert!(0 < D && D <= 3, "a position has up to three coordinates") };
    let mut equations = NormalEquations::new();
    let mut count = 0;
    for (direction, weight, error) in ranges {
        equations.add(&direction, error, weight);
        count += 1;
    }
    if count < D {
        return Err(Error::TooFewRanges);
    }
    let factors = equations.factorised().ok_or(Error::DegenerateGeometry)?;
    Ok((factors, equations.b))
}
