//! Every elementary function compared with f64 over its whole domain, edges included. The bounds asserted are
//! those of the crate's documentation.

use kestirim_scalar::{Fixed, Q8_24, Q12_20, Q16_16, Scalar};

/// Bits over the whole range of an i32: both rails, every power of two and its neighbours, all small numbers,
/// and 200 000 spread evenly.
fn all_sizes() -> impl Iterator<Item = i32> {
    let edges = [i32::MIN, i32::MIN + 1, i32::MAX, i32::MAX - 1];
    let powers = (0..31).flat_map(|k| [(1 << k) - 1, 1 << k, (1 << k) + 1]).flat_map(|b| [b, -b]);
    let small = -3000..3000;
    let spread = (0..200_000_i64).map(|k| (i64::from(i32::MIN) + k * 21_475) as i32);
    edges.into_iter().chain(powers).chain(small).chain(spread)
}

/// Asserts |ours − exact| ≤ absolute + relative·|exact| + ½ LSB, and that values out of range are on their rail.
#[track_caller]
fn assert_near<const FRAC: u32>(
    ours: Fixed<FRAC>,
    exact: f64,
    absolute: f64,
    relative: f64,
    what: f64,
) {
    let lsb = Fixed::<FRAC>::EPSILON.to_f64();
    let bound = absolute + relative * exact.abs() + 0.500_001 * lsb;
    if exact >= Fixed::<FRAC>::MAX.to_f64() + bound {
        assert_eq!(ours, Fixed::MAX, "f({what}) = {exact} must saturate");
    } else if exact <= Fixed::<FRAC>::MIN.to_f64() - bound {
        assert_eq!(ours, Fixed::MIN, "f({what}) = {exact} must saturate");
    } else {
        let error = (ours.to_f64() - exact).abs();
        assert!(error <= bound, "f({what}) = {exact}, ours {ours}, error {error} > {bound}");
    }
}

fn check_one_argument<const FRAC: u32>() {
    for bits in all_sizes() {
        let x = Fixed::<FRAC>::from_bits(bits);
        let exact = x.to_f64();
        let (sine, cosine) = x.sin_cos();
        assert_near(sine, exact.sin(), 4e-8, 0.0, exact);
        assert_near(cosine, exact.cos(), 4e-8, 0.0, exact);
        assert_near(x.exp(), exact.exp(), 0.0, 1e-7, exact);
        if bits > 0 {
            assert_near(x.ln(), exact.ln(), 3e-7, 0.0, exact);
            assert_near(x.sqrt(), exact.sqrt(), 0.0, 0.0, exact);
        } else {
            assert_eq!(x.ln(), Fixed::MIN);
            assert_eq!(x.sqrt(), if bits == 0 { Fixed::ZERO } else { Fixed::MIN });
        }
        if bits != 0 {
            assert_near(x.recip(), 1.0 / exact, 0.0, 0.0, exact);
        }
    }
}

fn check_two_arguments<const FRAC: u32>() {
    let mut bits = all_sizes().step_by(7);
    let others: Vec<i32> = all_sizes().step_by(211).collect();
    for &other in others.iter().cycle().take(60_000) {
        let Some(bits) = bits.next() else { break };
        for (a, b) in [(bits, other), (other, bits), (bits, bits), (0, bits), (bits, 0)] {
            let (y, x) = (Fixed::<FRAC>::from_bits(a), Fixed::<FRAC>::from_bits(b));
            let (ey, ex) = (y.to_f64(), x.to_f64());
            assert_near(y.atan2(x), ey.atan2(ex), 3e-7, 0.0, ey);
            assert_near(y.hypot(x), ey.hypot(ex), 0.0, 0.0, ey);
            if b != 0 {
                let lsb = Fixed::<FRAC>::EPSILON.to_f64();
                assert_near(y / x, ey / ex, 0.0, 0.0, ey);
                assert_near(y.divided_by(x.divisor()), ey / ex, lsb, 0.0, ey);
            }
        }
    }
}

#[test]
fn fixed_functions_keep_their_bounds() {
    check_one_argument::<4>();
    check_one_argument::<8>();
    check_one_argument::<16>();
    check_one_argument::<20>();
    check_one_argument::<24>();
    check_one_argument::<30>();
}

#[test]
fn fixed_functions_of_two_arguments_keep_their_bounds() {
    check_two_arguments::<8>();
    check_two_arguments::<16>();
    check_two_arguments::<20>();
    check_two_arguments::<24>();
    check_two_arguments::<30>();
}

