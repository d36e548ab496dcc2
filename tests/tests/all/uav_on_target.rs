//! The aeroplane's observer on emulated boards: the same states as on the host, within the budgets.
//!
//! On a machine without the tools these tests say SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result};
use kestirim_luenberger::Predictor;
use kestirim_scalar::{Components, Q16_16, Scalar};
use nalgebra::SVector;
use target_bench::streams::{Encode, Flight, fly};
use target_bench::{
    CORTEX_M0, CORTEX_M4F, Images, Profile, RV32IMC, Row, Target, augmented_model, uav,
};

/// The bits of the estimate after every fifty samples, as the image computes them.
fn estimates<T: Scalar>(flight: &Flight, interval: f64) -> Vec<[i64; 4]> {
    let start = SVector::from(uav::START.map(T::from_f32));
    let mut observer = Predictor::<T, 4, 2, 3>::new(&uav::gains(interval), &start).expect("gains");
    let step = |sample: &[f32; 5]| {
        let [u0, u1, y0, y1, y2] = sample.map(T::from_f32);
        observer.step(&SVector::from([u0, u1]), &SVector::from([y0, y1, y2])).expect("a sample");
        observer.estimate().as_array().map(|value| i64::from(value.to_f32().to_bits()))
    };
    let states: Vec<_> = flight.iter().map(step).collect();
    states.chunks_exact(50).map(|chunk| chunk[49]).collect()
}

/// Runs an image, compares its states with the host's, and returns the number of instructions of the longest step.
fn agree(images: &Images, image: &str, flight: &Flight, host: &[[i64; 4]]) -> Result<u64> {
    let output = images.run(image, &flight.encode())?;
    println!("{}", Row::of(images, image, &output)?);
    assert_eq!(output.rows::<4>("state")?, host, "{image}: the very bits");
    assert_eq!(images.elf(image)?.panic_symbols(), Vec::<String>::new(), "{image} cannot panic");
    let cost = output.cost("step", "update")?.context("every step is an update")?;
    assert_eq!(cost.steps, flight.len() as u64);
    Ok(cost.max)
}

/// The instructions of the longest step, in `f32` and in fixed point.
fn costs(target: &'static Target) -> Result<Option<[u64; 2]>> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(None) };
    let mut longest = [0; 2];
    for (interval, suffix) in [(0.01, ""), (0.001, "-1khz")] {
        let flight = fly(&uav::plant(interval));
        let cases = [
            ("f32", estimates::<f32>(&flight, interval)),
            ("fixed", estimates::<Q16_16>(&flight, interval)),
        ];
        for ((scalar, host), longest) in cases.iter().zip(&mut longest) {
            let image = format!("observer4-{scalar}{suffix}");
            *longest = agree(&images, &image, &flight, host)?.max(*longest);
            let elf = images.elf(&image)?;
            assert_eq!(elf.double_symbols(), Vec::<String>::new(), "{image} has no doubles");
        }
    }
    let [single, fixed] = longest;
    println!("    fixed point takes {:.2} of f32's instructions", fixed as f64 / single as f64);
    Ok(Some(longest))
}

/// The filter with gusts and biases: bit for bit the host's states, within its budget.
#[test]
fn a_filter_of_nine_states_on_a_cortex_m4f() -> Result<()> {
    let Some(images) = Images::of(&CORTEX_M4F, Profile::Speed)? else { return Ok(()) };
    let flight = fly(&uav::plant(0.01));
    let (mut filter, transition, scales) = augmented_model::filter(0.01)?;
    let step = |&[u0, u1, y0, y1, y2]: &[f32; 5]| {
        augmented_model::step(&mut filter, &transition, &scales, [u0, u1], [y0, y1, y2])
    };
    let states = flight.iter().map(step).collect::<Result<Vec<_>, _>>()?;
    let host: Vec<_> = states.chunks_exact(50).map(|chunk| chunk[49]).collect();
    let longest = agree(&images, "augmented9-f32", &flight, &host)?;
    assert!(longest <= 3_000, "{longest} instructions");
    Ok(())
}

#[test]
fn cortex_m0() -> Result<()> {
    if let Some([single, fixed]) = costs(&CORTEX_M0)? {
        // With the compiler's arithmetic instead of `kestirim-arithmetic`'s it was 9,857 in `f32`.
        assert!(single <= 3_900, "{single} instructions");
        assert!(fixed <= 1_500, "{fixed} instructions");
    }
    Ok(())
}

#[test]
fn cortex_m4f() -> Result<()> {
    if let Some([single, fixed]) = costs(&CORTEX_M4F)? {
        assert!(single <= 200, "{single} instructions");
        assert!(fixed <= 500, "{fixed} instructions");
    }
    Ok(())
}

#[test]
fn rv32imc() -> Result<()> {
    if let Some([single, fixed]) = costs(&RV32IMC)? {
        assert!(4 * fixed < single, "{fixed} instructions in fixed point, {single} in f32");
    }
    Ok(())
}
