//! `host-sim sweep`: runs a plan of many trials, or of many recordings, in shards.

use std::path::PathBuf;

use clap::ValueEnum as _;
use kestirim_sweep::{Job, Plan, Shard, Study, Work};

use super::archive;
use super::arguments::find;
use crate::system::{AnySystem, RunOptions, ScalarKind, Settings};
use crate::text::printable_path;
use crate::{Error, output};

/// The help of the option `--shard`.
const SHARD: &str = "One shard of N, counted from 0 [default: what HQ_TASK_ID, SLURM_ARRAY_TASK_ID or JOB_COMPLETION_INDEX \
                     says; else all that are not there yet]";

/// Options of `host-sim sweep`.
#[derive(Debug, clap::Args)]
pub(super) struct Sweep {
    /// What is to be tried
    #[arg(value_name = "PLAN.toml")]
    plan: PathBuf,
    #[arg(long, value_name = "I/N", help = SHARD)]
    shard: Option<Shard>,
    /// The shard's file, of the format that its ending says; a name without one is a folder for the files of shards
    #[arg(long, value_name = "FILE", default_value = "sweep")]
    out: PathBuf,
    /// Print how many shards there are and about what they cost, and do nothing
    #[arg(long)]
    jobs: bool,
}

impl Sweep {
    pub(super) fn run(&self) -> Result<(), Error> {
        let work = work(Plan::read(&self.plan)?)?;
        if self.jobs {
            return output::print(&Job::costs(&work)?);
        }
        let told = Shard::of_engine(|name| std::env::var(name).ok(), work.plan().shards);
        let shard = match (self.shard, told) {
            (Some(shard), _) => Some(shard),
            (None, told) => told.map_err(Error::Usage)?.map(|(shard, by)| {
                output::warn(&format!("shard {shard}, as {by} says"));
                shard
            }),
        };
        let job = Job::new(&work, shard, &self.out)?;
        let bar = output::progress(job.rows(), "rows");
        let made = job.run(&work, &|rows| bar.inc(rows));
        bar.finish_and_clear();
        made?;
        output::warn(&format!("rows: {}", printable_path(&self.out)));
        Ok(())
    }
}

/// The work of a plan: the trials of each of its studies.
pub(super) fn work(plan: Plan) -> Result<Work, Error> {
    let blocks = if let Some(logs) = &plan.logs {
        vec![vec![archive::block(&plan, logs)?]]
    } else {
        let blocks = plan.studies.iter().map(|study| {
            let (system, run, cell) = asked(study)?;
            system.trials(&run, &cell)
        });
        blocks.collect::<Result<_, _>>()?
    };
    Ok(Work::new(plan, blocks)?)
}

/// The system, options and settings of a study, as `run` would have them.
pub(super) fn asked(
    study: &Study,
) -> Result<(&'static dyn AnySystem, RunOptions, Settings), Error> {
    let system = named(&study.system)?;
    let scalar = study.scalar.as_deref().map(|text| {
        ScalarKind::from_str(text, false)
            .map_err(|_| Error::Usage(format!("scalar {text:?}: expected f32, f64 or fixed")))
    });
    let run = RunOptions { trials: study.trials, seed: study.seed, scalar: scalar.transpose()? };
    let mut cell = Settings::new(system.cell());
    study.settings.iter().try_for_each(|(name, text)| cell.set(name, text))?;
    Ok((system, run, cell))
}

/// The system that a plan names.
pub(super) fn named(name: &str) -> Result<&'static dyn AnySystem, Error> {
    find(name).ok_or_else(|| Error::Usage(format!("there is no system {name:?}")))
}
