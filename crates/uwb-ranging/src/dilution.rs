use crate::Error;
use crate::symmetric::{MOST, NormalEquations};
use kestirim_scalar::Scalar;

/// The dilution of precision: by how much the anchors' places magnify the error of a range into that of
/// the position, √(tr (HᵀH)⁻¹) for the directions H towards the tag (Langley 1999).
///
/// Four anchors around a tag in the plane give 1; more than 5 is a poor geometry.
///
/// # Errors
/// [`Error::TooFewRanges`] or [`Error::DegenerateGeometry`].
pub fn dilution_of_precision<T: Scalar, const D: usize>(
    directions: impl IntoIterator<Item = [T; D]>,
) -> Result<T, Error> {
    const { assert!(D < MOST, "a position has up to three coordinates") };
    let mut equations = NormalEquations::new(D);
    let mut count = 0;
    for direction in directions {
        let mut row = [T::ZERO; MOST];
        row[..D].copy_from_slice(&direction);
        equations.add(&row, T::ZERO, T::ONE);
        count += 1;
    }
    if count < D {
        return Err(Error::TooFewRanges);
    }
    let factors = equations.factorised(T::from_f64(1e-4)).ok_or(Error::DegenerateGeometry)?;
    let inverse = factors.inverse();
    let trace = (0..D).fold(T::ZERO, |sum, axis| sum + inverse[axis][axis]);
    Ok(trace.sqrt())
}
