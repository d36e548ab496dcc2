//! Bare-metal images under QEMU: first tests of the harness itself, then the workloads.
//!
//! On a machine without the tools these tests print SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead.

use anyhow::Result;
use target_bench::streams::{Encode, Sample};
use target_bench::{Images, Profile, Row, Target};

/// Generates every test for every target, in a module named after the target.
macro_rules! on {
    ($($name:ident => $target:ident: $($test:ident)*;)*) => {$(
        mod $name {
            use target_bench::$target;
            $(
                #[test]
                fn $test() -> anyhow::Result<()> {
                    super::$test(&$target)
                }
            )*
        }
    )*};
}

on! {
    cortex_m0 => CORTEX_M0: known_code_costs_what_it_must the_stack_is_seen counts_repeat
        a_step_too_long_to_count_fails a_stream_becomes_a_path a_broken_stream_fails
        the_harness_cannot_panic;
    cortex_m4f => CORTEX_M4F: known_code_costs_what_it_must the_stack_is_seen counts_repeat
        a_step_too_long_to_count_fails a_stream_becomes_a_path a_broken_stream_fails
        the_harness_cannot_panic;
    rv32imc => RV32IMC: known_code_costs_what_it_must the_stack_is_seen counts_repeat
        a_stream_becomes_a_path a_broken_stream_fails the_harness_cannot_panic;
}

fn known_code_costs_what_it_must(target: &'static Target) -> Result<()> {
    for profile in Profile::ALL {
        let Some(images) = Images::of(target, profile)? else { return Ok(()) };
        let output = images.run("self-check", &[])?;
        let instructions = |name| -> Result<u64> {
            let cost = output.cost(name, "predict")?.expect("ten steps");
            assert_eq!((cost.steps, cost.min), (10, cost.max), "{name} costs the same every time");
            Ok(cost.min)
        };
        assert_eq!(instructions("nothing")?, 0);
        assert_eq!(instructions("thousand_nops")?, 1000);
        // All instructions outside the loop cancel.
        assert_eq!(instructions("spin_long")? - instructions("spin_short")?, 2 * 1_200_000);
    }
    Ok(())
}

fn the_stack_is_seen(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let output = images.run("self-check", &[])?;
    assert_eq!(output.numbers("nothing.stack")?, [0]);
    for array in [64, 1024, 4096] {
        let [stack] = output.numbers(&format!("stack_{array}.stack"))?;
        assert!((array..=array + 40).contains(&stack), "array {array}, stack {stack}");
    }
    Ok(())
}

fn counts_repeat(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let stream = there_and_back().encode();
    assert_eq!(images.run("integrator", &stream)?, images.run("integrator", &stream)?);
    Ok(())
}

fn a_step_too_long_to_count_fails(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let failure = images.run("overrun", &[]).expect_err("700 million instructions");
    assert!(
        failure.to_string().contains("more instructions than the counter can hold"),
        "{failure}"
    );
    Ok(())
}

fn a_stream_becomes_a_path(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let samples = there_and_back();
    let output = images.run("integrator", &samples.encode())?;
    assert_eq!(output.numbers("samples")?, [samples.len() as i64]);

    let told: Vec<_> = output.positions()?.iter().map(|told| (told.time_us, told.metres)).collect();
    // IEEE single precision is the same everywhere, so the host's sums agree to the last printed digit.
    assert_eq!(told, integrate(&samples));

    let row = Row::of(&images, "integrator", &output)?;
    println!("{row}");
    assert_eq!((row.panic_symbols, row.double_symbols), (0, 0));
    Ok(())
}

fn a_broken_stream_fails(target: &'static Target) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let stream = there_and_back().encode();
    let failure = images.run("integrator", &stream[..100]).expect_err("100 is no multiple of 28");
    assert!(failure.to_string().contains("cut in the middle"), "{failure}");
    Ok(())
}

fn the_harness_cannot_panic(target: &'static Target) -> Result<()> {
    for profile in Profile::ALL {
        let Some(images) = Images::of(target, profile)? else { return Ok(()) };
        images.run("empty", &there_and_back().encode())?;
        let elf = images.elf("empty")?;
        assert_eq!((elf.panic_symbols(), elf.double_symbols()), (vec![], vec![]));
        assert_eq!(elf.ram_bytes, 0);
    }
    Ok(())
}

/// Twelve seconds of samples: accelerated forwards for half of them, then backwards.
fn there_and_back() -> Vec<Sample> {
    let sample = |i: u32| Sample {
        elapsed_us: 10_000 + i % 7,
        specific_force: [if i < 610 { 1.0 } else { -1.0 }, 0.25, -0.5],
        angular_rate: [0.0; 3],
    };
    (0..1234).map(sample).collect()
}

/// The image `integrator`, on the host: the time (µs) and position (m, as printed) after every 50 samples and the last.
fn integrate(samples: &[Sample]) -> Vec<(i64, [f64; 3])> {
    let mut time_us = 0;
    let (mut velocity, mut position) = ([0.0_f32; 3], [0.0_f32; 3]);
    let mut path = Vec::new();
    for (i, sample) in samples.iter().enumerate() {
        let seconds = sample.elapsed_us as f32 * 1e-6;
        time_us += i64::from(sample.elapsed_us);
        for axis in 0..3 {
            velocity[axis] += sample.specific_force[axis] * seconds;
            position[axis] += velocity[axis] * seconds;
        }
        if (i + 1) % 50 == 0 || i + 1 == samples.len() {
            path.push((time_us, position.map(|metres| f64::from((metres * 1e6) as i32) * 1e-6)));
        }
    }
    path
}
