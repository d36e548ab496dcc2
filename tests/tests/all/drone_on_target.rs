//! The drone's filter on emulated boards: the same estimates as on the host, within the budgets.
//!
//! On a machine without the tools these tests say SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result};
use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::{Particles, Region, Xoshiro128PlusPlus};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_user_locator::{PublishedLocator, PublishedSettings};
use rand_core::SeedableRng;
use target_bench::streams::{Encode, Records, circle};
use target_bench::{
    CORTEX_M0, CORTEX_M4F, Images, Output, Profile, RV32IMC, Row, Target, is_short,
};

/// The largest difference, m: the arithmetic is bit for bit the same, and the numbers are printed with the 24 bits of
/// an `f32`, in micrometres.
const SAME: f64 = 0.5e-6;

const WAVELENGTH: f64 = 0.15;

fn channel<T: Scalar>() -> Channel<T> {
    Channel::new(&Environment::urban(), T::from_f64(WAVELENGTH)).expect("a channel")
}

/// The mean and spread of the cloud after each step, as the image computes them.
fn estimates<T: Scalar, const L: usize>(records: &Records) -> Vec<[f32; 3]> {
    let region = Region::new([T::ZERO; 2], [T::from_f64(2000.0); 2]).expect("a city");
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let settings = PublishedSettings::thesis();
    let mut locator = PublishedLocator::<T, L>::new(channel(), &region, settings, &mut rng);
    let step = |record: &[f32; 4]| {
        let [x, y, height, loss] = record.map(T::from_f32);
        let measurement = Measurement::new([x, y], height, loss).expect("a measurement");
        locator.measure(&measurement, &mut rng).expect("somebody explains it");
        let moments = locator.moments();
        let [x, y] = moments.mean();
        [x, y, moments.spread()].map(T::to_f32)
    };
    records.iter().map(step).collect()
}

/// Runs an image and compares its output after each step with the host.
fn agree(images: &Images, image: &str, stream: &[u8], host: &[[f32; 3]]) -> Result<Output> {
    let output = images.run(image, stream)?;
    let row = Row::of(images, image, &output)?;
    println!("{row}");
    let told = output.positions()?;
    assert_eq!(told.len(), host.len());
    let mut apart = 0_f64;
    for (told, host) in told.iter().zip(host) {
        for (ours, theirs) in told.metres.iter().zip(host) {
            // Rounded as the image prints it.
            let theirs = f64::from((theirs * 1e6) as i32) * 1e-6;
            apart = apart.max((ours - theirs).abs());
        }
    }
    println!("    at most {apart} m apart");
    assert!(apart < SAME, "{image}: {apart} m apart");
    let elf = images.elf(image)?;
    assert_eq!(elf.panic_symbols(), Vec::<String>::new(), "{image} cannot panic");
    assert_eq!(elf.double_symbols(), Vec::<String>::new(), "{image} has no double precision");
    Ok(output)
}

/// Checks the budgets: the largest number of instructions per particle and step, in `f32` and in fixed point. The short
/// form runs those that have one.
fn check<const L: usize>(target: &'static Target, budgets: [f64; 2]) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let records = circle();
    let stream = records.encode();
    let cases = [
        ("locator-f32", estimates::<f32, L>(&records)),
        ("locator-fixed", estimates::<Q16_16, L>(&records)),
    ];
    for ((image, host), budget) in cases.into_iter().zip(budgets) {
        if is_short() && budget.is_infinite() {
            continue;
        }
        let output = agree(&images, image, &stream, &host)?;
        let cost = output.cost("step", "update")?.context("every step is an update")?;
        let [mean, min, max] = [cost.mean(), cost.min as f64, cost.max as f64]
            .map(|instructions| instructions / L as f64);
        println!("    L = {L}: {mean:.0} instructions a particle ({min:.0} to {max:.0})");
        assert!(mean <= budget, "{image}: {mean} instructions a particle");
    }
    Ok(())
}

#[test]
fn five_hundred_particles_fit_into_eight_kilobytes() {
    assert!(size_of::<Particles<f32, 2, 500>>() <= 8192);
}

#[test]
fn cortex_m0() -> Result<()> {
    check::<100>(&CORTEX_M0, [f64::INFINITY, 4_000.0])
}

#[test]
fn cortex_m4f() -> Result<()> {
    check::<500>(&CORTEX_M4F, [900.0, f64::INFINITY])
}

#[test]
fn rv32imc() -> Result<()> {
    check::<500>(&RV32IMC, [f64::INFINITY; 2])
}