#[test]
fn single_precision_functions_keep_their_bounds() {
    for k in -400_000..=400_000_i32 {
        let x = k as f32 * 0.020_479;
        let (sine, cosine) = Scalar::sin_cos(x);
        assert!((f64::from(sine) - f64::from(x).sin()).abs() < 1.3e-7, "sin {x}");
        assert!((f64::from(cosine) - f64::from(x).cos()).abs() < 1.3e-7, "cos {x}");
    }
    for k in 0..400_000_i32 {
        let x = (8192.0 + k as f32 * 5.221) * if k % 2 == 0 { 1.0 } else { -1.0 };
        let (sine, cosine) = Scalar::sin_cos(x);
        assert!((f64::from(sine) - f64::from(x).sin()).abs() < 5e-7, "sin {x}");
        assert!((f64::from(cosine) - f64::from(x).cos()).abs() < 5e-7, "cos {x}");
    }
    for x in [1e7, -3e7, 1e30, f32::MAX, f32::MIN] {
        let (sine, cosine) = Scalar::sin_cos(x);
        assert!((sine.hypot(cosine) - 1.0).abs() < 3e-7, "sin and cos {x}");
    }
    for exponent in -126..127 {
        let x = 1.7 * 2.0_f32.powi(exponent);
        for y in [x, 0.3 * x, -2e-5 * x, 0.0] {
            let exact = f64::from(x).hypot(f64::from(y));
            assert!((f64::from(Scalar::hypot(x, y)) / exact - 1.0).abs() < 2e-7, "hypot {x} {y}");
        }
        let ln = f64::from(x).ln();
        assert!((f64::from(Scalar::ln(x)) - ln).abs() < 1e-7 * ln.abs().max(1.0), "ln {x}");
        for y in [x, -x, 3.0 * x, 0.0] {
            let exact = f64::from(y).atan2(f64::from(x));
            assert!((f64::from(Scalar::atan2(y, x)) - exact).abs() < 3e-7, "atan2 {y} {x}");
        }
    }
    for k in -8_690..8_800 {
        let x = k as f32 * 0.01;
        assert!((f64::from(Scalar::exp(x)) / f64::from(x).exp() - 1.0).abs() < 1.2e-7, "exp {x}");
    }
}

#[test]
fn double_precision_functions_keep_their_bounds() {
    let units = |ours: f64, exact: f64| (ours - exact).abs() / (exact.abs() * f64::EPSILON);
    for k in -353_500..354_800_i32 {
        let x = f64::from(k) * 0.002_000_3;
        assert!(units(Scalar::exp(x), x.exp()) < 1.5, "exp {x}");
    }
    for k in 0..400_000_i32 {
        for x in [0.5 + f64::from(k) * 4e-6, f64::from(k) * 3.7e3 + 1e-9, 1e-300 * f64::from(k + 1)]
        {
            assert!(
                (Scalar::ln(x) - x.ln()).abs() <= 1.2e-16 * x.ln().abs().max(0.5) * 2.0,
                "ln {x}"
            );
        }
        let x = 0.9 + f64::from(k) * 5e-7;
        assert!(k == 200_000 || units(Scalar::ln(x), x.ln()) < 2.0, "ln {x}");
        let (y, x) = (f64::from(k) * 1.7 - 3e5, f64::from(k % 997) * 13.0 - 5e3);
        assert!(units(Scalar::atan2(y, x), y.atan2(x)) < 2.5 || y == 0.0, "atan2 {y} {x}");
        let x = 1e-3 * f64::from(k + 1);
        assert!(units(f64::norm(&[x, 0.0]), x) < 1.0, "norm {x}");
    }
}

#[test]
fn whole_numbers_are_exact_up_to_the_largest() {
    fn check<T: Scalar>() {
        let whole = i32::try_from(T::MAX_WHOLE).unwrap_or(i32::MAX);
        let largest = T::from_binary(whole, 0);
        assert!(largest.is_finite() && largest.to_binary(0) == whole);
        assert_eq!(largest - (largest - T::ONE), T::ONE);
    }
    check::<f32>();
    check::<f64>();
    check::<Q16_16>();
    check::<Q12_20>();
    assert_eq!(f32::MAX_WHOLE as f32 + 1.0, f32::MAX_WHOLE as f32);
    assert_eq!(Q12_20::from_binary(Q12_20::MAX_WHOLE as i32 + 1, 0), Q12_20::MAX);
}

