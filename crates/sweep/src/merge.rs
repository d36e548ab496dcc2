//! Merging of shards into one whole, or a sentence on why they do not form one.

use std::fs;
use std::path::{Path, PathBuf};

use crate::table::{ENDINGS, Reader, Tail, Writer};
use crate::{Error, Head, Plan, Program, Samples, Value, Work};

/// Shards that form one whole: without holes or overlaps, of one plan, by one program.
#[derive(Debug)]
pub struct Merge {
    /// The shards, in the order of their rows.
    shards: Vec<(PathBuf, Head)>,
    /// The tails of all shards, taken together.
    pub tail: Tail,
}

/// A row of a merge.
#[derive(Debug)]
pub struct Row<'a> {
    /// The number of its study in the plan.
    pub study: usize,
    /// The index of its block among all blocks of the plan.
    pub block: usize,
    /// The number of its trial.
    pub trial: u64,
    /// The values of the trial, in the order of the block's columns.
    pub values: &'a [Value],
}

impl Merge {
    /// Opens the shards of a folder and checks them against each other.
    ///
    /// # Errors
    /// [`Error::Refused`], naming a hole, an overlap, different plans or another program; [`Error::Read`] and
    /// [`Error::File`] for files that are not shards.
    pub fn open(folder: &Path) -> Result<Self, Error> {
        let mut shards = Vec::new();
        let mut tail = Tail::default();
        for path in files(folder)? {
            let reader = Reader::open(&path)?;
            let head: Head = serde_json::from_value(reader.head)
                .map_err(|_| Error::file(&path, "expected a shard of a sweep"))?;
            if reader.tail.rows != head.count {
                let (rows, count) = (reader.tail.rows, head.count);
                return Err(Error::file(&path, format!("expected {count} rows, found {rows}")));
            }
            tail.rows += head.count;
            tail.inputs.extend(reader.tail.inputs);
            tail.warnings.extend(reader.tail.warnings);
            shards.push((path, head));
        }
        shards.sort_by_key(|(_, head)| (head.first, head.count));
        let mut merge = Self { shards, tail };
        merge.refuse_others()?;
        merge.refuse_holes()?;
        merge.refuse_other_inputs()?;
        Ok(merge)
    }

    fn refuse_others(&mut self) -> Result<(), Error> {
        let (first, rest) = self
            .shards
            .split_first()
            .ok_or_else(|| Error::Refused("expected shards of a sweep, found none".to_owned()))?;
        let this = Program::this();
        let name = |path: &Path| path.display().to_string();
        if first.1.program.words() != this.words() {
            let (path, by) = (name(&first.0), first.1.program.words());
            return Err(Error::Refused(format!(
                "{path} is by {by}, this program is {}",
                this.words()
            )));
        }
        for (path, head) in rest {
            let (one, other) = (name(&first.0), name(path));
            if head.plan_sha256 != first.1.plan_sha256 {
                return Err(Error::Refused(format!("{one} and {other} are of different plans")));
            }
            if head.program.words() != first.1.program.words() {
                let by = head.program.words();
                return Err(Error::Refused(format!("{other} is by {by}, {one} is not")));
            }
            if head.program.target != first.1.program.target {
                let (a, b) = (&first.1.program.target, &head.program.target);
                self.tail.warnings.push(format!(
                    "{one} was made on {a}, {other} on {b}: their last bits may differ from those of one machine"
                ));
            }
        }
        Ok(())
    }

    fn refuse_holes(&self) -> Result<(), Error> {
        let all = self.shards.first().map_or(0, |(_, head)| head.of);
        let missing = |from: u64, to: u64| {
            Error::Refused(format!("rows {from} to {} of {all} are missing", to - 1))
        };
        let (mut next, mut before) = (0, None);
        for (path, Head { first, count, .. }) in self.shards.iter().filter(|(_, it)| it.count > 0) {
            if *first > next {
                return Err(missing(next, *first));
            }
            if let Some(before) = before.filter(|_| *first < next) {
                let before: &Path = before;
                let (one, other) = (before.display(), path.display());
                return Err(Error::Refused(format!("{one} and {other} have rows in common")));
            }
            next = first.saturating_add(*count);
            before = Some(path);
        }
        if next < all { Err(missing(next, all)) } else { Ok(()) }
    }

    fn refuse_other_inputs(&mut self) -> Result<(), Error> {
        let inputs = &mut self.tail.inputs;
        inputs.sort_unstable();
        inputs.dedup();
        match inputs.windows(2).find(|pair| pair[0].path == pair[1].path) {
            Some(pair) => {
                let path = &pair[0].path;
                Err(Error::Refused(format!("{path} was not the same file for all shards")))
            }
            None => Ok(()),
        }
    }

