//! Sets of poles.

use crate::Error;
use nalgebra::Complex;

/// Conjugates may differ by this much, beside their size.
const SAME: f64 = 1e-12;

/// A pole nearer to zero than this, beside the largest one, is taken for zero.
const ZERO: f64 = 1e-9;

/// Real poles first, then conjugate pairs side by side, each exactly conjugate; and where each stood.
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
    for (index, pole) in poles.iter().enumerate() {
        if pole.im == 0.0 || taken[index] {
            continue;
        }
        let tolerance = SAME * size(*pole);
        let is_partner = |other: usize| {
            let difference = poles[other] - Complex { re: pole.re, im: -pole.im };
            !taken[other] && poles[other].im * pole.im < 0.0 && size(difference) <= tolerance
        };
        let partner = (index + 1..N).find(|&other| is_partner(other)).ok_or(Error::NotConjugate)?;
        (taken[index], taken[partner]) = (true, true);
        put(*pole, index);
        put(Complex { re: pole.re, im: -pole.im }, partner);
    }
    Ok((arranged, origin))
}

/// |λ|.
pub(crate) fn size(pole: Complex<f64>) -> f64 {
    libm::hypot(pole.re, pole.im)
}

/// How often the pole that occurs most often occurs.
pub(crate) fn multiplicity<const N: usize>(poles: &[Complex<f64>; N]) -> usize {
    let count = |pole: &Complex<f64>| poles.iter().filter(|&other| other == pole).count();
    poles.iter().map(count).max().unwrap_or(0)
}

/// The placed poles in the order of the wanted ones, nearest to nearest, and how far the worst is off beside its
/// own size (beside the largest, if it should be zero).
pub(crate) fn compare<const N: usize>(
    wanted: &[Complex<f64>; N],
    placed: &[Complex<f64>; N],
    differences: impl Fn(usize, usize) -> f64,
) -> ([Complex<f64>; N], f64) {
    let largest = wanted.iter().chain(placed).map(|&pole| size(pole)).fold(0.0, f64::max);
    let (mut matched, mut error): ([Complex<f64>; N], f64) = (*wanted, 0.0);
    let (mut done, mut used) = ([false; N], [false; N]);
    for _ in 0..N {
        let mut nearest: Option<(f64, usize, usize)> = None;
        for row in (0..N).filter(|&row| !done[row]) {
            for column in (0..N).filter(|&column| !used[column]) {
                let distance = differences(row, column);
                if nearest.is_none_or(|(least, ..)| !(least <= distance)) {
                    nearest = Some((distance, row, column));
                }
            }
        }
        let Some((distance, row, column)) = nearest else { break };
        (done[row], used[column]) = (true, true);
        matched[row] = placed[column];
        let own = size(wanted[row]);
        let reference = if own > ZERO * largest { own } else { largest.max(f64::MIN_POSITIVE) };
        error = error.max(distance / reference);
    }
    (matched, error)
}