#[test]
fn numbers_become_integers_and_come_back() {
    fn check<T: Scalar>() {
        for value in [0, 1, -1, 77, -1_234, 2_047] {
            for exponent in [-8, -4, -2] {
                assert_eq!(T::from_binary(value, exponent).to_binary(exponent), value);
            }
            assert_eq!(T::from_binary(value, 0), T::from_f64(f64::from(value)));
        }
        assert_eq!(T::from_f64(-1.75).to_binary(0), -2);
        assert_eq!(T::from_f64(0.25).to_binary(-31), 1 << 29);
        assert_eq!(T::from_f64(-3.0).to_binary(-31), i32::MIN);
        assert_eq!(T::from_f64(3.0).to_binary(-31), i32::MAX);
        assert_eq!(T::from_f64(3.0).to_binary(40), 0);
        assert_eq!(T::from_binary(i32::MIN, -31), -T::ONE);
        assert_eq!(T::from_binary(3, -40).to_binary(0), 0);
    }
    check::<f32>();
    check::<f64>();
    check::<Q16_16>();
    check::<Q12_20>();
    assert_eq!(Q16_16::from_binary(1, 31), Q16_16::MAX);
    assert_eq!(Q16_16::from_binary(-1, 100), Q16_16::MIN);
}

#[test]
fn floats_have_their_ieee_edges() {
    assert!(Scalar::sqrt(-1.0_f32).is_nan());
    assert!(Scalar::sin_cos(f32::INFINITY).0.is_nan() && Scalar::sin_cos(f32::NAN).1.is_nan());
    assert_eq!(Scalar::ln(0.0_f32), f32::NEG_INFINITY);
    assert_eq!(Scalar::hypot(f32::INFINITY, 1.0), f32::INFINITY);
    assert_eq!(Scalar::hypot(0.0_f32, 0.0), 0.0);
    assert!(Scalar::hypot(f32::MAX, f32::MAX).is_infinite());
    assert_eq!(Scalar::exp(f64::NEG_INFINITY), 0.0);
    functions_have_their_edges::<f32>();
    functions_have_their_edges::<f64>();
}

fn functions_have_their_edges<T: Scalar>() {
    let (infinity, nan) = (T::from_f64(f64::INFINITY), T::from_f64(f64::NAN));
    let is_nan = |x: T| x.partial_cmp(&x).is_none();
    assert_eq!(infinity.exp(), infinity);
    assert_eq!((-infinity).exp(), T::ZERO);
    assert_eq!(T::MAX.exp(), infinity);
    assert_eq!(T::MIN.exp(), T::ZERO);
    assert_eq!(T::ZERO.exp(), T::ONE);
    assert_eq!(T::ONE.ln(), T::ZERO);
    assert_eq!(infinity.ln(), infinity);
    assert_eq!(T::ZERO.ln(), -infinity);
    assert!(T::MAX.ln().is_finite());
    assert!(is_nan(nan.exp()) && is_nan(nan.ln()) && is_nan((-T::ONE).ln()));
    assert!(is_nan(nan.atan2(T::ONE)) && is_nan(T::ONE.atan2(nan)));
    assert_eq!(T::ZERO.atan2(T::ZERO), T::ZERO);
    assert_eq!(T::ZERO.atan2(-T::ONE), T::PI);
    assert_eq!(infinity.atan2(T::ONE), T::PI * T::HALF);
    assert_eq!((-T::ONE).atan2(T::ZERO), -T::PI * T::HALF);
}

#[test]
fn microseconds_become_seconds() {
    for micro in [0, 1, 5000, -5000, 2_500, 999_999, 1_000_000, i32::MAX, i32::MIN] {
        let exact = f64::from(micro) * 1e-6;
        assert_near(Fixed::<20>::from_micro(micro), exact, 0.0, 1e-9, exact);
        assert_near(Fixed::<24>::from_micro(micro), exact, 0.0, 1e-9, exact);
        assert_near(Fixed::<30>::from_micro(micro), exact, 0.0, 1e-9, exact);
        assert!((f64::from(f32::from_micro(micro)) - exact).abs() <= 1.2e-7 * exact.abs());
    }
}

