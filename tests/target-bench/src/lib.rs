//! Measures the costs of the estimators on bare metal: builds the images of `tests/firmware`, runs them under QEMU, and
//! turns their output into rows of a table.
//!
//! ```no_run
//! use target_bench::{CORTEX_M0, Images, Profile, Row};
//!
//! # fn main() -> anyhow::Result<()> {
//! let Some(images) = Images::of(&CORTEX_M0, Profile::Speed)? else { return Ok(()) }; // skipped
//! let output = images.run("integrator", &[])?;
//! println!("{}", Row::of(&images, "integrator", &output)?);
//! # Ok(())
//! # }
//! ```

mod app;
#[path = "../../firmware/images/src/augmented_model.rs"]
pub mod augmented_model;
pub mod baseline;
mod elf;
mod form;
mod images;
mod output;
mod qemu;
mod row;
pub mod streams;
pub mod table;
mod target;
mod toolchain;
#[path = "../../firmware/images/src/uav.rs"]
pub mod uav;
pub mod workloads;

pub use app::{App, Run};
pub use elf::Elf;
pub use form::is_short;
pub use images::{Images, Profile};
pub use output::{Cost, Output, Position};
pub use row::Row;
pub use target::{CORTEX_M0, CORTEX_M4F, RV32IMC, TARGETS, Target};
pub use toolchain::Apart;
