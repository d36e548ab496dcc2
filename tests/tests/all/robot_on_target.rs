//! The robot's filters on emulated boards: the same states as on the host, within the budgets.
//!
//! On a machine without the tools these tests say SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result};
use kestirim_adaptive_kalman::{AdaptiveKalman, Learning, ProcessNoise, PublishedAdaptiveKalman};
use kestirim_kalman::Covariance;
use kestirim_scalar::{Components, Q12_20, Scalar};
use kestirim_tests::common_scenario::{Ekf, anchors, expected, motion, start};
use kestirim_uwb_tracker::{Anchor, Config, RangeSample, Tracker};
use nalgebra::{SMatrix, SVector};
use target_bench::streams::{Common, Encode, PLACES, Ranges, ellipse};
use target_bench::{CORTEX_M0, CORTEX_M4F, Images, Output, Profile, RV32IMC, Row, Target};

/// The largest difference, m: the arithmetic is bit for bit the same, and positions are printed to the micrometre.
const SAME: f64 = 3e-6;

/// The states after each step, as the image computes them.
type Steps = Vec<[f64; 4]>;

fn ekf<T: Scalar>(ranges: &[[f64; 4]]) -> Steps {
    let mut filter = Ekf::<T>::new(0.1);
    ranges.iter().map(|ranges| filter.step(ranges)).collect()
}

fn aekf<T: Scalar>(ranges: &[[f64; 4]]) -> Steps {
    let number = T::from_f64;
    let learning = |least, most| Learning::new(number(0.95), number(least), number(most)).unwrap();
    let (position, velocity) = (learning(1e-5, 1e-2), learning(1e-3, 1e-1));
    let process = ProcessNoise::new(
        [1e-4, 1e-4, 2.5e-2, 2.5e-2].map(number),
        [position, position, velocity, velocity],
    );
    let learning = [learning(2.5e-3, 4.0); 4];
    let mut filter = AdaptiveKalman::new(start::<T>(), process, [number(0.01); 4], learning);
    let step = |row: &[f64; 4]| {
        filter.predict(&motion(0.0)).expect("a finite state");
        for (index, (anchor, &range)) in anchors::<T>().iter().zip(row).enumerate() {
            let (row, distance) = expected(&filter.estimate().mean, anchor);
            filter.update(index, &row, number(range) - distance).expect("a finite range");
        }
        *filter.estimate().mean.map(T::to_f64).as_array()
    };
    ranges.iter().map(step).collect()
}

fn published<T: Scalar>(ranges: &[[f64; 4]]) -> Steps {
    let number = T::from_f64;
    let mut from = start::<T>();
    from.covariance = Covariance::from_variances(&[1e-4, 1e-4, 0.0, 0.0].map(number));
    let (q, r) = (Covariance::from_variances(&[number(3e-5); 4]), [number(0.1); 4]);
    let forgetting = number(0.95);
    let noise = Covariance::from_variances(&r);
    let mut filter = PublishedAdaptiveKalman::new(from, q, noise, forgetting, forgetting).unwrap();
    let step = |row: &[f64; 4]| {
        filter.predict(&motion(0.0)).expect("a finite state");
        let mean = filter.estimate().mean;
        let (mut rows, mut innovation) = (SMatrix::<T, 4, 4>::zeros(), SVector::<T, 4>::zeros());
        for (index, (anchor, &range)) in anchors::<T>().iter().zip(row).enumerate() {
            let (row, distance) = expected(&mean, anchor);
            innovation[index] = number(range) - distance;
            for &(column, value) in row.entries() {
                rows[(index, column)] = value;
            }
        }
        filter.update(&rows, &innovation).expect("R stays positive with these constants");
        *filter.estimate().mean.map(T::to_f64).as_array()
    };
    ranges.iter().map(step).collect()
}

/// The ranges as an image receives them.
fn received(common: &Common) -> Vec<[f64; 4]> {
    common.ranges.iter().map(|row| row.map(|range| f64::from(range as f32))).collect()
}

fn tracked<T: Scalar, const D: usize, const N: usize, const A: usize>(samples: &Ranges) -> Steps {
    let anchors: Vec<_> = PLACES[..A]
        .iter()
        .map(|place| Anchor { position: SVector::from(place.map(T::from_f64)), bias: T::ZERO })
        .collect();
    let mut tracker =
        Tracker::<T, D, N, A>::new(Config::calibrated(T::ONE), &anchors).expect("they fit");
    let mut time_us = 0;
    let step = |&(elapsed_us, anchor, range): &(u32, usize, f32)| {
        time_us += u64::from(elapsed_us);
        tracker
            .range(&RangeSample { time_us, anchor, range: T::from_f32(range) })
            .expect("a range");
        let mut state = [0.0; 4];
        for (state, position) in state.iter_mut().zip(tracker.position().iter().flatten()) {
            *state = position.to_f64();
        }
        state
    };
    samples.iter().map(step).collect()
}

