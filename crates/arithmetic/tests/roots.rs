//! The root is rounded to nearest, for numbers of all sizes; for other processors, the tests across crates compare
//! bits.

use kestirim_arithmetic::{sqrt, sqrt_f64};

#[test]
fn the_root_is_the_nearest_number() {
    // All exponents, also subnormal ones, with fractions spread over them. The root in double precision, rounded to
    // single, is correctly rounded: a double has more than twice the digits.
    for bits in (0..f32::INFINITY.to_bits()).step_by(10_007) {
        let x = f32::from_bits(bits);
        assert_eq!(sqrt(x), f64::from(x).sqrt() as f32, "√{x:e}");
    }
}

#[test]
fn edges_are_as_ieee_754_has_them() {
    assert_eq!(sqrt(0.0).to_bits(), 0.0_f32.to_bits());
    assert_eq!(sqrt(-0.0).to_bits(), (-0.0_f32).to_bits());
    assert_eq!(sqrt(f32::INFINITY), f32::INFINITY);
    for x in [-1e-45, -1.0, f32::NEG_INFINITY, f32::NAN] {
        assert!(sqrt(x).is_nan(), "√{x}");
    }
}

#[test]
fn in_double_precision_as_the_standard_library() {
    let spread = (0..f64::INFINITY.to_bits()).step_by(1_000_003 << 24).map(f64::from_bits);
    for x in spread.chain([0.0, f64::MIN_POSITIVE, f64::from_bits(1), f64::INFINITY]) {
        assert_eq!(sqrt_f64(x).to_bits(), x.sqrt().to_bits(), "√{x:e}");
    }
    assert_eq!(sqrt_f64(-0.0).to_bits(), (-0.0_f64).to_bits());
    for x in [-f64::from_bits(1), -1.0, f64::NEG_INFINITY, f64::NAN] {
        assert!(sqrt_f64(x).is_nan(), "√{x}");
    }
}
