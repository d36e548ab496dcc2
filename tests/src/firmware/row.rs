//! One row of the table of costs.

use std::fmt;

use anyhow::{Context, Result};

use super::images::Images;
use super::output::{Cost, Output};

/// The classes of steps; an image tells those that occurred.
const CLASSES: [&str; 4] = ["predict", "update", "rejected", "start"];

/// What a workload costs on a target.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The workload.
    pub name: String,
    /// The full triple.
    pub target: &'static str,
    /// The workload's number type: `f32`, `q12.20` …
    pub scalar: String,
    /// The optimisation level, `3` or `s`.
    pub opt: &'static str,
    /// Instructions a step, of all classes together.
    pub instructions: Cost,
    /// Code and constants over the empty image.
    pub flash_bytes: i64,
    /// Static variables.
    pub ram_bytes: u64,
    /// The estimator itself.
    pub object_bytes: i64,
    /// Peak stack of a step.
    pub stack_bytes: i64,
    /// How many parts of the panic machinery are linked.
    pub panic_symbols: usize,
    /// How many double-precision routines are linked.
    pub double_symbols: usize,
}

impl Row {
    /// Makes a row of an image and what it told.
    ///
    /// # Errors
    /// The image took no step, or did not tell what belongs in a row.
    pub fn of(images: &Images, image: &str, output: &Output) -> Result<Self> {
        let mut instructions: Option<Cost> = None;
        for class in CLASSES {
            if let Some(cost) = output.cost("step", class)? {
                instructions = Some(instructions.map_or(cost, |sum| sum.and(cost)));
            }
        }
        let elf = images.elf(image)?;
        let empty = images.elf("empty")?;
        let [object_bytes] = output.numbers("object_bytes")?;
        let [stack_bytes] = output.numbers("step.stack")?;
        Ok(Self {
            name: output.text("name")?.to_owned(),
            target: images.target.triple,
            scalar: output.text("scalar")?.to_owned(),
            opt: images.profile.opt(),
            instructions: instructions.context("the image took no step")?,
            flash_bytes: elf.flash_bytes as i64 - empty.flash_bytes as i64,
            ram_bytes: elf.ram_bytes,
            object_bytes,
            stack_bytes,
            panic_symbols: elf.panic_symbols().len(),
            double_symbols: elf.double_symbols().len(),
        })
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, target, scalar, opt, instructions: Cost { min, max, .. }, .. } = self;
        write!(
            f,
            "{name} {scalar} on {target} at {opt}: {:.0} instructions a step ({min} to {max}), \
             flash {}, static RAM {}, object {}, stack {} bytes, {} panic and {} double symbols",
            self.instructions.mean(),
            self.flash_bytes,
            self.ram_bytes,
            self.object_bytes,
            self.stack_bytes,
            self.panic_symbols,
            self.double_symbols,
        )
    }
}
