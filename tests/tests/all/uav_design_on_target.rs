//! The aeroplane's observers designed on emulated boards: bit for bit the gains that the host finds.
//!
//! On a machine without the tools these tests print SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. With `--nocapture` they print the table of costs.

use anyhow::{Context, Result};
use kestirim_scalar::Columns;
use kestirim_tests::design;
use nalgebra::SMatrix;
use target_bench::{CORTEX_M4F, Images, Output, Profile, RV32IMC, Target};

/// The largest accepted cost of each design: its name, millions of instructions, bytes of stack.
const BUDGETS: [(&str, u64, i64); 3] =
    [("zero_order_hold", 6, 6 << 10), ("place", 110, 22 << 10), ("riccati", 95, 22 << 10)];

fn agree<const R: usize, const C: usize>(
    output: &Output,
    key: &str,
    host: &SMatrix<f64, R, C>,
) -> Result<()> {
    let bits = host.as_columns().map(|column| column.map(|number| number.to_bits() as i64));
    assert_eq!(output.rows::<R>(key)?, bits, "{key}: the very bits");
    Ok(())
}

fn designs(target: &'static Target, profile: Profile) -> Result<()> {
    let Some(images) = Images::of(target, profile)? else { return Ok(()) };
    let output = images.run("observer-design", &[])?;

    let plant = design::held()?;
    let kalman = design::settled(&plant)?;
    agree(&output, "a", &plant.a)?;
    agree(&output, "b", &plant.b)?;
    agree(&output, "luenberger", &design::placed(&plant)?.gain)?;
    agree(&output, "kalman_filter", &kalman.filter_gain)?;
    agree(&output, "kalman_predictor", &kalman.predictor_gain)?;

    let elf = images.elf("observer-design")?;
    assert_eq!(elf.panic_symbols(), Vec::<String>::new(), "the design cannot panic");
    let flash = elf.flash_bytes - images.elf("empty")?.flash_bytes;
    println!("{} at {}: all three take {flash} bytes of flash", target.triple, profile.opt());
    for (name, millions, most_stack) in BUDGETS {
        let cost = output.cost(name, "start")?.context("it was designed")?;
        let [stack] = output.numbers(&format!("{name}.stack"))?;
        println!(
            "  {name:16} {:6.1} million instructions, stack {stack} bytes",
            cost.max as f64 / 1e6
        );
        assert!(cost.max <= millions * 1_000_000, "{name}: {} instructions", cost.max);
        assert!(stack <= most_stack, "{name}: {stack} bytes of stack");
    }
    Ok(())
}

#[test]
fn cortex_m4f() -> Result<()> {
    designs(&CORTEX_M4F, Profile::Speed)?;
    designs(&CORTEX_M4F, Profile::Size)
}

#[test]
fn rv32imc() -> Result<()> {
    designs(&RV32IMC, Profile::Speed)?;
    designs(&RV32IMC, Profile::Size)
}
