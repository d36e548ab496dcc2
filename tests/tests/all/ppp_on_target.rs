//! Precise point positioning on emulated boards: the same positions as on the host, bit for bit, within the budgets.
//!
//! On a machine without the tools these tests print SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result, ensure};
use kestirim_ppp_filter::{Config, Estimator, Lean, Motion, SatelliteReport};
use kestirim_robust_kalman::Reweighting;
use kestirim_scalar::Components;
use kestirim_tests::ppp::{EPOCHS, Epoch, Epochs, Filter, OUTLIERS, receiver, station};
use nalgebra::Vector3;
use target_bench::{CORTEX_M4F, Images, Output, Profile, RV32IMC, Target};

/// The largest accepted size of static variables, filter and stack, bytes.
const MEMORY: u64 = 64 << 10;
/// The largest accepted size of the whole image, bytes.
const FLASH: u64 = 256 << 10;

/// The results of an epoch: x, y, z, the receiver's clock and the wet delay, m; and the numbers of codes and phases
/// that were treated.
type Told = ([f64; 5], [i64; 2]);

/// The settings of the image's filters, by name.
fn config(filter: &str) -> Config<Lean> {
    let mut config = Config::new(Motion::Static).with_estimator(Estimator::at_rest());
    if filter != "gradients" {
        config.gradient = 0.0;
    }
    if filter == "plain" {
        config.estimator.robust.reweighting = Reweighting::Never;
        config.estimator.patience = None;
    }
    config
}

/// The results of the image `ppp`, computed on the host.
fn on_host(filter: &str) -> Result<Vec<Told>> {
    let mut filter = Filter::new(config(filter));
    let solve = |epoch: Epoch| {
        let solution = filter.process(epoch.time, &receiver(), &epoch.observations)?;
        let [x, y, z] = *solution.position.as_array();
        let treated = |is: fn(&SatelliteReport) -> bool| {
            solution.satellites.iter().filter(|report| is(report)).count() as i64
        };
        Ok((
            [x, y, z, solution.clock, solution.wet_delay],
            [
                treated(|report| report.code.was_treated()),
                treated(|report| report.phase.was_treated()),
            ],
        ))
    };
    Epochs::at(station()).map(solve).collect()
}

/// The results that the image printed for one filter.
fn on_target(output: &Output, filter: &str) -> Result<Vec<Told>> {
    let solutions = output.rows::<5>(&format!("{filter}.solution"))?;
    let treated = output.rows::<2>(&format!("{filter}.treated"))?;
    ensure!(solutions.len() == treated.len(), "a line of either kind an epoch");
    let numbers = |bits: [i64; 5]| bits.map(|bits| f64::from_bits(bits as u64));
    Ok(solutions.into_iter().map(numbers).zip(treated).collect())
}

#[test]
fn the_station_is_found_despite_outliers() -> Result<()> {
    let default = on_host("default")?;
    let plain = on_host("plain")?;
    assert_eq!((default.len(), plain.len()), (EPOCHS, EPOCHS));
    for (index, (&(default, treated), &(plain, _))) in default.iter().zip(&plain).enumerate() {
        let [ours, theirs] =
            [default, plain].map(|[x, y, z, ..]| (Vector3::new(x, y, z) - station()).norm());
        println!("epoch {index}: default {ours:.3} m, plain {theirs:.3} m from the station");
        assert!(ours < 2.5, "epoch {index}: {ours} m");
        let wrong = if index == OUTLIERS { [1, 1] } else { [0, 0] };
        assert_eq!(treated, wrong, "epoch {index}: what is wrong is treated, and nothing else");
        if index == OUTLIERS {
            assert!(theirs > 5.0 * ours, "the plain filter believes it: {theirs} m");
        }
    }
    Ok(())
}

/// The largest accepted cost of an epoch, in thousands of instructions (of the first, of one with good observations, of
/// one with outliers; for the default filter without and with gradients, and for the plain one), and of stack, bytes.
struct Budgets {
    default: [u64; 3],
    gradients: [u64; 3],
    plain: [u64; 3],
    stack: u64,
}

fn check(target: &'static Target, profile: Profile, budgets: &Budgets) -> Result<()> {
    let Some(images) = Images::of(target, profile)? else { return Ok(()) };
    let output = images.run("ppp", &[])?;
    let elf = images.elf("ppp")?;
    let [object] = output.numbers("object_bytes")?;
    println!(
        "{} at {}: flash {} bytes ({} without the filter), static RAM {}, filter {object}",
        target.triple,
        profile.opt(),
        elf.flash_bytes,
        images.elf("empty")?.flash_bytes,
        elf.ram_bytes
    );
    assert!(elf.flash_bytes < FLASH, "{} bytes of flash", elf.flash_bytes);

    let mut deepest = 0;
    let filters =
        [("default", budgets.default), ("gradients", budgets.gradients), ("plain", budgets.plain)];
    for (filter, budgets) in filters {
        assert_eq!(on_target(&output, filter)?, on_host(filter)?, "{filter}: the very bits");
        for (kind, budget) in ["first", "clean", "outliers"].into_iter().zip(budgets) {
            let meter = format!("{filter} {kind}");
            let cost = output.cost(&meter, "update")?.context("there was such an epoch")?;
            let [stack] = output.numbers(&format!("{meter}.stack"))?;
            println!("  {meter:16} {:>9} instructions, stack {stack} bytes", cost.max);
            assert!(cost.max <= budget * 1_000, "{meter}: {} instructions", cost.max);
            deepest = deepest.max(stack as u64);
        }
    }
    assert!(deepest <= budgets.stack, "{deepest} bytes of stack");
    let memory = elf.ram_bytes + object as u64 + deepest;
    assert!(memory < MEMORY, "{memory} bytes");
    assert_eq!(elf.panic_symbols(), Vec::<String>::new(), "the filter cannot panic");
    Ok(())
}

#[test]
fn cortex_m4f() -> Result<()> {
    let [default, gradients, plain] =
        [[3_790, 3_260, 4_490], [4_240, 3_770, 5_360], [3_790, 3_260, 3_260]];
    check(&CORTEX_M4F, Profile::Speed, &Budgets { default, gradients, plain, stack: 30 << 10 })?;
    let [default, gradients, plain] =
        [[4_050, 3_420, 4_690], [4_520, 3_930, 5_570], [4_050, 3_420, 3_410]];
    check(&CORTEX_M4F, Profile::Size, &Budgets { default, gradients, plain, stack: 30 << 10 })
}

#[test]
fn rv32imc() -> Result<()> {
    let [default, gradients, plain] =
        [[4_220, 3_640, 4_980], [4_730, 4_200, 5_940], [4_210, 3_640, 3_630]];
    check(&RV32IMC, Profile::Speed, &Budgets { default, gradients, plain, stack: 34 << 10 })?;
    let [default, gradients, plain] =
        [[4_610, 3_890, 5_290], [5_140, 4_470, 6_280], [4_610, 3_890, 3_880]];
    check(&RV32IMC, Profile::Size, &Budgets { default, gradients, plain, stack: 30 << 10 })
}