/// Runs an image and compares its output, every fifty steps, with the host.
fn agree(images: &Images, image: &str, stream: &[u8], host: &Steps) -> Result<Output> {
    let output = images.run(image, stream)?;
    let row = Row::of(images, image, &output)?;
    println!("{row}");
    let told = output.positions()?;
    assert_eq!(told.len(), host.len().div_ceil(50));
    for (index, told) in told.iter().enumerate() {
        let state = host[(50 * index + 49).min(host.len() - 1)];
        for (ours, theirs) in told.metres.iter().zip(state) {
            let what = format!("{image} after {} steps", 50 * index + 50);
            assert!((ours - theirs).abs() < SAME, "{what}: {ours} or {theirs} m");
            if told.metres[2] == 0.0 {
                break;
            }
        }
    }
    let elf = images.elf(image)?;
    assert_eq!(elf.panic_symbols(), Vec::<String>::new(), "{image} cannot panic");
    assert_eq!(elf.double_symbols(), Vec::<String>::new(), "{image} has no double precision");
    Ok(output)
}

/// The largest accepted mean numbers of instructions.
#[derive(Clone, Copy)]
struct Budgets {
    /// A prediction and four ranges, in `f32` and in fixed point.
    ekf: [f64; 2],
    /// A prediction and four ranges with both adaptations, and as published.
    aekf: [f64; 2],
    /// A range with gate and Huber weight, in the plane and in space, in `f32`.
    update: [f64; 2],
}

fn check(target: &'static Target, budgets: Budgets) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    check_four_ranges(&images, budgets)?;
    check_trackers(&images, budgets)
}

fn check_four_ranges(images: &Images, budgets: Budgets) -> Result<()> {
    let common = Common::read()?;
    let (ranges, stream) = (received(&common), common.encode());
    let cases = [
        ("ekf4-ranges4-f32", ekf::<f32>(&ranges), budgets.ekf[0]),
        ("ekf4-ranges4-q12-20", ekf::<Q12_20>(&ranges), budgets.ekf[1]),
        ("aekf4-ranges4-f32", aekf::<f32>(&ranges), budgets.aekf[0]),
        ("aekf4-ranges4-q12-20", aekf::<Q12_20>(&ranges), f64::INFINITY),
        ("aekf4-published-f32", published::<f32>(&ranges), budgets.aekf[1]),
    ];
    for (image, host, budget) in cases {
        let output = agree(images, image, &stream, &host)?;
        let cost = output.cost("step", "update")?.context("every step is an update")?;
        assert!(cost.mean() <= budget, "{image}: {} instructions", cost.mean());
    }
    Ok(())
}

fn check_trackers(images: &Images, budgets: Budgets) -> Result<()> {
    let (four, eight) = (ellipse(4), ellipse(8));
    let cases = [
        ("uwb-tracker-4-f32", &four, tracked::<f32, 2, 4, 4>(&four), budgets.update[0]),
        ("uwb-tracker-4-fixed", &four, tracked::<Q12_20, 2, 4, 4>(&four), f64::INFINITY),
        ("uwb-tracker-8-f32", &eight, tracked::<f32, 2, 4, 8>(&eight), budgets.update[0]),
        ("uwb-tracker-8-fixed", &eight, tracked::<Q12_20, 2, 4, 8>(&eight), f64::INFINITY),
        ("uwb-tracker-space-f32", &eight, tracked::<f32, 3, 6, 8>(&eight), budgets.update[1]),
        ("uwb-tracker-space-fixed", &eight, tracked::<Q12_20, 3, 6, 8>(&eight), f64::INFINITY),
    ];
    for (image, samples, host, budget) in cases {
        let output = agree(images, image, &samples.encode(), &host)?;
        for class in ["update", "predict", "rejected", "start"] {
            if let Some(cost) = output.cost("step", class)? {
                println!("    {class}: {:.0} ({} to {})", cost.mean(), cost.min, cost.max);
            }
        }
        let update = output.cost("step", "update")?.context("ranges are taken in")?;
        assert!(update.mean() <= budget, "{image}: {} instructions", update.mean());
        let [object_bytes] = output.numbers("object_bytes")?;
        assert!(object_bytes <= 1024, "{image}: {object_bytes} bytes");
    }
    Ok(())
}

const UNLIMITED: Budgets =
    Budgets { ekf: [f64::INFINITY; 2], aekf: [f64::INFINITY; 2], update: [f64::INFINITY; 2] };

#[test]
fn cortex_m0() -> Result<()> {
    check(&CORTEX_M0, Budgets { ekf: [f64::INFINITY, 20_000.0], ..UNLIMITED })
}

#[test]
fn cortex_m4f() -> Result<()> {
    let budgets =
        Budgets { ekf: [900.0, f64::INFINITY], aekf: [2_000.0; 2], update: [320.0, 500.0] };
    check(&CORTEX_M4F, budgets)
}

#[test]
fn rv32imc() -> Result<()> {
    check(&RV32IMC, UNLIMITED)
}
