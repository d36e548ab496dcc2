//! Sets of poles.

use crate::Error;
use nalgebra::Complex;

/// Largest deviation of two poles from being conjugate, relative to their magnitude.
const SAME: f64 = 1e-12;

/// Magnitude, relative to the size of the system, below which a pole is taken for zero.
const ZERO: f64 = 1e-9;

/// Sorts poles: real ones first, then conjugate pairs side by side, made exactly conjugate. Also
/// returns their original indices.
pub(crate) fn arrange<const N: usize>(
    poles: &[Complex<f64>; N],
) -> Result<([Complex<f64>; N], [usize; N]), Error> {
    if poles.iter().any(|pole| !pole.re.is_finite() || !pole.im.is_finite()) {
        return Err(Error::NotFinite);
    }
    let (mut arranged, mut origin, mut taken) = (*poles, [0; N], [false; N]);
    let mut count = 0;
    let mut put = |pole: Complex<f64>, from: usize| {
        if let (Some(place), Some(source)) = (arranged.get_mut(count), origin.get_mut(count)) {
            (*place, *source) = (pole, from);
        }
        count += 1;
    };
    for (index, pole) in poles.iter().enumerate() {
        if pole.im == 0.0 {
            put(*pole, index);
        }
    }
    for index in 0..N {
        let pole = poles[index];
        if pole.im == 0.0 || taken[index] {
            continue;
        }
        let conjugate = Complex { re: pole.re, im: -pole.im };
        let is_partner = |other: &Complex<f64>| {
            other.im * pole.im < 0.0 && size(other - conjugate) <= SAME * size(pole)
        };
        let mut others = poles.iter().zip(&mut taken).enumerate().skip(index + 1);
        let (partner, (_, taken)) = others
            .find(|(_, (other, taken))| !**taken && is_partner(other))
            .ok_or(Error::NotConjugate)?;
        *taken = true;
        put(pole, index);
        put(conjugate, partner);
    }
    Ok((arranged, origin))
}

/// The magnitude |λ|.
pub(crate) fn size(pole: Complex<f64>) -> f64 {
    libm::hypot(pole.re, pole.im)
}

/// Multiplicity of the pole that occurs most often.
pub(crate) fn multiplicity<const N: usize>(poles: &[Complex<f64>; N]) -> usize {
    let count = |pole: &Complex<f64>| poles.iter().filter(|&other| other == pole).count();
    poles.iter().map(count).max().unwrap_or(0)
}

/// Assigns placed poles to wanted ones, nearest first. `distances` has a row for each wanted pole.
pub(crate) fn pair_up<const N: usize>(distances: &[[f64; N]; N]) -> [usize; N] {
    let mut partners = [None; N];
    for _ in 0..N {
        let mut nearest: Option<(f64, usize, usize)> = None;
        for wanted in 0..N {
            if partners[wanted].is_some() {
                continue;
            }
            for (placed, &here) in distances[wanted].iter().enumerate() {
                let is_nearer = nearest.is_none_or(|(least, ..)| here < least);
                if is_nearer && !partners.contains(&Some(placed)) {
                    nearest = Some((here, wanted, placed));
                }
            }
        }
        if let Some((_, wanted, placed)) = nearest
            && let Some(partner) = partners.get_mut(wanted)
        {
            *partner = Some(placed);
        }
    }
    partners.map(|partner| partner.unwrap_or(0))
}

/// Whether a pole counts as zero, relative to the size of the system.
pub(crate) fn is_nearly_zero(pole: Complex<f64>, system: f64) -> bool {
    size(pole) <= ZERO * system
}
