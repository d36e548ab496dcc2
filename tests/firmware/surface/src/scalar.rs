//! Calls everything of `kestirim-scalar` in single precision and in fixed point, except for the conversions from and to
//! doubles: see `surface-scalar-f64`.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use kestirim_scalar::{Columns, Components, Fixed, Q8_24, Q12_20, Q16_16, Scalar};
use num_traits::{One, Zero};

use super::values::{any, call_each, keep, matrix, number, numbers, slice, whole};

fn functions<T: Scalar>() {
    keep::<T>(Scalar::from_f32(number()));
    keep(Scalar::to_f32(number::<T>()));
    keep::<T>(Scalar::from_micro(whole()));
    keep::<T>(Scalar::from_binary(whole(), whole()));
    keep(Scalar::to_binary(number::<T>(), whole()));
    keep(Scalar::is_finite(number::<T>()));
    keep(Scalar::is_positive(number::<T>()));
    keep(<T as Scalar>::all_finite(slice(&[T::ONE; 9])));
    keep(Scalar::abs(number::<T>()));
    keep(Scalar::min(number::<T>(), number()));
    keep(Scalar::max(number::<T>(), number()));
    keep(Scalar::clamp(number::<T>(), number(), number()));
    keep(Scalar::sqrt(number::<T>()));
    keep(Scalar::hypot(number::<T>(), number()));
    keep(Scalar::recip(number::<T>()));
    keep(Scalar::divided_by(number::<T>(), any(Scalar::divisor(number::<T>()))));
    keep(Scalar::sin_cos(number::<T>()));
    keep(Scalar::atan2(number::<T>(), number()));
    keep(Scalar::exp(number::<T>()));
    keep(Scalar::ln(number::<T>()));
    keep(Scalar::rounding(number::<T>(), whole()));
}

fn sums<T: Scalar, const N: usize>() {
    keep(<T as Scalar>::norm::<N>(&numbers()));
    keep(<T as Scalar>::ln_norm::<N>(&numbers()));
    keep(<T as Scalar>::dot::<N>(&numbers(), &numbers()));
    let sum = any(<T as Scalar>::accumulator());
    let sum = any(<T as Scalar>::mac(sum, number(), number()));
    let sum = any(<T as Scalar>::mac_within(sum, number(), number()));
    keep(<T as Scalar>::finish(sum));
    keep(<T as Scalar>::headroom(whole()));
    keep(Scalar::advanced(number::<T>(), sum, whole()));
}

fn arrays<T: Scalar>() {
    keep(*Components::as_array(&matrix::<T, 9, 1>()));
    keep(Components::as_array_mut(&mut matrix::<T, 9, 1>()));
    keep(*Columns::as_columns(&matrix::<T, 3, 4>()));
    keep(Columns::as_columns_mut(&mut matrix::<T, 3, 4>()));
}

fn operators<const FRAC: u32>() {
    let mut x = any(Fixed::<FRAC>::from_bits(whole()));
    let y = any(x);
    keep(Fixed::to_bits(x));
    keep(<Fixed<FRAC> as Add>::add(any(x), y));
    keep(<Fixed<FRAC> as Sub>::sub(any(x), y));
    keep(<Fixed<FRAC> as Mul>::mul(any(x), y));
    keep(<Fixed<FRAC> as Div>::div(any(x), y));
    keep(<Fixed<FRAC> as Neg>::neg(y));
    <Fixed<FRAC> as AddAssign>::add_assign(any(&mut x), y);
    <Fixed<FRAC> as SubAssign>::sub_assign(any(&mut x), y);
    <Fixed<FRAC> as MulAssign>::mul_assign(any(&mut x), y);
    <Fixed<FRAC> as DivAssign>::div_assign(any(&mut x), y);
    keep(<Fixed<FRAC> as Zero>::zero());
    keep(<Fixed<FRAC> as Zero>::is_zero(any(&x)));
    keep(<Fixed<FRAC> as One>::one());
    keep(x.partial_cmp(&y));
    keep(x == y);
}

fn all_of<T: Scalar>() {
    call_each([functions::<T>, sums::<T, 3>, sums::<T, 9>, arrays::<T>]);
}

/// Calls everything in this module.
pub fn run() {
    call_each([
        all_of::<f32>,
        all_of::<Q8_24>,
        all_of::<Q12_20>,
        all_of::<Q16_16>,
        all_of::<Fixed<30>>,
        operators::<1>,
        operators::<16>,
        operators::<20>,
        operators::<24>,
        operators::<30>,
    ]);
}
