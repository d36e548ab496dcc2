//! Fixed-point arithmetic compared with wide integers, for any bits.

use kestirim_scalar::{Fixed, Q12_20, Q16_16, Scalar};
use nalgebra::SMatrix;
use proptest::prelude::*;

fn saturated(bits: i128) -> i32 {
    bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// Rounds half up, like a shift after adding half.
fn rounded_shift(value: i128, shift: u32) -> i128 {
    if shift == 0 { value } else { (value + (1 << (shift - 1))) >> shift }
}

fn check_arithmetic<const FRAC: u32>(a: i32, b: i32) {
    let (x, y) = (Fixed::<FRAC>::from_bits(a), Fixed::<FRAC>::from_bits(b));
    let (wide_a, wide_b) = (i128::from(a), i128::from(b));
    assert_eq!((x + y).to_bits(), saturated(wide_a + wide_b));
    assert_eq!((x - y).to_bits(), saturated(wide_a - wide_b));
    assert_eq!((x * y).to_bits(), saturated(rounded_shift(wide_a * wide_b, FRAC)));
    assert_eq!((-x).to_bits(), saturated(-wide_a));
    let dot = Scalar::dot(&[x, y, x], &[y, y, x]);
    let sum = wide_a * wide_b + wide_b * wide_b + wide_a * wide_a;
    assert_eq!(dot.to_bits(), saturated(rounded_shift(sum, FRAC)));
    if b == 0 {
        assert!(!(x / y).is_finite());
    } else {
        let exact = (wide_a << FRAC) as f64 / wide_b as f64;
        assert!(
            ((x / y).to_bits() as f64 - exact.clamp(-2_147_483_648.0, 2_147_483_647.0)).abs()
                <= 0.5
        );
    }
}

proptest! {
    #[test]
    fn arithmetic_rounds_once_and_saturates(a in any::<i32>(), b in any::<i32>(), small in -9_i32..9) {
        check_arithmetic::<8>(a, b);
        check_arithmetic::<16>(a, small);
        check_arithmetic::<20>(a, b);
        check_arithmetic::<24>(small, b);
        check_arithmetic::<30>(a, b);
    }

    /// The new value and the remainder kept are together exactly the old value and the sum.
    #[test]
    fn an_advance_loses_nothing(value in -1_000_000_i32..1_000_000, sum in any::<i64>(), scale in 0_u32..99) {
        let sum = sum >> 2;
        let shift = Q16_16::headroom(15 - scale as i32).expect("less than one");
        let (next, rest) = Q16_16::from_bits(value).advanced(sum, shift);
        let exact = (i128::from(value) << (16 + shift)) + i128::from(sum);
        prop_assert_eq!(next.to_bits(), saturated(rounded_shift(exact, 16 + shift)));
        if next.is_finite() {
            prop_assert_eq!((i128::from(next.to_bits()) << (16 + shift)) + i128::from(rest), exact);
        }
    }

    #[test]
    fn doubles_and_singles_go_there_and_back(bits in any::<i32>()) {
        let x = Q12_20::from_bits(bits);
        prop_assert_eq!(Q12_20::from_f64(x.to_f64()), x);
        let single = Q12_20::from_f32(x.to_f32());
        prop_assert!((single.to_f64() - x.to_f64()).abs() <= x.to_f64().abs() * 6e-8);
    }

    #[test]
    fn any_float_converts(value in any::<f64>(), single in any::<f32>()) {
        let fixed = Q16_16::from_f64(value);
        prop_assert!(fixed.is_finite() == (value.abs() < 32_767.999));
        prop_assert_eq!(Q16_16::from_f32(single), Q16_16::from_f64(f64::from(single)));
    }

    #[test]
    fn a_matrix_of_fixed_point_is_a_matrix(entries in proptest::array::uniform16(-20.0..20.0f64)) {
        let exact = SMatrix::<f64, 4, 4>::from_row_slice(&entries);
        let ours: SMatrix<Q12_20, 4, 4> = exact.map(Q12_20::from_f64);
        let error = |ours: SMatrix<Q12_20, 4, 4>, exact: SMatrix<f64, 4, 4>| {
            (ours.map(Scalar::to_f64) - exact).abs().max()
        };
        // Each entry is off by half a unit before it is multiplied by 20, four times.
        prop_assert!(error(ours * ours.transpose(), exact * exact.transpose()) < 4.0 * 40.0 * 5e-7 + 4e-6);
        prop_assert!(error(ours + ours - ours, exact) < 1e-6);
    }
}

#[test]
fn division_by_zero_goes_to_a_rail() {
    assert_eq!(Q16_16::ONE / Q16_16::ZERO, Q16_16::MAX);
    assert_eq!(-Q16_16::ONE / Q16_16::ZERO, Q16_16::MIN);
    assert_eq!(Q16_16::ZERO / Q16_16::ZERO, Q16_16::MIN);
    assert_eq!(Q16_16::ONE.divided_by(Q16_16::ZERO.divisor()), Q16_16::MAX);
    assert_eq!(Q16_16::ZERO.recip(), Q16_16::MAX);
    assert_eq!(Q16_16::from_f64(f64::NAN), Q16_16::MIN);
}

#[cfg(feature = "fixed")]
#[test]
fn the_fixed_crate_has_the_same_bits() {
    use fixed::types::I12F20;
    let theirs = I12F20::from_num(-3.25);
    let ours = Q12_20::from(theirs);
    assert_eq!(ours.to_f64(), -3.25);
    assert_eq!(I12F20::from(ours), theirs);
}

#[test]
fn one_that_is_not_finite_is_found_among_many() {
    assert!(f32::all_finite(&[1.0, -0.0, f32::MAX, f32::MIN_POSITIVE]));
    assert!(f32::all_finite(&[]));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(!f32::all_finite(&[1.0, bad, 2.0]));
        assert!(!f64::all_finite(&[bad.into(), f64::MAX]));
    }
    assert!(Q12_20::all_finite(&[Q12_20::ONE, Q12_20::ZERO]));
    assert!(!Q12_20::all_finite(&[Q12_20::ONE, Q12_20::MIN]));
}

#[test]
fn headroom_is_what_the_coefficients_leave() {
    assert_eq!(Q16_16::headroom(15), Some(0));
    assert_eq!(Q16_16::headroom(16), None);
    assert_eq!(Q16_16::headroom(-5), Some(20));
    assert_eq!(Q16_16::headroom(-60), Some(46));
    assert_eq!(f32::headroom(-60), Some(0));
    assert_eq!(f32::headroom(129), None);
}

#[test]
fn a_million_steps_below_the_last_place_add_up() {
    fn walk<T: Scalar>(coefficient: T, shift: u32) -> f64 {
        let (mut place, mut rest) = (T::from_f64(40.0), T::accumulator());
        for _ in 0..1_000_000 {
            (place, rest) = place.advanced(T::mac_within(rest, coefficient, T::ONE), shift);
        }
        place.to_f64()
    }
    // A step is a tenth of the last place of Q16.16 at 40, and less than that of an f32.
    assert!((walk(Q16_16::from_f64(1.5), 20) - (40.0 + 1.5e6 / 1_048_576.0)).abs() < 1.6e-5);
    assert!((walk(1.5e-6_f32, 0) - 41.5).abs() < 4e-6);
}