#[test]
fn a_norm_is_rounded_once_and_saturates() {
    let norm = |v: [f64; 3]| Q12_20::norm(&v.map(Q12_20::from_f64));
    assert_eq!(norm([2.0, -3.0, 6.0]), Q12_20::from_f64(7.0));
    assert_eq!(norm([0.0; 3]), Q12_20::ZERO);
    assert_eq!(norm([1e-6, 0.0, 0.0]), Q12_20::from_f64(1e-6));
    assert!(!norm([2000.0, 2000.0, 0.0]).is_finite());
    assert!(!norm([-2048.0; 3]).is_finite());
    let (x, y, z) = (12.345_678, -98.765_432, 0.123_456);
    let exact = (x * x + y * y + z * z).sqrt();
    assert!((norm([x, y, z]).to_f64() - exact).abs() < 1.5 / 1_048_576.0);
    assert_eq!(f64::norm(&[2.0, -3.0, 6.0]), 7.0);
}

fn check_ln_norm<T: Scalar>(last_place: f64) {
    for step in 0..4000 {
        let length = 1e-3 * f64::from(step).powf(1.7);
        let [x, y] = [0.6, -0.8].map(|share| T::from_f64(share * length));
        let exact = x.to_f64().hypot(y.to_f64()).ln();
        let got = T::ln_norm(&[x, y]);
        if exact == f64::NEG_INFINITY {
            assert!(!got.is_finite());
        } else {
            let error = (got.to_f64() - exact).abs();
            assert!(error <= 2e-7 + last_place + 1.2e-7 * exact.abs(), "{length}: {error}");
        }
    }
}

#[test]
fn the_logarithm_of_a_norm_needs_no_norm() {
    check_ln_norm::<f64>(0.0);
    check_ln_norm::<f32>(0.0);
    check_ln_norm::<Fixed<8>>(0.51 / 256.0);
    check_ln_norm::<Q16_16>(0.51 / 65_536.0);
    check_ln_norm::<Q12_20>(0.51 / 1_048_576.0);
    // The norm is out of range, but its logarithm is not.
    let rails = Q16_16::ln_norm(&[Q16_16::MIN; 4]);
    assert!((rails.to_f64() - 65_536_f64.ln()).abs() < 1e-4);
    let least = Q8_24::ln_norm(&[Q8_24::EPSILON, Q8_24::ZERO]);
    assert!((least.to_f64() + 24.0 * 2_f64.ln()).abs() < 1e-6);
}

#[test]
fn a_norm_in_single_precision_is_good_to_the_last_place() {
    assert_eq!(f32::norm(&[2.0, -3.0, 6.0]), 7.0);
    assert_eq!(f32::norm(&[0.0; 3]), 0.0);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        assert!(!f32::norm(&[1.0, bad]).is_finite());
    }
    // Two octaves, value by value, cover all of them, here from 10⁻¹⁸ to 10¹⁸.
    for octave in [0.25_f32, 1e-18, 1e18] {
        for step in 0..1 << 22 {
            let x = octave * (1.0 + step as f32 / f32::from(1_u16 << 11) / 512.0);
            let error = (f32::norm(&[x, 0.0]).to_f64() - x.to_f64()).abs();
            assert!(error <= x.to_f64() * f64::from(f32::EPSILON), "{x}: {error}");
        }
    }
}

#[test]
fn a_rounding_bounds_what_arithmetic_loses() {
    assert_eq!(1.0_f32.rounding(4), 4.0 * f32::EPSILON);
    assert_eq!((-2.0_f64).rounding(1), 2.0 * f64::EPSILON);
    // Half a unit in the last place each, rounded up in all; more where the error of a factor is magnified.
    assert_eq!(Q12_20::from_f64(0.5).rounding(3).to_bits(), 2);
    assert_eq!(Q12_20::from_f64(-3.0).rounding(4).to_bits(), 8);
    assert!(Q12_20::MIN.rounding(u16::MAX) > Q12_20::ZERO);
}

fn check_is_positive<T: Scalar>(numbers: &[T]) {
    for &x in numbers {
        assert_eq!(x.is_positive(), x.is_finite() && x > T::ZERO, "{x:?}");
        let all = [T::ONE, x, T::ONE];
        assert_eq!(T::all_finite(&all), x.is_finite(), "{x:?}");
    }
}

#[test]
fn positive_and_finite_in_one_question() {
    let floats = [0.0, 1e-45, f32::MIN_POSITIVE, 1.0, f32::MAX, f32::INFINITY, f32::NAN];
    check_is_positive(&floats.map(|x| -x));
    check_is_positive(&floats);
    check_is_positive(&floats.map(f64::from));
    let [low, high] = [Q12_20::MIN, Q12_20::MAX];
    check_is_positive(&[low, -Q12_20::EPSILON, Q12_20::ZERO, Q12_20::EPSILON, high]);
}
