//! Measures the elementary functions, in Q12.20 and single precision, over arguments of ordinary size.

#![no_std]
#![no_main]

use core::hint::black_box;

use kestirim_scalar::{Q12_20, Scalar};
use support::{Class, Meter, image};

/// Arguments from −6.2 to 6.6; functions of positive numbers take their magnitudes.
fn arguments<T: Scalar>() -> impl Iterator<Item = T> {
    (0..64).map(|k| T::from_micro(k * 203_125 - 6_200_000))
}

#[inline(always)] // Otherwise the call of `function` would be measured, too.
fn measure<T: Scalar>(name: &str, function: impl Fn(T) -> T) {
    let mut meter = Meter::new();
    for argument in arguments::<T>() {
        let argument = black_box(argument);
        meter.measure(|| {
            black_box(function(argument));
            Class::Predict
        });
    }
    meter.report(name);
}

macro_rules! measure_all {
    ($scalar:ty, $suffix:literal) => {
        measure::<$scalar>(concat!("sin ", $suffix), |x| x.sin_cos().0);
        measure::<$scalar>(concat!("sin_cos ", $suffix), |x| {
            let (sine, cosine) = x.sin_cos();
            sine - cosine
        });
        measure::<$scalar>(concat!("atan2 ", $suffix), |x| x.atan2(<$scalar>::TWO));
        measure::<$scalar>(concat!("exp ", $suffix), |x| x.exp());
        measure::<$scalar>(concat!("ln ", $suffix), |x| x.abs().ln());
        measure::<$scalar>(concat!("sqrt ", $suffix), |x| x.abs().sqrt());
        measure::<$scalar>(concat!("hypot ", $suffix), |x| x.hypot(<$scalar>::TWO));
        measure::<$scalar>(concat!("recip ", $suffix), |x| x.recip());
        measure::<$scalar>(concat!("multiply ", $suffix), |x| x * x);
        measure::<$scalar>(concat!("divide ", $suffix), |x| <$scalar>::TWO / x);
        measure::<$scalar>(concat!("divisor ", $suffix), |x| {
            <$scalar>::TWO.divided_by(x.divisor())
        });
    };
}

fn run() {
    measure_all!(Q12_20, "q12.20");
    measure_all!(f32, "f32");
}

image!(run);
