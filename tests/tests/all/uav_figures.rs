//! The book's figures of the UAV, which are some of the report's.
//!
//! `cargo test --release -p kestirim-tests --test all uav_figures:: -- --ignored`

use std::error::Error;

use host_sim::system::RunOptions;
use host_sim::systems::uav::{chapter, experiment};
use kestirim_tests::book;

#[test]
#[ignore = "makes the book's figures"]
fn figures() -> Result<(), Box<dyn Error>> {
    let report = experiment::run(RunOptions::default())?;
    book::draw(
        &chapter::chapter(&report)?,
        &[
            ("uav-fig-5-2-airspeed", "uav-steps.svg"),
            ("uav-fig-5-4", "uav-singular-values.svg"),
            ("uav-catching-errors", "uav-catching.svg"),
            ("uav-noise-against-time", "uav-noise.svg"),
        ],
    )?;
    Ok(())
}
