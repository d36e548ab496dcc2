//! The root is rounded to nearest, for numbers of all sizes; for other processors, the tests across crates compare
//! bits.

use kestirim_arithmetic::sqrt;

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
