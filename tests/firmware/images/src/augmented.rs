//! The aeroplane's filter with gusts and biases, as run by an image.

use core::hint::black_box;

use support::{Class, Meter, fail, line, line_of_text};

use crate::augmented_model::{filter, step};
use crate::stream::{Flight, Stream, open};

/// The number of samples per reported state.
const SAMPLES_A_STATE: u32 = 50;

/// Replays a flight at 100 Hz, with the same output as the observer's images.
pub fn run() {
    let Ok((filter, transition, scales)) = filter(0.01) else {
        fail("a model that fits");
    };
    let mut filter = black_box(filter);
    line_of_text("name", "augmented9-100hz");
    line_of_text("scalar", "f32");
    line("object_bytes", &[size_of_val(&filter) as i64]);
    let mut meter = Meter::new();
    let mut samples = 0_u32;
    let mut state = [0; 4];
    for (_, Flight { inputs, outputs }) in Stream::<Flight>::of(&open()) {
        meter.measure(|| match step(&mut filter, &transition, &scales, inputs, outputs) {
            Ok(bits) => {
                state = bits;
                Class::Update
            }
            Err(_) => Class::Rejected,
        });
        samples += 1;
        if samples.is_multiple_of(SAMPLES_A_STATE) {
            line("state", &state);
        }
    }
    line("samples", &[samples.into()]);
    meter.report("step");
}
