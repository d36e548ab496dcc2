//! A plan as rows: the row of each trial of each block, and the files of shards.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::table::{Reader, Tail, Writer};
use crate::{Block, Column, Error, Input, Kind, Plan, Program, Value};

/// The number of rows that are computed together.
const TOGETHER: u64 = 1024;
/// The largest number of blocks whose trials are timed.
const TIMED: usize = 24;
/// The number of trials of a block that are timed.
const TIMES: u64 = 3;
/// The number of columns before those of the blocks: study, block and trial.
const PLACE: usize = 3;

/// A plan with the blocks of its studies: all rows, in the order of studies, blocks and trials.
#[derive(Debug)]
pub struct Work {
    plan: Plan,
    hash: String,
    /// The number of the first row of each block, its study, and the block.
    blocks: Vec<(u64, usize, Block)>,
    rows: u64,
    columns: Vec<Column>,
}

/// The head of a shard's file, which precedes its rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Head {
    /// The program that made the file.
    #[serde(flatten)]
    pub program: Program,
    /// [`Plan::hash`].
    pub plan_sha256: String,
    /// The plan.
    pub plan: Plan,
    /// The seeds of the plan.
    pub seeds: Vec<u64>,
    /// The number of rows of the plan.
    pub of: u64,
    /// The number of the first row in the file.
    pub first: u64,
    /// The number of rows in the file.
    pub count: u64,
}

impl Work {
    /// Arranges the `blocks` of each study of a plan as rows.
    ///
    /// # Errors
    /// [`Error::Refused`] if there are more rows than can be counted, or two columns of a block have the same name.
    pub fn new(plan: Plan, blocks: Vec<Vec<Block>>) -> Result<Self, Error> {
        let mut columns: Vec<_> = ["study", "block", "trial"].map(Column::number).into();
        columns[0].kind = Kind::Whole;
        columns[1].kind = Kind::Text;
        columns[2].kind = Kind::Whole;
        let (mut rows, mut placed) = (0_u64, Vec::new());
        for (study, blocks) in blocks.into_iter().enumerate() {
            for block in blocks {
                let mut names: Vec<_> = block.columns.iter().map(|column| &column.name).collect();
                names.sort_unstable();
                let count = names.len();
                names.dedup();
                if names.len() < count {
                    let problem = format!("{} has two columns of one name", block.name);
                    return Err(Error::Refused(problem));
                }
                let known = |column: &Column| columns.iter().any(|it| it.name == column.name);
                let new: Vec<_> = block.columns.iter().filter(|it| !known(it)).cloned().collect();
                columns.extend(new);
                let first = rows;
                rows = rows.checked_add(block.trials).ok_or_else(|| {
                    Error::Refused("the plan has more trials than can be counted".to_owned())
                })?;
                placed.push((first, study, block));
            }
        }
        Ok(Self { hash: plan.hash(), plan, blocks: placed, rows, columns })
    }

    /// The plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The number of rows.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// The columns of every file of rows.
    pub(crate) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// All blocks in order, each with the number of its study.
    pub fn blocks(&self) -> impl Iterator<Item = (usize, &Block)> {
        self.blocks.iter().map(|(_, study, block)| (*study, block))
    }

    /// The position of a row: the index of its block among all blocks, and its trial.
    pub(crate) fn place(&self, row: u64) -> (usize, u64) {
        let place = self.blocks.partition_point(|(first, ..)| *first <= row).saturating_sub(1);
        // A block without trials begins at the same row as the next one; the last of them is taken.
        (place, row - self.blocks[place].0)
    }

    /// The columns of a file that hold a block's values.
    pub(crate) fn columns_of(&self, block: usize) -> Vec<usize> {
        let place = |column: &Column| self.columns.iter().position(|it| it.name == column.name);
        self.blocks[block].2.columns.iter().filter_map(place).collect()
    }

    /// Study, block and trial of a row, as they stand in its first columns.
    pub(crate) fn told(&self, row: u64) -> [Value; PLACE] {
        let (place, trial) = self.place(row);
        let (_, study, block) = &self.blocks[place];
        [Value::from(*study as f64), block.name.as_str().into(), Value::from(trial as f64)]
    }

