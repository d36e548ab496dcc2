//! One row of the table of costs.

use std::fmt;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::images::Images;
use crate::output::{Cost, Output};

/// The classes of steps; an image prints those that occurred.
const CLASSES: [&str; 4] = ["predict", "update", "rejected", "start"];

/// The costs of a workload on a target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The name of the workload.
    pub name: String,
    /// The full target triple.
    pub target: String,
    /// The workload's number type: `f32`, `q12.20` …
    pub scalar: String,
    /// The optimisation level, `3` or `s`.
    pub opt: String,
    /// The mean number of instructions of a step, over all classes.
    pub instructions_mean: f64,
    /// The instructions of the shortest step.
    pub instructions_min: u64,
    /// The instructions of the longest step.
    pub instructions_max: u64,
    /// The size of code and constants in excess of the empty image, bytes.
    pub flash_bytes: i64,
    /// The size of static variables, bytes.
    pub ram_bytes: u64,
    /// The size of the estimator itself, including its configuration of sensors and noise, bytes.
    pub object_bytes: u64,
    /// The peak stack use of a step, bytes.
    pub stack_bytes: u64,
    /// The number of linked parts of the panic machinery.
    pub panic_symbols: usize,
    /// The number of linked double-precision routines.
    pub double_symbols: usize,
}

impl Row {
    /// Makes a row from an image and its output.
    ///
    /// # Errors
    /// The image took no step, or its output lacks what belongs in a row.
    pub fn of(images: &Images, image: &str, output: &Output) -> Result<Self> {
        Self::of_meter(images, image, output, "step")
    }

    /// Makes a row from one meter of an image with several.
    ///
    /// # Errors
    /// As [`Row::of`].
    pub fn of_meter(images: &Images, image: &str, output: &Output, meter: &str) -> Result<Self> {
        let mut steps: Option<Cost> = None;
        for class in CLASSES {
            if let Some(cost) = output.cost(meter, class)? {
                steps = Some(steps.map_or(cost, |sum| sum.and(cost)));
            }
        }
        let steps = steps.context("the image took no step")?;
        let elf = images.elf(image)?;
        let empty = images.elf("empty")?;
        let [object_bytes] = output.numbers("object_bytes")?;
        let [stack_bytes] = output.numbers(&format!("{meter}.stack"))?;
        Ok(Self {
            name: output.text("name")?.to_owned(),
            target: images.target.triple.to_owned(),
            scalar: output.text("scalar")?.to_owned(),
            opt: images.profile.opt().to_owned(),
            instructions_mean: steps.mean(),
            instructions_min: steps.min,
            instructions_max: steps.max,
            flash_bytes: elf.flash_bytes as i64 - empty.flash_bytes as i64,
            ram_bytes: elf.ram_bytes,
            object_bytes: object_bytes as u64,
            stack_bytes: stack_bytes as u64,
            panic_symbols: elf.panic_symbols().len(),
            double_symbols: elf.double_symbols().len(),
        })
    }

    /// The fields that identify a row.
    pub fn key(&self) -> [&str; 4] {
        [&self.name, &self.scalar, &self.target, &self.opt]
    }

    /// Whether the row measures another crate's filter.
    pub fn is_peer(&self) -> bool {
        is_peer(&self.name)
    }

    /// The relative spread of the steps: (max − min)/mean.
    pub fn jitter(&self) -> f64 {
        (self.instructions_max - self.instructions_min) as f64 / self.instructions_mean
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [name, scalar, target, opt] = self.key();
        write!(
            f,
            "{name} {scalar} on {target} at {opt}: {:.0} instructions a step ({} to {}), \
             flash {}, static RAM {}, object {}, stack {} bytes, {} panic and {} double symbols",
            self.instructions_mean,
            self.instructions_min,
            self.instructions_max,
            self.flash_bytes,
            self.ram_bytes,
            self.object_bytes,
            self.stack_bytes,
            self.panic_symbols,
            self.double_symbols,
        )
    }
}

/// Whether an image of this name runs another crate's filter.
pub(crate) fn is_peer(name: &str) -> bool {
    name.starts_with("peer-")
}
