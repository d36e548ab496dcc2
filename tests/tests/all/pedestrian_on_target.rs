//! The pedestrian trackers on emulated boards: the same path as on the host, within the budgets.
//!
//! On a machine without the tools these tests say SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result};
use kestirim_pedestrian::{Config, Ekf, ImuSample, Lite, Navigator, Tracker};
use kestirim_scalar::{Components, Q12_20, Scalar};
use nalgebra::SVector;
use target_bench::streams::{Encode, Sample, walk};
use target_bench::{CORTEX_M0, CORTEX_M4F, Images, Output, Profile, RV32IMC, Row, Target};

/// The walk on the host: the time (µs) and position (m) after every 50 samples and the last, and the length (m).
fn on_host<T: Scalar, N: Navigator<T>>(samples: &[Sample]) -> (Vec<(i64, [f64; 3])>, f64) {
    let mut tracker = Tracker::<T, N>::new(Config::default());
    let mut time_us = 0;
    let mut path = Vec::new();
    for (index, sample) in samples.iter().enumerate() {
        time_us += u64::from(sample.elapsed_us);
        let estimate = tracker
            .update(&ImuSample {
                time_us,
                specific_force: SVector::from(sample.specific_force.map(T::from_f32)),
                angular_rate: SVector::from(sample.angular_rate.map(T::from_f32)),
            })
            .expect("a sensor can measure this");
        if (index + 1) % 50 == 0 || index + 1 == samples.len() {
            path.push((time_us as i64, estimate.position.as_array().map(T::to_f64)));
        }
    }
    tracker.finish();
    (path, tracker.path_length().to_f64())
}

/// The largest mean number of instructions of a sample: over the whole walk, in swing, and in stance.
struct Budget {
    walk: f64,
    swing: f64,
    stance: f64,
}

fn check<T: Scalar, N: Navigator<T>>(
    target: &'static Target,
    image: &str,
    budget: Option<&Budget>,
) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let samples = walk();
    let output = images.run(image, &samples.encode())?;
    println!("{}", Row::of(&images, image, &output)?);

    let (expected, _) = on_host::<T, N>(&samples);
    let told = output.positions()?;
    assert_eq!(told.len(), expected.len());
    for (told, (time_us, position)) in told.iter().zip(&expected) {
        assert_eq!(told.time_us, *time_us);
        for (ours, theirs) in told.metres.iter().zip(position) {
            // The arithmetic is bit for bit the same; positions are printed to the micrometre.
            assert!((ours - theirs).abs() < 3e-6, "{image} at {time_us} µs: {ours} or {theirs} m");
        }
    }
    check_budget(&output, image, budget)?;
    let elf = images.elf(image)?;
    assert_eq!(elf.panic_symbols(), Vec::<String>::new(), "{image} cannot panic");
    assert_eq!(elf.double_symbols(), Vec::<String>::new(), "{image} has no double precision");
    Ok(())
}

fn check_budget(output: &Output, image: &str, budget: Option<&Budget>) -> Result<()> {
    let swing = output.cost("step", "predict")?.context("the foot swings")?;
    let stance = output.cost("step", "update")?.context("the foot stands")?;
    println!(
        "    a sample in swing {:.0} ({} to {}), in stance {:.0} ({} to {}) instructions",
        swing.mean(),
        swing.min,
        swing.max,
        stance.mean(),
        stance.min,
        stance.max
    );
    if let Some(budget) = budget {
        let walk = swing.and(stance).mean();
        assert!(walk <= budget.walk, "{image}: {walk} instructions");
        assert!(swing.mean() <= budget.swing, "{image} in swing: {} instructions", swing.mean());
        assert!(
            stance.mean() <= budget.stance,
            "{image} in stance: {} instructions",
            stance.mean()
        );
    }
    Ok(())
}

fn check_all(target: &'static Target, lite: Option<&Budget>, ekf: Option<&Budget>) -> Result<()> {
    check::<f32, Lite<f32>>(target, "pedestrian-lite-f32", lite)?;
    check::<f32, Ekf<f32>>(target, "pedestrian-ekf-f32", ekf)?;
    check::<Q12_20, Lite<Q12_20>>(target, "pedestrian-lite-fixed", None)?;
    check::<Q12_20, Ekf<Q12_20>>(target, "pedestrian-ekf-fixed", None)
}

#[test]
fn cortex_m0() -> Result<()> {
    let lite = Budget { walk: 25_000.0, swing: f64::INFINITY, stance: f64::INFINITY };
    let ekf = Budget { walk: f64::INFINITY, swing: 45_000.0, stance: 100_000.0 };
    check_all(&CORTEX_M0, Some(&lite), Some(&ekf))
}

#[test]
fn cortex_m4f() -> Result<()> {
    // A step at a gyroscope's largest rates is shown to what knows where its range ends.
    let ekf = Budget { walk: f64::INFINITY, swing: 830.0, stance: 1_400.0 };
    check_all(&CORTEX_M4F, None, Some(&ekf))
}

#[test]
fn rv32imc() -> Result<()> {
    check_all(&RV32IMC, None, None)
}

#[test]
fn fixed_point_walks_as_far_as_single_precision() {
    let samples = walk();
    let (_, single) = on_host::<f32, Lite<f32>>(&samples);
    let (_, fixed) = on_host::<Q12_20, Lite<Q12_20>>(&samples);
    assert!((11.0..14.0).contains(&single), "the route is 12.6 m, not {single}");
    assert!((fixed / single - 1.0).abs() < 0.05, "fixed {fixed} m, single {single} m");
}
