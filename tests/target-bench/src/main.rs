//! Measures every estimator on every emulated board and prints the table.

use std::collections::BTreeMap;

use anyhow::{Result, ensure};
use clap::Parser;
use host_sim::output::{print, progress};
use serde::Serialize;
use target_bench::baseline::Baseline;
use target_bench::streams::Common;
use target_bench::{Images, Profile, Row, TARGETS, table, workloads};

/// What every estimator costs on a Cortex-M0, a Cortex-M4F and an RV32IMC, under QEMU: instructions a
/// step, flash, RAM and stack, beside other crates' filters on the same scenario.
#[derive(Parser)]
#[command(version)]
struct Options {
    /// One JSON object on standard output instead of a table
    #[arg(long)]
    json: bool,
    /// Keep the numbers as the baseline that the tests compare with
    #[arg(long, conflicts_with_all = ["only", "target"])]
    keep: bool,
    /// Only the workloads whose image's name begins like this: uwb-tracker
    #[arg(long, value_name = "NAME", default_value = "")]
    only: String,
    /// Only the targets whose triple begins like this: thumbv7em
    #[arg(long, value_name = "TRIPLE", default_value = "")]
    target: String,
}

#[derive(Serialize)]
struct Report {
    rows: Vec<Row>,
}

fn main() -> Result<()> {
    let options = Options::parse();
    if options.keep {
        ensure!(
            Common::read()?.reference.is_some(),
            "a baseline is of the common scenario with its noise"
        );
    }
    let mut compilers = BTreeMap::new();
    let mut rows = Vec::new();
    let targets = TARGETS.iter().filter(|target| target.triple.starts_with(&options.target));
    let bar = progress(2 * targets.clone().count() as u64, "targets");
    for target in targets {
        for profile in Profile::ALL {
            let images = Images::needed(target, profile)?;
            rows.extend(workloads::measure(&images, &options.only)?);
            compilers.insert(target.triple.to_owned(), images.compiler);
            bar.inc(1);
        }
    }
    bar.finish_and_clear();
    if options.keep {
        Baseline { compilers, rows: rows.clone() }.keep()?;
    }
    let text =
        if options.json { serde_json::to_string(&Report { rows })? } else { table::of(&rows) };
    Ok(print(&text)?)
}
