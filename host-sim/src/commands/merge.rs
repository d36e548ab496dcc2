//! `host-sim merge`: combines the shards of a sweep into one run.

use std::path::PathBuf;

use kestirim_sweep::{Merge, Study, Work};
use serde_json::{Value, json};

use super::archive;
use super::sweep::{asked, named, work};
use crate::system::{Experiment, Outputs};
use crate::{Error, output};

/// Options of `host-sim merge`.
#[derive(Debug, clap::Args)]
pub(super) struct Together {
    /// Where the files of all shards are
    #[arg(value_name = "FOLDER")]
    folder: PathBuf,
    /// Write all rows into one file; of recordings, a table with a line each
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Of every column its mean and deviation, from exact sums, and approximate percentiles, in memory that does not grow with the rows
    #[arg(long)]
    summary: bool,
    #[command(flatten)]
    outputs: Outputs,
}

impl Together {
    pub(super) fn run(&self) -> Result<(), Error> {
        self.outputs.check()?;
        let merge = Merge::open(&self.folder)?;
        let work = work(merge.plan())?;
        merge.tail.warnings.iter().for_each(|it| output::warn(&format!("warning: {it}")));
        if work.plan().logs.is_some() {
            return self.recordings(&merge, &work);
        }
        if let Some(out) = &self.out {
            merge.write(&work, out)?;
        }
        if self.summary { self.summary(&merge, &work) } else { self.experiments(&merge, &work) }
    }

    fn experiments(&self, merge: &Merge, work: &Work) -> Result<(), Error> {
        let studies = &work.plan().studies;
        let (mut reports, mut texts, mut failed) = (Vec::new(), Vec::new(), None);
        let folded = merge.studies(work, |number, samples| {
            let told = self.experiment(&studies[number], &samples, (number, studies.len()));
            match told {
                Ok((report, text)) => {
                    reports.push(report);
                    texts.push(text);
                }
                Err(error) => failed = failed.take().or(Some(error)),
            }
            Ok(())
        });
        folded?;
        failed.map_or(Ok(()), Err)?;
        if !self.outputs.json {
            return output::print(&texts.join("\n\n"));
        }
        let report = if reports.len() == 1 { reports.remove(0) } else { Value::Array(reports) };
        output::print(&report.to_string())
    }

    /// Prints the result of a study; a single study prints what `run` prints.
    fn experiment(
        &self,
        study: &Study,
        samples: &[kestirim_sweep::Samples],
        (number, of): (usize, usize),
    ) -> Result<(Value, String), Error> {
        let (system, run, cell) = asked(study)?;
        let with_chapter = self.outputs.any_file();
        let Experiment { report, text, chapter } =
            system.experiment(&run, &cell, samples, with_chapter)?;
        let outputs = self.outputs.of_study(number, of);
        chapter.map_or(Ok(()), |chapter| outputs.write(chapter))?;
        if of == 1 {
            return Ok((report, text));
        }
        let words = |(name, value): (&String, &String)| format!(", {name} {value}");
        let settings: String = study.settings.iter().map(words).collect();
        let title = format!("{number}: {}, seed {}{settings}", study.system, study.seed);
        Ok((json!({ "study": study, "report": report }), format!("{title}\n{}", text.trim_end())))
    }

    fn summary(&self, merge: &Merge, work: &Work) -> Result<(), Error> {
        let mut table = output::table();
        let names = [
            "study",
            "block",
            "column",
            "rows",
            "missing",
            "mean",
            "deviation",
            "least",
            "≈ 5 %",
            "≈ 50 %",
            "≈ 95 %",
            "greatest",
        ];
        table.set_header(names);
        let mut all = Vec::new();
        for mut column in merge.summary(work)? {
            let Some(it) = column.summary() else { continue };
            let [low, median, high] = it.approximate_percentiles;
            let numbers = [it.mean, it.deviation, it.least, low, median, high, it.greatest];
            let place = [column.study.to_string(), column.block.clone(), column.name.clone()];
            let counts = [it.count, it.missing].map(|count| count.to_string());
            let numbers = numbers.map(|number| format!("{number:.6e}"));
            table.add_row(place.into_iter().chain(counts).chain(numbers));
            let (study, block, name) = (column.study, &column.block, &column.name);
            all.push(json!({ "study": study, "block": block, "column": name, "summary": it }));
        }
        if self.outputs.json {
            return output::print(&json!({ "columns": all }).to_string());
        }
        output::print(&format!("{table}\n≈: approximately, by a t-digest; sums are exact"))
    }

    fn recordings(&self, merge: &Merge, work: &Work) -> Result<(), Error> {
        let plan = work.plan();
        let system = named(plan.studies.first().map_or("", |study| &study.system))?;
        let configs = archive::configs(system, plan)?;
        let settings: Vec<_> =
            configs.iter().map(|it| crate::text::command_line(it.arguments())).collect();
        let mut lines = Vec::new();
        merge.rows(work, |row| {
            lines.extend(kestirim_sweep::archive::lines(row.values, &settings));
            Ok(())
        })?;
        if let Some(out) = &self.out {
            archive::write(out, system, &lines, merge.tail.inputs.clone())?;
        }
        archive::conclude(&lines)
    }
}
