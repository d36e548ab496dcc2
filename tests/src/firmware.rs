//! Builds the images of `tests/firmware` and runs them under QEMU.
//!
//! ```no_run
//! use kestirim_tests::firmware::{CORTEX_M0, Images, Profile, Row};
//!
//! # fn main() -> anyhow::Result<()> {
//! let Some(images) = Images::of(&CORTEX_M0, Profile::Speed)? else { return Ok(()) }; // skipped
//! let output = images.run("integrator", &[])?;
//! println!("{}", Row::of(&images, "integrator", &output)?);
//! # Ok(())
//! # }
//! ```

mod app;
mod elf;
mod images;
mod output;
mod qemu;
mod row;
mod stream;
mod target;
mod toolchain;

pub use app::{App, Run};
pub use elf::Elf;
pub use images::{Images, Profile};
pub use output::{Cost, Output, Position};
pub use row::Row;
pub use stream::{Sample, encode};
pub use target::{CORTEX_M0, CORTEX_M4F, RV32IMC, Target};
