//! The costs of the elementary functions on emulated boards. With `--nocapture` the table is printed.

use anyhow::{Context, Result};
use target_bench::{CORTEX_M0, CORTEX_M4F, Images, Profile, RV32IMC, Target};

/// The largest accepted cost of a fixed-point function on a Cortex-M0, in instructions.
const BUDGETS: [(&str, f64); 4] = [("sin", 210.0), ("atan2", 600.0), ("exp", 250.0), ("ln", 250.0)];
const OTHERS: [&str; 7] = ["sin_cos", "sqrt", "hypot", "recip", "multiply", "divide", "divisor"];

fn table(target: &'static Target, budgets: bool) -> Result<()> {
    let Some(images) = Images::of(target, Profile::Speed)? else { return Ok(()) };
    let output = images.run("functions", &[])?;
    println!("instructions on {}: mean (min to max)", target.triple);
    let others = OTHERS.map(|name| (name, f64::INFINITY));
    for (name, budget) in BUDGETS.into_iter().chain(others) {
        for scalar in ["q12.20", "f32"] {
            let cost = output.cost(&format!("{name} {scalar}"), "predict")?.context("it ran")?;
            println!("  {name:8} {scalar:6} {:6.0} ({} to {})", cost.mean(), cost.min, cost.max);
            if budgets && scalar == "q12.20" {
                assert!(cost.mean() <= budget, "{name}: {} instructions", cost.mean());
            }
        }
    }
    Ok(())
}

#[test]
fn cortex_m0() -> Result<()> {
    table(&CORTEX_M0, true)
}

#[test]
fn cortex_m4f() -> Result<()> {
    table(&CORTEX_M4F, false)
}

#[test]
fn rv32imc() -> Result<()> {
    table(&RV32IMC, false)
}
