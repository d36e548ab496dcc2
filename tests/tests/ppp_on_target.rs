//! Precise point positioning on emulated boards: the very positions that the host finds, within the budgets.
//!
//! On a machine without the tools these tests say SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result, ensure};
use kestirim_ppp_filter::{Config, Estimator, Motion, SatelliteReport};
use kestirim_tests::firmware::{CORTEX_M4F, Images, Output, Profile, RV32IMC, Target};
use kestirim_tests::ppp::{EPOCHS, Epochs, Filter, OUTLIERS, receiver, station};
use nalgebra::Vector3;

/// What host and target may differ by, m.
const TOLERANCE: f64 = 1e-6;
/// Static variables, filter and stack at most, bytes.
const MEMORY: u64 = 64 << 10;
/// The whole image at most, bytes.
const FLASH: u64 = 256 << 10;

/// What an epoch told: x y z, the receiver's clock and the wet delay, m; how many codes and phases were treated.
type Told = ([f64; 5], [i64; 2]);

fn config(estimator: Option<Estimator>) -> Config {
    let default = Config::new(Motion::Static);
    Config { estimator: estimator.unwrap_or(default.estimator), ..default }
}

/// The image `ppp` on the host.
fn on_host(config: Config) -> Result<Vec<Told>> {
    let mut filter = Filter::new(config);
    let solve = |epoch: kestirim_tests::ppp::Epoch| {
        let solution = filter.process(epoch.time, &receiver(), &epoch.sightings)?;
        let [x, y, z] = solution.position.data.0[0];
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

/// What the image told of one filter.
fn on_target(output: &Output, filter: &str) -> Result<Vec<Told>> {
    let solutions = output.rows::<5>(&format!("{filter}.solution"))?;
    let treated = output.rows::<2>(&format!("{filter}.treated"))?;
    ensure!(solutions.len() == treated.len(), "a line of either kind an epoch");
    let numbers = |bits: [i64; 5]| bits.map(|bits| f64::from_bits(bits as u64));
    Ok(solutions.into_iter().map(numbers).zip(treated).collect())
}

fn distance([x, y, z, ..]: [f64; 5], from: &Vector3<f64>) -> f64 {
    (Vector3::new(x, y, z) - from).norm()
}

#[test]
fn the_station_is_found_despite_outliers() -> Result<()> {
    let default = on_host(config(None))?;
    let plain = on_host(config(Some(Estimator::plain())))?;
    assert_eq!((default.len(), plain.len()), (EPOCHS, EPOCHS));
    for (index, (&(default, treated), &(plain, _))) in default.iter().zip(&plain).enumerate() {
        let [ours, theirs] = [default, plain].map(|solution| distance(solution, &station()));
        println!("epoch {index}: default {ours:.3} m, plain {theirs:.3} m from the station");
        assert!(ours < 2.5, "epoch {index}: {ours} m");
        let (wrong, expected) = if index == OUTLIERS { (theirs, [1, 1]) } else { (0.0, [0, 0]) };
        assert_eq!(treated, expected, "epoch {index}: what is wrong is treated, and nothing else");
        assert!(wrong == 0.0 || wrong > 2.0 * ours, "the plain filter believes it: {wrong} m");
    }
    Ok(())
}

/// What an epoch may cost at most, in thousands of instructions: the first, one with good observations, one with
/// outliers; of the default filter and of the plain one. And bytes of stack.
struct Budgets {
    default: [u64; 3],
    plain: [u64; 3],
    stack: u64,
}

fn check(target: &'static Target, budgets: &Budgets) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let output = images.run("ppp", &[])?;
    let elf = images.elf("ppp")?;
    let [object] = output.numbers("object_bytes")?;
    println!(
        "{}: flash {} bytes ({} without the filter), static RAM {}, filter {object}",
        target.triple,
        elf.flash_bytes,
        images.elf("empty")?.flash_bytes,
        elf.ram_bytes
    );
    assert!(elf.flash_bytes < FLASH, "{} bytes of flash", elf.flash_bytes);

    let mut deepest = 0;
    let filters = [
        ("default", config(None), budgets.default),
        ("plain", config(Some(Estimator::plain())), budgets.plain),
    ];
    for (filter, config, budgets) in filters {
        let (host, target) = (on_host(config)?, on_target(&output, filter)?);
        assert_eq!((host.len(), target.len()), (EPOCHS, EPOCHS));
        let mut farthest = 0.0_f64;
        for (&(ours, treated), &(theirs, same)) in host.iter().zip(&target) {
            let [x, y, z, ..] = ours;
            farthest = farthest.max(distance(theirs, &Vector3::new(x, y, z)));
            assert_eq!(treated, same);
        }
        let bits = |told: &[Told]| -> Vec<_> {
            told.iter().map(|(solution, _)| solution.map(f64::to_bits)).collect()
        };
        let verdict = if bits(&host) == bits(&target) { "the very bits" } else { "not the bits" };
        println!("  {filter}: {farthest:.1e} m from the host's positions ({verdict})");
        assert!(farthest <= TOLERANCE, "{farthest} m");

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
    let budgets =
        Budgets { default: [4_050, 3_400, 5_950], plain: [4_150, 3_550, 3_500], stack: 40 << 10 };
    check(&CORTEX_M4F, &budgets)
}

#[test]
fn rv32imc() -> Result<()> {
    let budgets = Budgets { default: [9_000; 3], plain: [9_000; 3], stack: 40 << 10 };
    check(&RV32IMC, &budgets)
}
