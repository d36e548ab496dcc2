use kestirim_scalar::Scalar;

use super::sight::decibels;

/// Distance of the entries of [`ENTRIES`], as a power of two.
const SPACING: i32 = -1;
/// The exponent of the entries' unit.
const UNIT: i32 = -24;
/// Index of the last entry but one.
const LAST: i32 = ENTRIES.len() as i32 - 2;
/// ln(1 + e⁻ᵃ), and minus its derivative 1/(1 + eᵃ), for a = 0, ½, …, 9.
const ENTRIES: [[i32; 2]; 19] = [
    [11_629_080, 8_388_608],
    [7_953_692, 6_334_081],
    [5_255_659, 4_512_088],
    [3_379_154, 3_060_592],
    [2_129_499, 1_999_893],
    [1_323_550, 1_272_689],
    [815_160, 795_674],
    [499_129, 491_778],
    [304_505, 301_759],
    [185_350, 184_330],
    [112_665, 112_287],
    [68_425, 68_286],
    [41_535, 41_484],
    [25_205, 25_186],
    [15_292, 15_285],
    [9_277, 9_274],
    [5_627, 5_626],
    [3_413, 3_413],
    [2_070, 2_070],
];

/// The power of a floor and a signal together, dB, to 0.0006 dB, and the signal's share of it, to 0.0002. Powers that
/// differ by more than 39 dB are not added.
///
/// A fit does this for each measurement, step and place: a polynomial between two entries of a table costs a fraction
/// of an exponential and a logarithm.
#[inline(always)]
pub(super) fn added<T: Scalar>(floor: T, signal: T) -> (T, T) {
    let is_stronger = signal > floor;
    let stronger = if is_stronger { signal } else { floor };
    let ratio = (signal - floor).abs() * T::from_f64(core::f64::consts::LN_10 / 10.0);
    let (excess, share) = between(ratio);
    (stronger + decibels(excess), if is_stronger { T::ONE - share } else { share })
}

/// ln(1 + e⁻ᵃ) and 1/(1 + eᵃ) for a ≥ 0: the cubic polynomial that has value and slope of both entries beside a
/// (Hermite's interpolation), and its derivative.
#[inline(always)]
fn between<T: Scalar>(a: T) -> (T, T) {
    // Half a spacing less, so that the nearest entry is the one below.
    let nearest = (a - T::from_binary(1, SPACING - 1)).to_binary(SPACING).max(0);
    let is_far = nearest > LAST;
    let index = if is_far { LAST } else { nearest };
    let [low, falls] = entry(index);
    let [high, falls_then] = entry(index + 1);
    let t = a * T::from_binary(1, -SPACING) - T::from_binary(index, 0);
    let number = |entry| T::from_binary(entry, UNIT);
    let slope = |entry| -T::from_binary(entry, UNIT + SPACING);
    let (value, change) = (number(low), number(high) - number(low));
    let (first, last) = (slope(falls), slope(falls_then));
    let second = change + change + change - first - first - last;
    let third = first + last - change - change;
    let derivative = first + t * (second + second + t * (third + third + third));
    let value = value + t * (first + t * (second + t * third));
    let derivative = derivative * T::from_binary(1, -SPACING);
    if is_far { (T::ZERO, T::ZERO) } else { (value, -derivative) }
}

#[inline(always)]
fn entry(index: i32) -> [i32; 2] {
    ENTRIES.get(index as usize).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_scalar::{Q12_20, Q16_16};

    fn check<T: Scalar>(level_db: f64, share: f64) {
        for step in -4500..=4500 {
            let (floor, signal) = (-80.0, -80.0 + 0.01 * f64::from(step));
            let powers = [floor, signal].map(|level: f64| 10_f64.powf(level / 10.0));
            let known =
                (10.0 * (powers[0] + powers[1]).log10(), powers[1] / (powers[0] + powers[1]));
            let found = added(T::from_f64(floor), T::from_f64(signal));
            let off = [found.0.to_f64() - known.0, found.1.to_f64() - known.1].map(f64::abs);
            assert!(off[0] < level_db && off[1] < share, "{signal} dB: {found:?}, not {known:?}");
        }
    }

    #[test]
    fn powers_are_added_as_by_the_exponential() {
        check::<f64>(6e-4, 2e-4);
        check::<f32>(6e-4, 2e-4);
        check::<Q12_20>(7e-4, 3e-4);
        check::<Q16_16>(2e-3, 4e-4);
    }

    #[test]
    fn what_is_no_number_stays_so() {
        assert!(added(-80.0_f64, f64::NAN).0.is_nan());
        assert!(added(f64::NAN, -80.0).0.is_nan());
        assert_eq!(added(-80.0, f64::INFINITY), (f64::INFINITY, 1.0));
        assert_eq!(added(-80.0, f64::NEG_INFINITY), (-80.0, 0.0));
    }
}