    fn row(&self, row: u64) -> Result<Vec<Value>, String> {
        let (place, trial) = self.place(row);
        let values = self.blocks[place].2.row(trial)?;
        let mut all = vec![Value::Missing; self.columns.len()];
        all[..PLACE].clone_from_slice(&self.told(row));
        for (column, value) in self.columns_of(place).into_iter().zip(values) {
            all[column] = value;
        }
        Ok(all)
    }

    /// The head of the file of a range of rows.
    pub fn head(&self, range: &Range<u64>) -> Head {
        let mut seeds: Vec<_> = self.plan.studies.iter().map(|study| study.seed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        Head {
            program: Program::this(),
            plan_sha256: self.hash.clone(),
            plan: self.plan.clone(),
            seeds,
            of: self.rows,
            first: range.start,
            count: range.end - range.start,
        }
    }

    /// Whether the file of a range exists, is complete, and was made from this plan by this program.
    ///
    /// # Errors
    /// [`Error::File`] if something else is there, which is left unchanged.
    pub fn is_done(&self, range: &Range<u64>, path: &Path) -> Result<bool, Error> {
        if !path.exists() {
            return Ok(false);
        }
        let reader = Reader::open(path)?;
        let (head, expected) = (serde_json::from_value::<Head>(reader.head).ok(), self.head(range));
        let of = |it: &Head| (it.program.clone(), it.of, it.first, it.count);
        let problem = match head {
            Some(head) if head.plan_sha256 != expected.plan_sha256 => "of another plan",
            Some(head) if of(&head) != of(&expected) => "of another range, or by another program",
            Some(head) if reader.tail.rows == head.count => return Ok(true),
            _ => "no whole shard",
        };
        Err(Error::file(
            path,
            format!("is there already, {problem}; move it, or name another file"),
        ))
    }

    /// Computes a range of rows on all threads and writes its file; `done` is called after each row.
    ///
    /// # Errors
    /// [`Error::Refused`] with the sentence of a trial that fails, [`Error::Write`], and [`Error::Read`] of a
    /// recording; in these cases, no file is left.
    pub fn write(
        &self,
        range: Range<u64>,
        path: &Path,
        done: &(dyn Fn() + Sync),
    ) -> Result<(), Error> {
        let mut file = Writer::create(path, &self.columns, &self.head(&range))?;
        let mut next = range.start;
        while next < range.end {
            let end = next.saturating_add(TOGETHER).min(range.end);
            let rows: Result<Vec<_>, _> = (next..end)
                .into_par_iter()
                .map(|row| {
                    let values = self.row(row);
                    done();
                    values
                })
                .collect();
            for row in rows.map_err(Error::Refused)? {
                file.write(&row)?;
            }
            next = end;
        }
        file.finish(&Tail { inputs: self.inputs(&range)?, ..Tail::default() })
    }

    /// The recordings of a range of rows, and the other files that they need.
    fn inputs(&self, range: &Range<u64>) -> Result<Vec<Input>, Error> {
        let Some(logs) = &self.plan.logs else { return Ok(Vec::new()) };
        let of = range.clone().filter_map(|row| logs.paths.get(self.place(row).1 as usize));
        let with =
            |path: &PathBuf| logs.of(path).into_iter().flat_map(|(_, it)| it).chain([path.clone()]);
        // A recording that cannot be read has a row that says so.
        Input::all(of.flat_map(with).collect(), &self.plan.folder)
    }

    /// Estimates the time that all rows take on one core, by timing a few trials of some blocks.
    ///
    /// # Errors
    /// [`Error::Refused`] with the sentence of a trial that fails.
    pub fn estimate(&self) -> Result<Duration, Error> {
        let counted: Vec<_> = self.blocks().filter(|(_, block)| block.trials > 0).collect();
        let step = counted.len().div_ceil(TIMED).max(1);
        let (mut all, mut tried) = (0.0, 0);
        for (_, block) in counted.iter().step_by(step) {
            let row = |part: u64| block.row(block.trials / (TIMES + 1) * part);
            // The first trial, which finds code and memory cold, is not timed.
            row(0).map_err(Error::Refused)?;
            let begun = Instant::now();
            for part in 1..=TIMES {
                row(part).map_err(Error::Refused)?;
            }
            all += begun.elapsed().as_secs_f64() / TIMES as f64 * block.trials as f64;
            tried += block.trials;
        }
        let each = if tried == 0 { 0.0 } else { all / tried as f64 };
        Ok(Duration::try_from_secs_f64(each * self.rows as f64).unwrap_or(Duration::MAX))
    }
}
