//! The aeroplane's observer of four states, as run by an image.

use core::hint::black_box;

use kestirim_luenberger::{Predictor, PredictorGains};
use kestirim_scalar::Components;
use nalgebra::SVector;
use support::{Class, Meter, fail, line, line_of_text};

use crate::four_ranges::Named;
use crate::stream::{Flight, Stream, open};
use crate::uav::{START, gains};

/// The number of samples per reported state.
const SAMPLES_A_STATE: u32 = 50;

/// Replays a flight at 100 Hz.
pub fn run_100_hz<T: Named>() {
    const GAINS: PredictorGains<4, 2, 3> = gains(0.01);
    run::<T>("observer4-100hz", &GAINS);
}

/// Replays a flight at 1 kHz.
pub fn run_1_khz<T: Named>() {
    const GAINS: PredictorGains<4, 2, 3> = gains(0.001);
    run::<T>("observer4-1khz", &GAINS);
}

/// Prints
///
/// - `name`, `scalar` and `object_bytes` (size of the observer);
/// - `state`, four numbers: the bits of the estimate in single precision, every `SAMPLES_A_STATE` samples;
/// - `samples`, and the meter's report as `step`.
#[inline(always)]
fn run<T: Named>(name: &str, gains: &PredictorGains<4, 2, 3>) {
    let start = SVector::from(START.map(T::from_f32));
    let Ok(observer) = Predictor::<T, 4, 2, 3>::new(gains, &start) else {
        fail("gains that fit");
    };
    // Otherwise the coefficients would be compiled into the code, which is faster than what most firmware can do.
    let mut observer = black_box(observer);
    line_of_text("name", name);
    line_of_text("scalar", T::NAME);
    line("object_bytes", &[size_of_val(&observer) as i64]);
    let mut meter = Meter::new();
    let mut samples = 0_u32;
    for (_, Flight { inputs, outputs }) in Stream::<Flight>::of(&open()) {
        let inputs = SVector::from(inputs.map(T::from_f32));
        let outputs = SVector::from(outputs.map(T::from_f32));
        meter.measure(|| match observer.step(&inputs, &outputs) {
            Ok(()) => Class::Update,
            Err(_) => Class::Rejected,
        });
        samples += 1;
        if samples.is_multiple_of(SAMPLES_A_STATE) {
            // This is exact in fixed point, too, below 256.
            let state = observer.estimate().as_array().map(T::to_f32);
            line("state", &state.map(|value| i64::from(value.to_bits())));
        }
    }
    line("samples", &[samples.into()]);
    meter.report("step");
}
