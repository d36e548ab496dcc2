//! Calls the double precision of `kestirim-scalar`, and the conversions of every scalar from and to it.

use kestirim_scalar::{Fixed, Q8_24, Q12_20, Q16_16, Scalar};

use super::values::{call_each, keep, number, numbers, slice, whole};

fn conversions<T: Scalar>() {
    keep::<T>(Scalar::from_f64(number()));
    keep(Scalar::to_f64(number::<T>()));
}

fn functions() {
    keep::<f64>(Scalar::from_f32(number()));
    keep(Scalar::to_f32(number::<f64>()));
    keep::<f64>(Scalar::from_micro(whole()));
    keep::<f64>(Scalar::from_binary(whole(), whole()));
    keep(Scalar::to_binary(number::<f64>(), whole()));
    keep(<f64 as Scalar>::all_finite(slice(&[1.0; 9])));
    keep(Scalar::clamp(number::<f64>(), number(), number()));
    keep(Scalar::sqrt(number::<f64>()));
    keep(Scalar::hypot(number::<f64>(), number()));
    keep(Scalar::divided_by(number::<f64>(), Scalar::divisor(number::<f64>())));
    keep(Scalar::sin_cos(number::<f64>()));
    keep(Scalar::atan2(number::<f64>(), number()));
    keep(Scalar::exp(number::<f64>()));
    keep(Scalar::ln(number::<f64>()));
    keep(Scalar::rounding(number::<f64>(), whole()));
    keep(<f64 as Scalar>::headroom(whole()));
    keep(Scalar::advanced(number::<f64>(), number(), whole()));
}

fn sums<const N: usize>() {
    keep(<f64 as Scalar>::norm::<N>(&numbers()));
    keep(<f64 as Scalar>::ln_norm::<N>(&numbers()));
    keep(<f64 as Scalar>::dot::<N>(&numbers(), &numbers()));
}

/// Calls everything in this module.
pub fn run() {
    call_each([
        conversions::<f32>,
        conversions::<f64>,
        conversions::<Q8_24>,
        conversions::<Q12_20>,
        conversions::<Q16_16>,
        conversions::<Fixed<30>>,
        functions,
        sums::<3>,
        sums::<9>,
    ]);
}