    /// The plan of the shards.
    pub fn plan(&self) -> Plan {
        self.shards.first().map(|(_, head)| head.plan.clone()).unwrap_or_default()
    }

    /// Hands each row to `take`, in the order of a single run.
    ///
    /// # Errors
    /// [`Error::File`] and [`Error::Line`] for rows that are not those of the plan, and the errors of `take`.
    pub fn rows(
        &self,
        work: &Work,
        mut take: impl FnMut(Row<'_>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let studies: Vec<_> = work.blocks().map(|(study, _)| study).collect();
        let names: Vec<_> = work.columns().iter().map(|column| column.name.as_str()).collect();
        let (mut row, mut values, mut at) = (Vec::new(), Vec::new(), None);
        let mut columns = Vec::new();
        for (path, head) in &self.shards {
            let mut reader = Reader::open(path)?;
            if head.of != work.rows() || reader.columns != names {
                return Err(Error::file(path, "its columns or trials are not those of the plan"));
            }
            for number in head.first..head.first + head.count {
                if !reader.read(&mut row)? {
                    return Err(Error::file(path, "has fewer rows than it says"));
                }
                let told = work.told(number);
                if !row.iter().zip(&told).all(|(found, told)| same(found, told)) {
                    let [study, block, trial] = told;
                    let problem = format!("expected study {study}, {block}, trial {trial}");
                    let line = (number - head.first) as usize + 3;
                    return Err(Error::Line { path: path.clone(), line, problem });
                }
                let (block, trial) = work.place(number);
                if at != Some(block) {
                    (at, columns) = (Some(block), work.columns_of(block));
                }
                values.clear();
                values.extend(columns.iter().map(|&column| row[column].clone()));
                take(Row { study: studies[block], block, trial, values: &values })?;
            }
            if reader.read(&mut row)? {
                return Err(Error::file(path, "has more rows than it says"));
            }
        }
        Ok(())
    }

    /// Writes all rows into one file, as a single shard would have.
    ///
    /// # Errors
    /// Those of [`rows`](Self::rows), and [`Error::Write`].
    pub fn write(&self, work: &Work, path: &Path) -> Result<(), Error> {
        let mut file = Writer::create(path, work.columns(), &work.head(&(0..work.rows())))?;
        let mut all = vec![Value::Missing; work.columns().len()];
        let (mut number, mut at, mut columns) = (0, None, Vec::new());
        self.rows(work, |row| {
            if at != Some(row.block) {
                (at, columns) = (Some(row.block), work.columns_of(row.block));
                all.fill(Value::Missing);
            }
            all[..3].clone_from_slice(&work.told(number));
            for (&column, value) in columns.iter().zip(row.values) {
                all[column] = value.clone();
            }
            number += 1;
            file.write(&all)
        })?;
        file.finish(&self.tail)
    }

    /// Hands the numbers of each study to `fold`, one block after the other, to be folded as a single run folds them.
    ///
    /// # Errors
    /// Those of [`rows`](Self::rows).
    pub fn studies(
        &self,
        work: &Work,
        mut fold: impl FnMut(usize, Vec<Samples>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let blocks: Vec<_> = work.blocks().collect();
        let empty = |study: usize| {
            let of_study = blocks.iter().filter(move |(of, _)| *of == study);
            of_study.map(|(_, block)| Samples::new(block.columns.len())).collect::<Vec<_>>()
        };
        let first = |study: usize| blocks.partition_point(|(of, _)| *of < study);
        let mut counted = |study: usize, samples: Vec<Samples>| {
            let of_study = blocks[first(study)..].iter().zip(samples);
            fold(study, of_study.map(|((_, block), samples)| block.counted(samples)).collect())
        };
        let (mut study, mut samples) = (0, empty(0));
        self.rows(work, |row| {
            while study < row.study {
                counted(study, std::mem::replace(&mut samples, empty(study + 1)))?;
                study += 1;
            }
            let numbers = row.values.iter().map(|value| value.number().unwrap_or(f64::NAN));
            samples[row.block - first(study)].push(numbers);
            Ok(())
        })?;
        for rest in study..work.plan().studies.len() {
            counted(rest, std::mem::replace(&mut samples, empty(rest + 1)))?;
        }
        Ok(())
    }
}

/// Whether a value in a file equals the expected one; text files hold numbers as texts.
fn same(found: &Value, told: &Value) -> bool {
    match told {
        Value::Number(number) => found.number() == Some(*number),
        told => found == told,
    }
}

/// The files of rows in a folder, without the hidden ones, which are drafts.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(Error::read(folder))? {
        let path = entry.map_err(Error::read(folder))?.path();
        let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        let ending = path.extension().map(|it| it.to_string_lossy().to_ascii_lowercase());
        let known = ENDINGS.iter().chain(&["parquet"]).any(|it| Some(*it) == ending.as_deref());
        if known && !hidden && path.is_file() {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
